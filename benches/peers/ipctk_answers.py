#!/usr/bin/env python3
"""The IPC toolkit's answers to the questions of `cargo xtask judge --questions`.

    pip install -r benches/peers/requirements.txt
    benches/peers/ipctk_answers.py QUESTIONS.jsonl ANSWERS.jsonl [--ccd additive|tight-inclusion]

The toolkit knows surfaces made of triangles: boxes, polytopes and triangles are asked, as meshes. It casts meshes along straight
lines by the least time of impact of its candidates, vertices against faces and edges against edges
(`compute_collision_free_stepsize`), from where they do not intersect, and it says whether surfaces intersect
(`has_intersections`) and how far apart they are (`NormalCollisions.compute_minimum_distance`). A body within another has no
intersection with it: such questions are not asked.

Both methods stop before impact, by default with a tenth or a fifth of the distance left. Here Tight Inclusion leaves none of it,
but for its tolerance of 1e-6; the additive method, which needs some, leaves 1e-11: it takes no step that leaves less, and with more
left it stops a step too early. Distances and overlaps do not depend on the method: Tight Inclusion is asked casts only. Times are
of calls from Python, its empty call left out, in one thread.
"""

import ipctk
import numpy as np
from scipy.spatial.distance import cdist

import query_lines
from query_lines import Built, NotAsked, hull, placed, timed, vector

# Vertices of a pair that is cast: two hulls of 1024 take seconds.
LARGEST = 600
GAP = 1e-11
TOLERANCE = 1e-6
# The corners of a cuboid, in parts of its half extents.
CORNERS = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


def surface(shape):
    """The vertices and triangles of a shape; raises NotAsked where it is none of triangles."""
    kind = shape["type"]
    if kind == "cuboid":
        return hull(vector(shape["half_extents"]) * CORNERS)
    if kind == "polytope":
        return hull(shape["points"])
    if kind == "triangle":
        return np.array([vector(point) for point in shape["points"]]), np.array([[0, 1, 2]])
    raise NotAsked


class Pair:
    """Two surfaces as one mesh, whose vertices collide only with those of the other."""

    def __init__(self, shapes):
        self.surfaces = [surface(shape) for shape in shapes]
        self.counts = [len(corners) for corners, _ in self.surfaces]
        (_, faces_a), (_, faces_b) = self.surfaces
        faces = np.asfortranarray(np.vstack([faces_a, faces_b + self.counts[0]]), dtype=np.int32)
        self.mesh = ipctk.CollisionMesh(self.put([query_lines.IDENTITY] * 2), ipctk.edges(faces), faces)
        self.mesh.can_collide = ipctk.make_vertex_patches_filter(np.repeat(np.arange(2, dtype=np.int32), self.counts))

    def put(self, poses):
        """The vertices where a question has them."""
        placed = [corners @ rotation.T + shift for (corners, _), (rotation, shift) in zip(self.surfaces, poses)]
        return np.asfortranarray(np.vstack(placed))

    def is_nested(self, vertices):
        """Whether a body is within the other, where their surfaces do not intersect: then all of its vertices are."""
        bodies = np.split(vertices, self.counts[:1])
        return any(is_within(bodies[1 - k][0], bodies[k][self.surfaces[k][1]]) for k in (0, 1))


def is_within(point, triangles):
    """Whether a point is within a convex body, or on a single triangle."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    return len(triangles) > 1 and np.all(np.einsum("ij,ij->i", np.cross(b - a, c - a), point - a) <= 0.0)


class Pairs:
    """Pairs of shapes."""

    def __init__(self):
        self.pairs = Built(Pair)

    def get(self, *shapes):
        """A pair, and its vertices where a question has them."""
        bare = [placed(shape) for shape in shapes]
        pair = self.pairs.get([shape for shape, _ in bare])
        return pair, pair.put([at for _, at in bare])


def main():
    parser = query_lines.arguments(__doc__)
    parser.add_argument("--ccd", choices=["additive", "tight-inclusion"], default="additive", help="%(default)s if left out")
    given = parser.parse_args()
    ipctk.set_num_threads(1)
    pairs = Pairs()
    if given.ccd == "additive":
        name, asked = "ipctk", ("linear_cast", "distance", "intersect")
        ccd, stops = ipctk.AdditiveCCD(conservative_rescaling=1.0 - GAP), f"{GAP:g} of the distance left"
    else:
        name, asked = "ipctk TI", ("linear_cast",)
        ccd, stops = ipctk.TightInclusionCCD(TOLERANCE, conservative_rescaling=1.0), f"within its tolerance of {TOLERANCE:g}"

    def cast(question, pair, start):
        if "max_time" not in question or len(start) > LARGEST:
            raise NotAsked
        time = question["max_time"]
        ways = [time * vector(question.get(f"velocity_{who}", [0, 0, 0])) for who in "ab"]
        end = np.asfortranarray(start + np.repeat(ways, pair.counts, axis=0))
        step, ns = timed(lambda: ipctk.compute_collision_free_stepsize(pair.mesh, start, end, narrow_phase_ccd=ccd))
        return {"hit": step < 1.0, **({"time": step * time} if step < 1.0 else {}), "ns": ns}

    def distance(pair, vertices):
        # Nothing farther apart than the nearest vertices is looked at.
        a, b = np.split(vertices, pair.counts[:1])
        reach = 1.001 * cdist(a, b).min()

        def squared():
            collisions = ipctk.NormalCollisions()
            collisions.build(pair.mesh, vertices, reach)
            return collisions.compute_minimum_distance(pair.mesh, vertices)

        least, ns = timed(squared)
        return {"distance": np.sqrt(least), "overlap": False, "ns": ns}

    def overlap(pair, vertices):
        meet, ns = timed(lambda: ipctk.has_intersections(pair.mesh, vertices))
        return {"overlap": meet, "ns": ns}

    def answer(question):
        query = question["query"]
        if query not in asked:
            raise NotAsked
        pair, vertices = pairs.get(question["a"], question["b"])
        meet = ipctk.has_intersections(pair.mesh, vertices)
        if not meet and pair.is_nested(vertices) or meet and query != "intersect":
            raise NotAsked
        if query == "linear_cast":
            return cast(question, pair, vertices)
        return distance(pair, vertices) if query == "distance" else overlap(pair, vertices)

    settings = f"meshes; {given.ccd} continuous collision detection, {stops}; one thread, timed from Python, its empty call left out"
    head = {"peer": f"{name} {ipctk.__version__}", "precision": "f64", "tolerance": 2 * TOLERANCE, "settings": settings}
    query_lines.write(given.questions, given.answers, head, answer)


if __name__ == "__main__":
    main()
