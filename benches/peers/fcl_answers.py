#!/usr/bin/env python3
"""FCL's answers to the questions of `cargo xtask judge --questions`.

    pip install -r benches/peers/requirements.txt
    benches/peers/fcl_answers.py QUESTIONS.jsonl ANSWERS.jsonl

FCL asks distances, depths and overlaps of two bodies, and casts them along lines by conservative advancement (`CCDM_TRANS`), to an
end; it casts no rays. It has no rounded boxes, casts neither ellipsoids nor single triangles, and does not ask about two of the
latter. Turning casts are not asked: `CCDM_LINEAR` leaves the point unset about which bodies turn (`InterpMotion::reference_p`),
so that its answers change from run to run.

Tolerances are those that FCL comes with, as its interface in Python gives no others: 1e-6 for distances and depths; for the time
of contact 1e-4 of the motion, as conservative advancement does not read `toc_err`. Times are of calls from Python, less those of
the same call about two balls: this leaves out the interface, and what is as simple as two balls takes 0.
"""

import fcl
import numpy as np

import query_lines
from query_lines import Built, NotAsked, hull, placed, timed, vector

# FCL's axis of symmetry is z, that of the query format y.
Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
TOLERANCE = 1e-6
# Of a motion.
TIME_TOLERANCE = 1e-4


def build(shape):
    """The shape as FCL's, and how it is turned; raises NotAsked where FCL has none."""
    kind, still = shape["type"], np.eye(3)
    if kind == "ball":
        return fcl.Sphere(shape["radius"]), still
    if kind == "cuboid":
        return fcl.Box(*2 * vector(shape["half_extents"])), still
    if kind == "ellipsoid" and "semi_axes" in shape:
        return fcl.Ellipsoid(*vector(shape["semi_axes"])), still
    if kind in ("capsule", "cylinder", "cone"):
        solid = {"capsule": fcl.Capsule, "cylinder": fcl.Cylinder, "cone": fcl.Cone}[kind]
        return solid(shape["radius"], 2 * shape["half_height"]), Y_UP
    if kind == "polytope":
        corners, triangles = hull(shape["points"])
        faces = np.column_stack([np.full(len(triangles), 3), triangles]).ravel()
        return fcl.Convex(corners, len(triangles), faces), still
    if kind == "triangle":
        return fcl.TriangleP(*map(vector, shape["points"])), still
    raise NotAsked


class Body:
    """A shape where a question has it."""

    def __init__(self, shape, turn, at):
        self.shape, self.turn, self.at = shape, turn, at
        self.object = fcl.CollisionObject(shape, self.moved(np.zeros(3)))

    def moved(self, way):
        return fcl.Transform(self.at[0] @ self.turn, self.at[1] + way)


class Bodies:
    """Shapes where questions have them."""

    def __init__(self):
        self.shapes = Built(build)

    def get(self, shape):
        bare, at = placed(shape)
        return Body(*self.shapes.get(bare), at)


def ball(x):
    return Body(fcl.Sphere(1.0), np.eye(3), (np.eye(3), np.array([x, 0.0, 0.0])))


def main():
    given = query_lines.arguments(__doc__).parse_args()
    bodies, meeting, apart = Bodies(), (ball(0.0), ball(1.0)), (ball(0.0), ball(4.0))

    def cast(question, a, b):
        if "max_time" not in question or any(isinstance(body.shape, (fcl.Ellipsoid, fcl.TriangleP)) for body in (a, b)):
            raise NotAsked
        time = question["max_time"]
        end_a, end_b = (
            body.moved(time * vector(question.get(f"velocity_{who}", [0, 0, 0]))) for body, who in ((a, "a"), (b, "b"))
        )
        request = fcl.ContinuousCollisionRequest(gjk_solver_type=fcl.GJKSolverType.GST_INDEP)

        def ask(a, b):
            result = fcl.ContinuousCollisionResult()
            fcl.continuousCollide(a.object, end_a, b.object, end_b, request, result)
            return result

        result, ns = timed(lambda: ask(a, b), lambda: ask(*meeting))
        return {"hit": result.is_collide, **({"time": result.time_of_contact * time} if result.is_collide else {}), "ns": ns}

    def distance(a, b, is_signed):
        request, result = fcl.DistanceRequest(enable_signed_distance=is_signed), fcl.DistanceResult()
        ask = lambda a, b: fcl.distance(a.object, b.object, request, result)
        return timed(lambda: ask(a, b), lambda: ask(*apart))

    def overlap(a, b):
        request, result = fcl.CollisionRequest(), fcl.CollisionResult()
        ask = lambda a, b: fcl.collide(a.object, b.object, request, result) > 0
        balls = meeting if ask(a, b) else apart
        return timed(lambda: ask(a, b), lambda: ask(*balls))

    def answer(question):
        query = question["query"]
        if query not in ("linear_cast", "distance", "signed_distance", "intersect"):
            raise NotAsked
        a, b = bodies.get(question["a"]), bodies.get(question["b"])
        if isinstance(a.shape, fcl.TriangleP) and isinstance(b.shape, fcl.TriangleP):
            raise NotAsked
        if query == "linear_cast":
            return cast(question, a, b)
        if query == "intersect":
            meet, ns = overlap(a, b)
            return {"overlap": meet, "ns": ns}
        length, ns = distance(a, b, query == "signed_distance")
        return {query: length if query == "signed_distance" else max(length, 0.0), "overlap": length <= 0.0, "ns": ns}

    settings = (
        f"by python-fcl {fcl.__version__}; distances, depths and overlaps by libccd, ended where a step gains less than {TOLERANCE:g}, casts by "
        "conservative advancement with FCL's own GJK, ended at a step of 1e-4 of the motion; timed from Python, the same call about "
        "two balls left out"
    )
    head = {
        "peer": "FCL " + ".".join(fcl.__version__.split(".")[:3]),
        "precision": "f64",
        "tolerance": 2 * TOLERANCE,
        "of_motion": TIME_TOLERANCE,
        "settings": settings,
    }
    query_lines.write(given.questions, given.answers, head, answer)


if __name__ == "__main__":
    main()
