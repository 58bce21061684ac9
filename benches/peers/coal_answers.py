#!/usr/bin/env python3
"""coal's answers to the questions of `cargo xtask judge --questions`.

    pip install -r benches/peers/requirements.txt
    benches/peers/coal_answers.py QUESTIONS.jsonl ANSWERS.jsonl [--tolerance 1e-6]

coal asks distances, depths and overlaps of two bodies; it casts nothing. Its tolerance is a length, 1e-6 unless said otherwise,
below which its documentation leaves distances open. Times are those that coal measures itself, in C++, with what its
interface adds in Python left out; the fastest of five.
"""

import coal
import numpy as np

import query_lines
from query_lines import Built, NotAsked, hull_points, placed, vector

# coal's axis of symmetry is z, that of the query format y.
Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def build(shape):
    """The shape as coal's, and how it is turned; raises NotAsked where coal has none."""
    kind, still = shape["type"], np.eye(3)
    if kind == "ball":
        return coal.Sphere(shape["radius"]), still
    if kind == "cuboid":
        return coal.Box(2 * vector(shape["half_extents"])), still
    if kind == "ellipsoid" and "semi_axes" in shape:
        return coal.Ellipsoid(*shape["semi_axes"]), still
    if kind in ("capsule", "cylinder", "cone"):
        solid = {"capsule": coal.Capsule, "cylinder": coal.Cylinder, "cone": coal.Cone}[kind]
        return solid(shape["radius"], 2 * shape["half_height"]), Y_UP
    if kind == "polytope":
        points = coal.StdVec_Vec3s()
        points.extend(list(hull_points(shape["points"])))
        return coal.Convex.convexHull(points, False, None), still
    if kind == "triangle":
        return coal.TriangleP(*map(vector, shape["points"])), still
    if kind == "rounded":
        solid, turn = build(shape["of"])
        solid.setSweptSphereRadius(solid.getSweptSphereRadius() + shape["radius"])
        return solid, turn
    raise NotAsked


class Bodies:
    """Shapes where questions have them."""

    def __init__(self):
        self.shapes = Built(build)

    def get(self, shape):
        bare, (rotation, translation) = placed(shape)
        solid, turn = self.shapes.get(bare)
        return solid, coal.Transform3s(rotation @ turn, translation)


def main():
    parser = query_lines.arguments(__doc__)
    parser.add_argument("--tolerance", type=float, default=1e-6, help="of GJK and EPA; %(default)s if left out, as in coal")
    given = parser.parse_args()
    bodies = Bodies()

    distances, overlaps = coal.DistanceRequest(), coal.CollisionRequest()
    distances.enable_signed_distance = True
    for request in (distances, overlaps):
        request.gjk_tolerance = given.tolerance
        request.epa_tolerance = given.tolerance
        request.enable_timings = True
        if given.tolerance < 1e-6:
            # The limits that it comes with are for the tolerance that it comes with.
            request.gjk_max_iterations = request.epa_max_iterations = 1000

    def ask(functor, request, result, question):
        (a, at_a), (b, at_b) = bodies.get(question["a"]), bodies.get(question["b"])
        if isinstance(a, coal.TriangleP) and isinstance(b, coal.TriangleP):
            raise NotAsked
        compute, best = functor(a, b), float("inf")
        for _ in range(5):
            answer = result()
            compute(at_a, at_b, request, answer)
            best = min(best, answer.timings.user * 1e3)
        return answer, best

    def answer(question):
        if question["query"] in ("distance", "signed_distance"):
            result, ns = ask(coal.ComputeDistance, distances, coal.DistanceResult, question)
            distance = result.min_distance
            if question["query"] == "distance":
                return {"distance": max(distance, 0.0), "overlap": distance <= 0.0, "ns": ns}
            return {"signed_distance": distance, "overlap": distance <= 0.0, "ns": ns}
        if question["query"] == "intersect":
            result, ns = ask(coal.ComputeCollision, overlaps, coal.CollisionResult, question)
            return {"overlap": result.isCollision(), "ns": ns}
        raise NotAsked

    name = f"coal {coal.__version__}" + ("" if given.tolerance == 1e-6 else f", tolerance {given.tolerance:g}")
    settings = f"GJK and EPA with a tolerance of {given.tolerance:g}; timed by coal's own clock, in C++"
    # What it leaves open: the distances below its tolerance, and so much again of the planes that end its iteration.
    head = {"peer": name.replace(",", ""), "precision": "f64", "tolerance": 2 * given.tolerance, "settings": settings}
    query_lines.write(given.questions, given.answers, head, answer)


if __name__ == "__main__":
    main()
