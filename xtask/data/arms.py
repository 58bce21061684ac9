#!/usr/bin/env python3
"""Writes queries for `cargo xtask path`: one, two and four UR5s that move at once, each number of them as one linkage,
with all pairs of links of different arms.

    python3 xtask/data/arms.py [METRES] | cargo xtask path /dev/stdin

The arms stand in a circle, so many metres from one to the next; 1 if it is left out. The arm, with spheres for its
links, is that of suite/path.jsonl; suite/path.LICENSE says whose it is.
"""

import json
import math
import random
import sys
from pathlib import Path

EDGES = 100
# How far each joint turns at most along an edge, and from its middle, in radians.
STEP, REACH = 0.5, 2.0


def arm():
    """The joints and links of one arm."""
    with open(Path(__file__).parent / "suite" / "path.jsonl", encoding="utf-8") as lines:
        query = json.loads(next(line for line in lines if line.startswith("{")))
    return query["joints"], query["links"]


def arms(count, apart):
    """The joints and links of so many arms, and all pairs of links of different ones."""
    joints, links, owners = [], [], []
    radius = 0.5 * apart / math.sin(math.pi / count)
    one_joints, one_links = arm()
    for k in range(count):
        base, angle = len(joints), 2.0 * math.pi * k / count
        for joint in map(dict, one_joints):
            if joint["parent"] < 0:
                joint["translation"] = [radius * math.cos(angle), radius * math.sin(angle), 0.0]
                joint["rotation"] = [0.0, 0.0, math.sin(angle / 2.0), math.cos(angle / 2.0)]
            else:
                joint["parent"] += base
            joints.append(joint)
        for link in map(dict, one_links):
            if link["joint"] >= 0:
                link["joint"] += base
            links.append(link)
            owners.append(k)
    pairs = [[i, j] for i in range(len(links)) for j in range(i) if owners[i] != owners[j]]
    return joints, links, pairs


def walk(values, seed):
    """The waypoints of a walk at random."""
    draw = random.Random(seed)
    here = [draw.uniform(-1.5, 1.5) for _ in range(values)]
    rows = [here]
    for _ in range(EDGES):
        here = [max(-REACH, min(REACH, value + draw.uniform(-STEP, STEP))) for value in here]
        rows.append(here)
    return [[round(value, 6) for value in row] for row in rows]


def main():
    apart = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
    for count in (1, 2, 4):
        joints, links, pairs = arms(count, apart)
        moving = sum(joint["type"] != "fixed" for joint in joints)
        query = {"id": f"{count}-arms", "query": "path", "tags": [f"arms: {count}"], "joints": joints, "links": links}
        query |= {"waypoints": walk(moving, count), "obstacles": [], "self": pairs}
        print(json.dumps(query, separators=(",", ":")))


if __name__ == "__main__":
    main()
