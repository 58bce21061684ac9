#!/usr/bin/env python3
"""Checks that `pipe.py` writes what one process writes, and measures both.

    xtask/many-machines/check.py [--queries 1000000]

The queries are of all kinds that are asked by the million; one line in five hundred is blank, a comment, no JSON, no UTF-8, or
asks what cannot be answered. Exit status: 0 where the answers are the same to the last byte, 1 where they differ.
"""

import argparse
import glob
import json
import os
import random
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
PROGRAM = os.path.join(HERE, "..", "..", "target", "release", "xtask")
BAD = [
    b"",
    b"# a comment",
    b"this is no query",
    b'{"query":"distance","id":"\xff\xfe"}',
    b'{"query":"distance","a":{"type":"ball","radius":-1},"b":{"type":"point","at":[1,2,3]}}',
    b'{"query":"ray_cast","target":{"type":"ball","radius":1},"source":[2,0,0],"direction":[0,0,0]}\r',
]


def queries(count):
    """As many lines, the same ones each time."""
    rng = random.Random(1)
    vector = lambda size: [rng.uniform(-size, size) for _ in range(3)]
    ball = lambda: {"type": "ball", "radius": rng.uniform(0.1, 1)}
    box = lambda: {"type": "cuboid", "half_extents": [rng.uniform(0.1, 1) for _ in range(3)]}
    capsule = lambda: {"type": "capsule", "half_height": rng.uniform(0.1, 1), "radius": rng.uniform(0.1, 1)}
    hull = lambda: {"type": "polytope", "points": [vector(1) for _ in range(8)]}
    shape = lambda: rng.choice([ball, box, capsule, hull])()
    posed = lambda: {"type": "posed", "translation": vector(4), "rotation": vector(1) + [1], "of": shape()}
    ellipsoid = lambda: {"center": vector(2), "semi_axes": [rng.uniform(0.1, 1) for _ in range(3)]}
    kinds = [
        lambda: {"query": "distance", "a": shape(), "b": posed()},
        lambda: {"query": "signed_distance", "a": shape(), "b": posed()},
        lambda: {"query": "ray_cast", "target": posed(), "source": vector(6), "direction": vector(1)},
        lambda: {"query": "linear_cast", "a": shape(), "b": posed(), "velocity_a": vector(2), "max_time": 2},
        lambda: {"query": "margin", "e1": ellipsoid(), "e2": ellipsoid()},
    ]
    for line in range(count):
        yield rng.choice(BAD) if line % 500 == 7 else json.dumps(kinds[line % len(kinds)]()).encode()


def one_process(path, output, threads):
    """Seconds that one process takes."""
    start = time.time()
    with open(path, "rb") as asked, open(output, "wb") as answered:
        environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
        status = subprocess.run([PROGRAM, "query", "-"], stdin=asked, stdout=answered, env=environment).returncode
    if status != 1:
        sys.exit(f"one process ended with status {status}, not with that of bad lines")
    return time.time() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--queries", type=int, default=10_000, metavar="N")
    parser.add_argument("--master", default="local-cluster[2,1,1024]")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path, single, many = (os.path.join(folder, name) for name in ("queries.jsonl", "single", "many"))
        with open(path, "wb") as file:
            file.writelines(line + b"\n" for line in queries(given.queries))
        print(f"{given.queries} lines, {os.path.getsize(path) / 1e6:.0f} MB, of which one in 500 is bad or blank", flush=True)
        report = lambda who, seconds: print(f"{who:32} {seconds:7.1f} s {given.queries / seconds:10.0f} a second", flush=True)
        for threads in (1, os.cpu_count()):
            report(f"one process, threads: {threads}", one_process(path, single, threads))
        start = time.time()
        subprocess.run([sys.executable, os.path.join(HERE, "pipe.py"), "--master", given.master, path, many], check=True)
        report("Spark, its start included", time.time() - start)
        with open(single, "rb") as file:
            due = file.read()
        got = b"".join(open(part, "rb").read() for part in sorted(glob.glob(os.path.join(many, "part-*"))))
        lines, errors = due.count(b"\n"), due.count(b'"error":')
        print(f"{lines} answers, {errors} of them errors: {'the same' if got == due else 'DIFFERENT'} to the last byte")
        sys.exit(got != due)


if __name__ == "__main__":
    main()
