#!/usr/bin/env python3
"""MuJoCo's answers to the questions of `cargo xtask judge --questions`.

    pip install -r benches/peers/requirements.txt
    benches/peers/mujoco_answers.py QUESTIONS.jsonl ANSWERS.jsonl [--tolerance 1e-6]

MuJoCo asks distances and depths of two bodies (`mj_geomDistance`) and rays (`mju_rayGeom`, `mj_rayMesh`); it casts no shapes. It
has neither cones nor rounded boxes, and keeps the vertices of hulls in single precision. Times are of calls from Python, the fastest of three times twenty, less those of a call
that does nothing: some hundred nanoseconds of what remains are the binding's.
"""

import mujoco
import numpy as np

import query_lines
from query_lines import Built, NotAsked, compose, hull_points, placed, timed, vector

# MuJoCo's axis of symmetry is z, that of the query format y.
Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
# Distances beyond are not told; the largest scene of the suite is 2^30.
FARTHEST = 1e15


class Model:
    """One or two geoms, which are put where a question has them."""

    def __init__(self, shapes, tolerance):
        spec = mujoco.MjSpec()
        spec.option.ccd_tolerance = tolerance
        spec.option.ccd_iterations = 200
        turns = [self.add(spec, k, shape) for k, shape in enumerate(shapes)]
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        # A mesh is moved to its centre of mass and axes of inertia: its geom is where those are.
        self.within = []
        for geom, turn in enumerate(turns):
            mesh = self.model.geom_dataid[geom]
            if mesh < 0:
                self.within.append((turn, np.zeros(3)))
            else:
                matrix = np.zeros(9)
                mujoco.mju_quat2Mat(matrix, self.model.mesh_quat[mesh])
                self.within.append((matrix.reshape(3, 3), self.model.mesh_pos[mesh].copy()))

    @staticmethod
    def add(spec, number, shape):
        kind, geom = shape["type"], spec.worldbody.add_geom()
        if kind == "ball":
            geom.type, geom.size = mujoco.mjtGeom.mjGEOM_SPHERE, [shape["radius"], 0, 0]
        elif kind == "cuboid":
            geom.type, geom.size = mujoco.mjtGeom.mjGEOM_BOX, vector(shape["half_extents"])
        elif kind == "ellipsoid" and "semi_axes" in shape:
            geom.type, geom.size = mujoco.mjtGeom.mjGEOM_ELLIPSOID, vector(shape["semi_axes"])
        elif kind in ("capsule", "cylinder"):
            geom.type = {"capsule": mujoco.mjtGeom.mjGEOM_CAPSULE, "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER}[kind]
            geom.size = [shape["radius"], shape["half_height"], 0]
            return Y_UP
        elif kind == "polytope":
            mesh = spec.add_mesh(name=f"hull {number}")
            mesh.uservert = hull_points(shape["points"]).ravel()
            geom.type, geom.meshname = mujoco.mjtGeom.mjGEOM_MESH, mesh.name
        else:
            raise NotAsked
        return np.eye(3)

    def put(self, geom, at):
        rotation, translation = compose(at, self.within[geom])
        self.data.geom_xpos[geom] = translation
        self.data.geom_xmat[geom] = rotation.ravel()


class Models:
    """Models of shapes where questions have them."""

    def __init__(self, tolerance):
        self.models = Built(lambda shapes: Model(shapes, tolerance))

    def get(self, *shapes):
        bare = [placed(shape) for shape in shapes]
        model = self.models.get([shape for shape, _ in bare])
        for geom, (_, at) in enumerate(bare):
            model.put(geom, at)
        return model


def main():
    parser = query_lines.arguments(__doc__)
    parser.add_argument("--tolerance", type=float, default=1e-6, help="ccd_tolerance; %(default)s if left out, as in MuJoCo")
    given = parser.parse_args()
    models = Models(given.tolerance)

    def distance(question):
        of = models.get(question["a"], question["b"])
        return timed(lambda: mujoco.mj_geomDistance(of.model, of.data, 0, 1, FARTHEST, None))

    def ray(question):
        of = models.get(question["target"])
        source, direction = vector(question["source"]), vector(question["direction"])
        model, data, kind = of.model, of.data, of.model.geom_type[0]
        # What is timed is the call: its arguments are looked up before.
        if kind == mujoco.mjtGeom.mjGEOM_MESH:
            cast = lambda along=direction, mj_rayMesh=mujoco.mj_rayMesh: mj_rayMesh(model, data, 0, source, along)
        else:
            at, turned, size = data.geom_xpos[0].copy(), data.geom_xmat[0].copy(), model.geom_size[0].copy()
            cast = lambda along=direction, mju_rayGeom=mujoco.mju_rayGeom: mju_rayGeom(at, turned, size, source, along, kind)
        # From within, a ray meets the far side by MuJoCo's convention, and starts in contact by that of the query format.
        if cast() >= 0 and cast(-direction) >= 0:
            raise NotAsked
        return timed(cast)

    def answer(question):
        if question["query"] == "ray_cast":
            lam, ns = ray(question)
            hit = 0.0 <= lam <= question.get("max_lambda", float("inf"))
            return {"hit": hit, **({"lambda": lam} if hit else {}), "ns": ns}
        if question["query"] in ("distance", "signed_distance", "intersect"):
            signed, ns = distance(question)
            flag = {"overlap": signed <= 0.0, "ns": ns}
            if question["query"] == "intersect":
                return flag
            if question["query"] == "distance":
                return {"distance": max(signed, 0.0), **flag}
            return {"signed_distance": signed, **flag}
        raise NotAsked

    name = f"MuJoCo {mujoco.__version__}" + ("" if given.tolerance == 1e-6 else f" tolerance {given.tolerance:g}")
    settings = f"ccd_tolerance {given.tolerance:g}, 200 iterations; timed from Python, its empty call left out"
    head = {"peer": name, "precision": "f64", "tolerance": 2 * given.tolerance, "settings": settings}
    query_lines.write(given.questions, given.answers, head, answer)


if __name__ == "__main__":
    main()
