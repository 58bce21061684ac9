#!/usr/bin/env python3
"""How long coal takes for the nearest pair of two meshes, and to find whether any is within twice the gap between them:
the meshes of the bench `instances` (`nearest_between`).

    pip install -r benches/peers/requirements.txt
    benches/peers/coal_meshes.py

Meshes are `BVHModelOBBRSS`, and "within" is a collision with a security margin that stops at the first contact. Times are
those of the processor, the fastest of five; what the interface adds in Python is about a microsecond.
"""

import time

import coal
import numpy as np

SIDE = 224


def units(seed, count):
    """Numbers of splitmix64 in [0, 1), as `workloads::rng` draws them."""
    mask = (1 << 64) - 1
    for _ in range(count):
        seed = (seed + 0x9E3779B97F4A7C15) & mask
        z = ((seed ^ (seed >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        yield ((z ^ (z >> 31)) >> 11) * 2.0**-53


def hills(seed, height):
    """Hills over the unit square, at this height, as coal's mesh."""
    row = SIDE + 1
    i, a = np.arange(row * row), np.arange(SIDE * SIDE)
    rise = 0.02 * np.fromiter(units(seed, row * row), float)
    a += a // SIDE
    mesh = coal.BVHModelOBBRSS()
    mesh.beginModel(2 * SIDE * SIDE, row * row)
    mesh.addVertices(np.column_stack([(i % row) / SIDE, rise + height, (i // row) / SIDE]))
    mesh.addTriangles(np.stack([a, a + 1, a + row, a + 1, a + row + 1, a + row], axis=1).reshape(-1, 3))
    mesh.endModel()
    return mesh


def fastest(ask, answer):
    """The answer and the fastest time, in microseconds."""
    best = float("inf")
    for _ in range(5):
        found = answer()
        start = time.process_time()
        ask(found)
        best = min(best, time.process_time() - start)
    return found, best * 1e6


def main():
    here, below = coal.Transform3s.Identity(), hills(90_012, 0.0)
    print(f"coal {coal.__version__}")
    for gap in (1.0, 0.1, 0.001):
        above = hills(90_013, 0.02 + gap)
        exact, near = coal.DistanceRequest(), coal.CollisionRequest()
        near.security_margin = 2 * gap
        nearest, time_of_nearest = fastest(
            lambda found: coal.distance(below, here, above, here, exact, found), coal.DistanceResult
        )
        is_near, time_of_any = fastest(
            lambda found: coal.collide(below, here, above, here, near, found), coal.CollisionResult
        )
        print(f"gap {gap}: {nearest.min_distance!r} in {time_of_nearest:.1f} µs, ", end="")
        print(f"any within {2 * gap}: {is_near.isCollision()} in {time_of_any:.1f} µs")


if __name__ == "__main__":
    main()
