"""What the programs of this folder share: shapes of the query format in their poses, and lines of answers."""

import argparse
import json
import time

import numpy as np
from scipy.spatial import ConvexHull

IDENTITY = (np.eye(3), np.zeros(3))


class NotAsked(Exception):
    """The library has no such shape or question."""


def arguments(description):
    """What every program is called with: the questions, and where the answers go. Some add options of their own."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("questions")
    parser.add_argument("answers")
    return parser


def rotation_of(quaternion):
    """The matrix of a quaternion [x, y, z, w] of any length; an angle is of the plane."""
    if not isinstance(quaternion, list):
        raise NotAsked
    x, y, z, w = np.array(quaternion) / np.linalg.norm(quaternion)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])


def placed(shape, at=IDENTITY):
    """A shape without its poses, and where it is: a rotation matrix and a translation."""
    if shape["type"] == "ellipsoid" and "semi_axes" in shape:
        rotation = rotation_of(shape["rotation"]) if "rotation" in shape else np.eye(3)
        at = compose(at, (rotation, vector(shape["center"])))
        return {"type": "ellipsoid", "semi_axes": shape["semi_axes"]}, at
    if shape["type"] == "affine":
        # A rotation that is written as a matrix.
        matrix = np.array([vector(row) for row in shape["matrix"]])
        if np.abs(matrix @ matrix.T - np.eye(3)).max() > 1e-6 or np.linalg.det(matrix) < 0.0:
            raise NotAsked
        return placed(shape["of"], compose(at, (matrix, vector(shape.get("translation", [0, 0, 0])))))
    if shape["type"] != "posed":
        return shape, at
    pose = (rotation_of(shape.get("rotation", [0, 0, 0, 1])), vector(shape.get("translation", [0, 0, 0])))
    return placed(shape["of"], compose(at, pose))


def compose(outer, inner):
    return outer[0] @ inner[0], outer[0] @ inner[1] + outer[1]


def vector(numbers):
    """A vector of space; questions of the plane are none of these libraries'."""
    if not isinstance(numbers, list) or len(numbers) != 3:
        raise NotAsked
    return np.array(numbers, dtype=float)


def hull_points(points):
    """The points of a hull, as rows; the libraries of this folder have none without a volume."""
    rows = np.array([vector(point) for point in points])
    extents = np.linalg.svd(rows - rows.mean(axis=0), compute_uv=False)
    if len(rows) < 4 or extents[2] < 1e-9 * extents[0]:
        raise NotAsked
    return rows


def hull(points):
    """The hull of points: its corners as rows, and its faces as triangles of their numbers, counterclockwise from outside."""
    rows = hull_points(points)
    found = ConvexHull(rows)
    corners, triangles = np.unique(found.simplices, return_inverse=True)
    rows, triangles = rows[corners], triangles.reshape(-1, 3)
    a, b, c = (rows[triangles[:, k]] for k in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), found.equations[:, :3]) < 0.0
    triangles[inwards] = triangles[inwards][:, ::-1]
    return rows, triangles


def timed(call, idle=lambda: None):
    """The answer of a call, and how many nanoseconds longer it takes than an idle one."""
    start = time.perf_counter()
    answer = call()
    once = time.perf_counter() - start
    if once > 0.02:
        return answer, once * 1e9
    repeats = 20 if once < 1e-3 else 1

    def best(call):
        least = float("inf")
        for _ in range(3):
            start = time.perf_counter()
            for _ in range(repeats):
                call()
            least = min(least, time.perf_counter() - start)
        return least / repeats * 1e9

    return answer, max(best(call) - best(idle), 0.0)


class Built:
    """What was built last, by what it was built of: questions of a case follow one another."""

    def __init__(self, build):
        self.build, self.built = build, {}

    def get(self, given):
        key = str(given)
        if key not in self.built:
            if len(self.built) > 8:
                self.built.clear()
            self.built[key] = self.build(given)
        return self.built[key]


def write(questions, answers, head, answer):
    """Answers the query lines of a file by `answer`, which gives the fields of an answer or raises `NotAsked`."""
    counts = {"answered": 0, "errors": 0, "not asked": 0}
    start = time.time()
    with open(questions, encoding="utf-8") as asked, open(answers, "w", encoding="utf-8") as out:
        print(json.dumps(head), file=out)
        for line in asked:
            question = json.loads(line)
            try:
                fields = answer(question)
                counts["answered"] += 1
            except NotAsked:
                counts["not asked"] += 1
                continue
            except (AttributeError, LookupError, NameError, TypeError):  # a mistake of the program is no answer of the library
                raise
            except Exception as why:  # what a library throws is its answer
                fields = {"error": str(why)}
                counts["errors"] += 1
            print(json.dumps({"id": question["id"], **fields}), file=out)
    told = ", ".join(f"{count} {what}" for what, count in counts.items())
    print(f"{head['peer']}: {told}, in {time.time() - start:.1f} s")
