#!/usr/bin/env python3
"""What today's versions of coal, FCL, MuJoCo, parry, Box3D and Jolt answer to the poses of the museum.

    pip install -r benches/peers/requirements.txt
    cargo build --release -p studies --features peers,box3d,jolt     # C and C++ compilers, and cmake before 4
    benches/peers/museum_today.py       # then: python3 xtask/data/museum.py, and cargo xtask museum --write

An answer is right if it is off by no more than the tolerance that the library documents and a millionth of its value.
Box3D and Jolt compute in `f32`, in metres: they are not asked where the rounding of the pose's numbers, or the answer
itself, is of the size of their tolerance. Writes `xtask/data/museum_today.json`.
"""

import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "..", "..", "xtask", "data")
PEERS = {peer: [sys.executable, os.path.join(HERE, f"{peer}_answers.py")] for peer in ("coal", "fcl", "mujoco")}
STUDIES = ["cargo", "run", "--release", "--quiet", "-p", "studies", "--features", "peers,box3d,jolt", "--", "judge", "--ask"]
PEERS |= {library: [*STUDIES, library] for library in ("parry f64", "parry f32", "Box3D f32", "Jolt f32")}
IN_METRES = ("Box3D f32", "Jolt f32")
SCALARS = {"ray_cast": "lambda", "linear_cast": "time", "motion_cast": "time", "distance": "distance", "signed_distance": "signed_distance"}


def asked(peer, lines):
    """The head of the answers, and each of them by its id. Where the process ends without them, halves are asked alone."""
    with tempfile.TemporaryDirectory() as folder:
        questions, answers = os.path.join(folder, "questions.jsonl"), os.path.join(folder, "answers.jsonl")
        with open(questions, "w", encoding="utf-8") as file:
            file.writelines(lines)
        try:
            ended = subprocess.run([*PEERS[peer], questions, answers], capture_output=True, timeout=20, check=False).returncode
        except subprocess.TimeoutExpired:
            ended = 1
        if ended == 0:
            with open(answers, encoding="utf-8") as file:
                head, *said = map(json.loads, file)
            return head, {answer["id"]: answer for answer in said}
    if len(lines) == 1:
        return None, {json.loads(lines[0])["id"]: {"error": "the process ends"}}
    half = len(lines) // 2
    (head, first), (other, second) = asked(peer, lines[:half]), asked(peer, lines[half:])
    return head or other, {**first, **second}


def judged(case, answer, tolerance):
    """What is wrong with an answer; empty if nothing is."""
    if "error" in answer:
        return "no answer"
    truth, scalar = case["expect"], SCALARS.get(case["query"])
    for flag, names in (("hit", ("a miss", "a hit")), ("overlap", ("apart", "overlap"))):
        if flag in truth and flag in answer and answer[flag] != truth[flag] and abs(truth.get("distance", truth.get("signed_distance", 1))) > tolerance:
            return names[answer[flag]] + (f" by {answer[scalar]:.2g}" if flag == "overlap" and answer.get(scalar, 0) > 0 else "")
    if scalar in truth and scalar in answer and truth[scalar] is not None:
        off = abs(answer[scalar] - truth[scalar])
        if not off <= tolerance + 1e-6 * abs(truth[scalar]):
            return f"{answer[scalar]:.5g}"
    return ""


def is_left_out(peer, case, answer):
    """Whether a library says that it has no such shapes. python-fcl prints it, about a triangle, and returns something."""
    said = answer.get("error", "")
    return "not yet supported" in said or "must be positive" in said or (peer == "fcl" and '"triangle"' in json.dumps(case))


def numbers(value):
    """All numbers in a query."""
    if isinstance(value, dict):
        value = [part for name, part in value.items() if name not in ("allow", "expect", "rotation", "direction")]
    return [abs(value)] if isinstance(value, (int, float)) else [x for part in value for x in numbers(part)] if isinstance(value, list) else []


def is_too_fine(case, tolerance):
    """Whether single precision, or a tolerance of this length, cannot tell the answer from a wrong one."""
    truth = case["expect"].get(SCALARS.get(case["query"]))
    return max(numbers(case)) * 2**-24 > tolerance or truth is not None and 0 < abs(truth) < tolerance


def main():
    with open(os.path.join(DATA, "museum.jsonl"), encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    right, wrong, today = {}, {}, {}
    for peer in PEERS:
        # parry answers in the precision that a pose asks for.
        precision = peer.partition(" ")[2] if peer.startswith("parry") else ""
        head, answers = asked(peer, [line for line in lines if precision in ("", json.loads(line).get("precision", "f64"))])
        for case in map(json.loads, lines):
            answer = answers.get(case["id"])
            if answer and not is_left_out(peer, case, answer) and not (peer in IN_METRES and is_too_fine(case, head["tolerance"])):
                why = judged(case, answer, head["tolerance"])
                (wrong if why else right).setdefault(case["id"], []).append(head["peer"].split(" ")[0] + (f": {why}" if why else ""))
    for id in (json.loads(line)["id"] for line in lines):
        said = wrong.get(id, []) + (["right: " + ", ".join(right[id])] if id in right else [])
        today[id] = "; ".join(said) if said else "not asked"
        print(id, today[id])
    with open(os.path.join(DATA, "museum_today.json"), "w", encoding="utf-8") as file:
        json.dump(today, file, indent=1, ensure_ascii=False)
        file.write("\n")


if __name__ == "__main__":
    main()
