#!/usr/bin/env python3
"""Writes `museum.jsonl`: poses out of public trackers, with their truth. Needs mpmath, numpy and scipy.

Every line is a query of the query format, and says in fields of its own where it is from: `_issue`, `_title`, `_reported`, and
`_pose`, which is "given" where all numbers that decide are those of the report, and "after the report" where a number that it
leaves out was chosen here. `_truth` says how the truth is known, and `_today` what `museum_today.json` has of other libraries. Truths are closed forms in fifty digits. Those of polytopes
are the least of the support values of their difference along its facets, or the shortest vector to it.

    python3 xtask/data/museum.py     # then: cargo xtask museum --write
"""

import json
import os

import numpy as np
from mpmath import cos, matrix, mp, mpf, sin, sqrt
from scipy.optimize import nnls
from scipy.spatial import ConvexHull

mp.dps = 50
ROWS = []


def row(id, issue, title, reported, query, expect, truth, pose="given", **more):
    ROWS.append({"id": id, "_issue": issue, "_title": title, "_reported": reported, "_pose": pose, "_truth": truth,
                 **query, "expect": expect, **more})


# Shapes in the query format.
ball = lambda r: {"type": "ball", "radius": r}
box = lambda *h: {"type": "cuboid", "half_extents": list(h)}
capsule = lambda h, r: {"type": "capsule", "half_height": h, "radius": r}
cylinder = lambda h, r: {"type": "cylinder", "half_height": h, "radius": r}
points = lambda p: {"type": "polytope", "points": p}
segment = lambda *p: {"type": "segment", "points": list(p)}
triangle = lambda *p: {"type": "triangle", "points": list(p)}
point = lambda *p: {"type": "point", "at": list(p)}
upright = lambda of: {"type": "posed", "rotation": [1, 0, 0, 1], "of": of}  # from the axis y to the axis z


def posed(of, at=None, rotation=None):
    extra = {**({"translation": list(at)} if at is not None else {}), **({"rotation": rotation} if rotation is not None else {})}
    return {"type": "posed", **extra, "of": of}


def affine(of, rows, at):
    return {"type": "affine", "matrix": rows, "translation": list(at), "of": of}


# Vectors and corners in fifty digits.
dot = lambda a, b: sum(x * y for x, y in zip(a, b))
exact = lambda v: [mpf(c) for c in v]


def turned(q, v):
    """A vector turned by a quaternion of any length."""
    x, y, z, w = exact(q)
    n = x * x + y * y + z * z + w * w
    rows = [[1 - 2 * (y * y + z * z) / n, 2 * (x * y - z * w) / n, 2 * (x * z + y * w) / n],
            [2 * (x * y + z * w) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z - x * w) / n],
            [2 * (x * z - y * w) / n, 2 * (y * z + x * w) / n, 1 - 2 * (x * x + y * y) / n]]
    return [dot(r, v) for r in rows]


def corners(shape):
    kind = shape["type"]
    if kind == "point":
        return [exact(shape["at"])]
    if kind == "cuboid":
        h = exact(shape["half_extents"])
        return [[s * c for s, c in zip(signs, h)] for signs in np.ndindex(*[2] * len(h))
                for signs in [[2 * s - 1 for s in signs]]]
    if kind in ("polytope", "segment", "triangle"):
        return [exact(p) for p in shape["points"]]
    inner = corners(shape["of"])
    move = exact(shape.get("translation", [0] * len(inner[0])))
    if kind == "affine":
        inner = [[dot(exact(r), p) for r in shape["matrix"]] for p in inner]
    elif "rotation" in shape and isinstance(shape["rotation"], list):
        inner = [turned(shape["rotation"], p) for p in inner]
    elif "rotation" in shape:
        c, s = cos(mpf(shape["rotation"])), sin(mpf(shape["rotation"]))
        inner = [[c * x - s * y, s * x + c * y] for x, y in inner]
    return [[a + b for a, b in zip(p, move)] for p in inner]


def signed_distance(a, b):
    """Of two polytopes: how far apart they are, or minus how deep in one another."""
    v = [[x - y for x, y in zip(p, q)] for p in corners(a) for q in corners(b)]
    hull = ConvexHull(np.array([[float(c) for c in p] for p in v]), qhull_options="QJ")
    least = None
    for facet in hull.simplices:
        p = [v[k] for k in facet]
        if len(p) == 3:
            e, f = [[y - x for x, y in zip(p[0], q)] for q in p[1:]]
            n = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]]
        else:
            n = [p[1][1] - p[0][1], p[0][0] - p[1][0]]
        length = sqrt(dot(n, n))
        if length < mpf(10) ** -30:
            continue
        for n in ([c / length for c in n], [-c / length for c in n]):
            h = max(dot(n, q) for q in v)
            least = h if least is None or h < least else least
    size = max(abs(float(c)) for p in v for c in p)
    # Below zero the facets part the bodies; by rounding only, and that much is the distance to rounding.
    if least >= -1e-15 * size:
        return float(-least)
    # Apart: the shortest vector, by its active points.
    A = np.vstack([np.array([[float(c) / size for c in p] for p in v]).T, 1e3 * np.ones(len(v))])
    weights, _ = nnls(A, np.append(np.zeros(len(v[0])), 1e3), maxiter=100000)
    active = [v[k] for k in np.nonzero(weights > 1e-9)[0]]
    k = len(active)
    kkt = matrix(k + 1, k + 1)
    for i in range(k):
        for j in range(k):
            kkt[i, j] = dot(active[i], active[j])
        kkt[i, k] = kkt[k, i] = mpf(1)
    w = mp.lu_solve(kkt, matrix([0] * k + [1]))
    x = [sum(w[i] * active[i][c] for i in range(k)) for c in range(len(v[0]))]
    length = sqrt(dot(x, x))
    assert min(dot(x, q) for q in v) > length * length * (1 - mpf(10) ** -12), "the plane separates"
    return float(length)


def to_cylinder(p, h, r):
    """How far a point is from the cylinder about y."""
    radial = sqrt(p[0] ** 2 + p[2] ** 2) - r
    beyond = abs(p[1]) - h
    if radial <= 0 and beyond <= 0:
        return max(radial, beyond)
    return sqrt(max(radial, 0) ** 2 + max(beyond, 0) ** 2)


def least(f, low, high):
    """The least of a convex function."""
    low, high = mpf(low), mpf(high)
    for _ in range(250):
        a, b = low + (high - low) / 3, high - (high - low) / 3
        low, high = (low, b) if f(a) < f(b) else (a, high)
    return f((low + high) / 2)


def first(f, low, high):
    """Where a function that falls through zero does so."""
    low, high = mpf(low), mpf(high)
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if f(middle) > 0 else (low, middle)
    return (low + high) / 2


def to_segment(p, a, b):
    """How far a point is from a segment."""
    along = [y - x for x, y in zip(a, b)]
    from_a = [y - x for x, y in zip(a, p)]
    t = min(max(dot(from_a, along) / dot(along, along), 0), 1) if dot(along, along) else mpf(0)
    off = [f - t * c for f, c in zip(from_a, along)]
    return sqrt(dot(off, off))


def to_box(p, h):
    d = [max(abs(c) - mpf(e), 0) for c, e in zip(p, h)]
    return sqrt(dot(d, d))


# Rays.
row("bullet-1947", "bulletphysics/bullet3#1947", "Nearly perpendicular rays at a wall a kilometre wide",
    "points of contact from z = 49.6 to 50, where the front is at z = 50",
    {"query": "ray_cast", "target": posed(box(500, 100, 0.5), [0, 0, 49.5]), "source": [300, 1, 150], "direction": [0, -0.01, -1]},
    {"hit": True, "lambda": 100.0}, "the front is a plane", pose="after the report", allow=1e-9)
# PhysX's cones point along x.
along_x = [0, 0, -1, 1]
cone = posed(posed({"type": "cone", "half_height": 250, "radius": 495}, rotation=along_x), [11800, 166.703125, 1934.41443],
             [-0.664463043, 0.664463043, 0.241844788, 0.241844788])
source, d = exact([11835, 4.70993042, 1705.91943]), exact([0, 0, 1])
inverse = lambda q: [-c for c in q[:3]] + q[3:]
into = lambda v: turned(inverse(along_x), turned(inverse(cone["rotation"]), v))
o = into([a - mpf(b) for a, b in zip(source, cone["translation"])])
e = into(d)
candidates = []
slope = mpf(495) / 500  # the radius falls from 495 at y = -250 to 0 at y = 250
A, B, C = e[0] ** 2 + e[2] ** 2 - (slope * e[1]) ** 2, o[0] * e[0] + o[2] * e[2] + slope ** 2 * (250 - o[1]) * e[1], o[0] ** 2 + o[2] ** 2 - (slope * (250 - o[1])) ** 2
for sign in (-1, 1):
    if B * B - A * C >= 0:
        candidates.append((-B + sign * sqrt(B * B - A * C)) / A)
if e[1] != 0:
    candidates.append((-250 - o[1]) / e[1])
inside = lambda t: -250 - mpf(10) ** -30 <= o[1] + t * e[1] <= 250 and (o[0] + t * e[0]) ** 2 + (o[2] + t * e[2]) ** 2 <= (slope * (250 - o[1] - t * e[1])) ** 2 + mpf(10) ** -25
row("physx-429", "NVIDIA-Omniverse/PhysX#429", "A ray at a flat cone far from the origin",
    "the hit position is not at the hit distance along the ray",
    {"query": "ray_cast", "target": cone, "source": [11835, 4.70993042, 1705.91943], "direction": [0, 0, 1], "max_lambda": 778.38},
    {"hit": True, "lambda": float(min(t for t in candidates if t >= 0 and inside(t)))}, "quadratic of the cone's mantle, and its base",
    pose="after the report", allow=1e-7)
cube = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
row("edyn-155", "xissburg/edyn#155", "A ray through the middle of a cube, parallel to four of its faces", "no hit",
    {"query": "ray_cast", "target": points(cube), "source": [2, 0, 0], "direction": [-4, 0, 0]}, {"hit": True, "lambda": 0.25},
    "the face is a plane", allow=1e-12)
row("godot-jolt-652", "godot-jolt/godot-jolt#652", "A ray that starts inside a solid", "a normal, where Godot Physics has none; a convention",
    {"query": "ray_cast", "target": cylinder(2, 1), "source": [0.05, 0.02, -0.03], "direction": [0, 1, 0]}, {"hit": True, "lambda": 0.0, "normal": None},
    "the source is inside, so that there is no normal", pose="after the report")

# Linear casts.
for size in (5, 50, 500):
    row(f"parry-429-{size}", "dimforge/parry#429", f"A ball falls on a cuboid of half extent {size}",
        {5: "short by 0.246 mm", 50: "short by 3.64 mm", 500: "short by 139 mm"}[size] + ", in f32",
        {"query": "linear_cast", "precision": "f32", "a": posed(ball(0.5166), [0.25, 10, -0.25]), "b": box(size, 1, size), "velocity_a": [0, -1, 0]},
        {"hit": True, "time": 10 - 1 - 0.5166}, "the top is a plane", pose="after the report", allow=1e-5)
row("bevy-rapier-119", "dimforge/bevy_rapier#119", "A ball falls on a floor of 1000 by 1000", "heights of the two witness points differ by up to 0.06",
    {"query": "linear_cast", "a": posed(ball(1), [0.05, 3, 0.03]), "b": box(500, 1, 500), "velocity_a": [0, -1, 0]},
    {"hit": True, "time": 1.0}, "the top is a plane", allow=1e-12)
bar = [exact([244.5, 0.5]), exact([884.5, 188.5])]
over = first(lambda t: to_box([380 + 624 * t - bar[1][0], 241 - 104 * t - bar[1][1]], bar[0]) - 1, 0, mpf("0.5"))
row("rapier-js-258", "dimforge/rapier.js#258", "A ball crosses a bar a unit thick within one step, in the plane", "the ray hits, the shape cast misses",
    {"query": "linear_cast", "a": posed(ball(1), [380, 241]), "b": posed(box(244.5, 0.5), [884.5, 188.5]), "velocity_a": [624, -104], "max_time": 1},
    {"hit": True, "time": float(over)}, "distance of a point from a box", pose="after the report", allow=1e-12)
bar2 = [exact([335, 0.5]), exact([408, 286.5])]
over = first(lambda t: to_box([894 - 509 * t - bar2[1][0], 328 - 111 * t - bar2[1][1]], bar2[0]) - 1, 0, mpf("0.5"))
row("rapier-js-258-second", "dimforge/rapier.js#258", "A ball crosses another bar a unit thick within one step, in the plane", "the ray hits, the shape cast misses",
    {"query": "linear_cast", "a": posed(ball(1), [894, 328]), "b": posed(box(335, 0.5), [408, 286.5]), "velocity_a": [-509, -111], "max_time": 1},
    {"hit": True, "time": float(over)}, "distance of a point from a box", pose="after the report", allow=1e-12)
row("physx-610", "NVIDIAGameWorks/PhysX#610", "A cube falls on a cube, from y = 15 to 10", "a hit at 2.9975",
    {"query": "linear_cast", "a": posed(box(1, 1, 1), [0, 15, 0]), "b": posed(box(1, 1, 1), [0, 10, 0]), "velocity_a": [0, -1, 0]},
    {"hit": True, "time": 3.0}, "faces are parallel", allow=1e-12)
slab, start, end = [19.92, 0.92, 49.92], [-27.449842, -2.994380, 109.886520], [-27.529308, -3.604819, 109.553276]
q = [-0.057141, 0.572179, 0.040011, 0.817157]
velocity = [float(mpf(repr(b)) - mpf(repr(a))) for a, b in zip(start, end)]
place = lambda t: turned(inverse(q), [mpf(a) + mpf(v) * t - c for a, v, c in zip(start, velocity, [0, 0, 120])])
gap = lambda t: to_box(place(t), slab) - mpf(0.45)
near = min((gap(mpf(k) / 1000), k) for k in range(1001))
expect = {"hit": True, "time": float(first(gap, 0, mpf(near[1]) / 1000))} if near[0] < 0 and gap(0) > 0 else ({"hit": True, "time": 0.0} if gap(0) <= 0 else {"hit": False})
row("bullet-596", "bulletphysics/bullet3#596", "A ball and a turned slab of 100 m", "a point of contact 10.8 m away, but not if the pose is asked alone",
    {"query": "linear_cast", "a": posed(ball(0.45), start), "b": posed(box(*slab), [0, 0, 120], q), "velocity_a": velocity, "max_time": 1},
    expect, "distance of a point from a box", allow=1e-9)
row("box3d-32", "erincatto/box3d#32", "A box a tenth of a millimetre above another moves away", "a hit at 0 whatever the direction, as for any start within the target distance",
    {"query": "linear_cast", "a": posed(box(1, 1, 1), [0, 2.0001, 0]), "b": box(1, 1, 1), "velocity_a": [0, 1, 0]}, {"hit": False},
    "the gap grows", pose="after the report")
row("parry-107", "dimforge/parry#107", "A ball that is 0.0032 deep in a wall moves on into it, in the plane", "no hit with a tree of boxes, a hit at 3.4e-8 without",
    {"query": "linear_cast", "a": posed(ball(96), [216.02324, -1632.0032]), "b": posed(box(1280, 96), [0, -1824]), "velocity_a": [-636.3961, -636.3961], "max_time": 1 / 60},
    {"hit": True, "time": 0.0}, "it overlaps at the start")

cubes = lambda v: {"query": "linear_cast", "a": posed(box(0.5, 0.5, 0.5), [0, 1.1, 0]), "b": box(0.5, 0.5, 0.5), "velocity_a": v}
row("ncollide-141", "dimforge/ncollide#141", "Two cubes that rest, a tenth apart", "a hit at 0", cubes([0, 0, 0]), {"hit": False}, "nothing moves")
row("ncollide-214", "dimforge/ncollide#214", "A square moves to a rectangle ten away, in the plane", "no hit",
    {"query": "linear_cast", "a": box(1, 1), "b": posed(box(1, 1.5), [10, 0]), "velocity_a": [1, 0]}, {"hit": True, "time": 8.0}, "faces are parallel", allow=1e-12)

# Turning casts, whose truths were found in ninety digits.
TURNING = {
    "physx-398": ("NVIDIAGameWorks/PhysX#398", "A box turns about a point 205 from its centre, into another", "the turning box penetrates the other"),
    "ncollide-369": ("dimforge/ncollide#369", "Two boxes move side by side at one velocity", "an endless loop"),
    "godot-jolt-389": ("godot-jolt/godot-jolt#389", "A rod turns by half a turn within one step, past a ball", "no hit: the cast leaves the turn out, as Jolt documents"),
    "box2d-115": ("erincatto/box2d#115", "A long box and a square that turns by 0.26, in the plane", "touching, where there is a gap; an endless loop unless whole turns are taken off the angle"),
    "parry-317": ("dimforge/parry#317", "A turning box runs into another", "no collision"),
}


def turning(id, query, expect, truth, pose="after the report", **more):
    issue, title, reported = TURNING[id]
    row(id, issue, title, reported, {"query": "motion_cast", **query}, expect, truth, pose=pose, **more)


NINETY = "the first zero of the gap, in ninety digits"
turning("physx-398", {"a": posed(box(50, 50, 50), [205, 0, 0]), "b": posed(box(50, 50, 50), [0, 105, 0]), "motion_a": {"angular_velocity": [0, 0, 1.5]}, "max_time": 1},
        {"hit": True, "time": 0.63114138911322}, NINETY, allow=2.2e-8)
turning("ncollide-369", {"a": box(1, 1, 1), "b": posed(box(1, 1, 1), [3, 0.5, 0]), "motion_a": {"velocity": [1, 2, 0]}, "motion_b": {"velocity": [1, 2, 0]}, "max_time": 10},
        {"hit": False}, "they rest as seen from one another")
turning("godot-jolt-389", {"a": posed(box(1, 0.05, 0.05), [1, 0, 0]), "b": posed(ball(0.1), [0, 1.5, 0]), "motion_a": {"angular_velocity": [0, 0, 188.4955592153876]}, "max_time": 1 / 60},
        {"hit": True, "time": 0.007801928659512334}, NINETY, allow=3e-10)
turning("box2d-115", {"a": posed(box(25, 5), [24, -60], 2.95), "b": posed(box(2.5, 2.5), [53.474274, -50.252514], 4.428750118453536),
                      "motion_b": {"velocity": [1.1212039999999988, -0.830959], "angular_velocity": 0.2610499999999547, "center": [53.474274, -50.252514]}, "max_time": 1},
        {"hit": False}, "a plane separates them at all times", pose="given")
turning("parry-317", {"a": posed(box(0.6, 0.4, 0.25), [0, 0, 0], [0, 0, 0.25, 1]), "b": posed(box(0.75, 1.5, 0.5), [2, 0.25, 0.125], [0.125, 0, 0, 1]),
                      "motion_a": {"velocity": [2, 0, 0], "angular_velocity": [0, 0, 0.5], "center": [0, 0, 0]}, "max_time": 1},
        {"hit": True, "time": 0.26465673739468115}, NINETY, allow=2.7e-8)

# Distances.
row("fcl-508", "flexible-collision-library/fcl#508", "Unit boxes four apart along y", "3.16228 apart",
    {"query": "distance", "a": posed(box(0.5, 0.5, 0.5), [0, 4, 0]), "b": box(0.5, 0.5, 0.5)}, {"distance": 3.0, "overlap": False}, "faces are parallel", allow=1e-12)
row("fcl-275", "flexible-collision-library/fcl#275", "Spheres of radius 20 and 10, centres 40 apart along y", "25 apart",
    {"query": "distance", "a": ball(20), "b": posed(ball(10), [0, 40, 0])}, {"distance": 10.0, "overlap": False}, "40 − 20 − 10", allow=1e-12)
row("fcl-127", "flexible-collision-library/fcl#127", "A unit sphere and a box", "the distance is right, the nearest points are not",
    {"query": "distance", "a": ball(1), "b": posed(box(5, 1, 5), [0, 5, 3])}, {"distance": 3.0, "overlap": False, "point_a": [0, 1, 0], "point_b": [0, 4, 0]},
    "the nearest face is a plane", allow=1e-12, allow_fields={"point_a": 1e-9, "point_b": 1e-9})
a = affine(box(0.1815, 0.1385, 0.1815), [[0.9999195703, 0.01021849413, 0.007512347878], [-0.01021878248, 0.9999477869, -3.329855922e-17], [-0.007511955635, -7.676704888e-05, 0.9999717819]], [1.503354966, -0.8531707835, 0.7700092418])
b = affine(box(0.1815, 0.1815, 0.1385), [[0.9998670967, -0.01297708324, 0.009868343982], [0.01297771517, 0.9999157859, 5.255670031e-17], [-0.009867512928, 0.0001280685574, 0.9999513067]], [1.48838308, -1.102020834, 0.4497073799])
gap = signed_distance(a, b)
row("coal-604", "coal-library/coal#604", "Two boxes nearly parallel and close", "wrong with a tolerance above 1e-6",
    {"query": "distance", "a": a, "b": b}, {"distance": gap, "overlap": False}, "shortest vector to the difference", allow=1e-9)
row("jitter-302", "notgiven688/jitterphysics2#302", "A unit box, and a cloud of one point", "apart by the distance, overlapping by the overlap test",
    {"query": "distance", "a": points([[1, 0, 0]]), "b": box(0.5, 0.5, 0.5)}, {"distance": 0.5, "overlap": False}, "the face is a plane", allow=1e-12)
ax, ay = [90945.08, 91077.46, 91454.92, 91322.54], [54122.54, 53745.082, 53877.46, 54254.918]
bx, by = [90919.64, 91162.62, 91480.36, 91237.38], [54037.383, 53719.637, 53962.617, 54280.363]
prism = lambda x, y: points([[float(np.float32(p)), float(np.float32(q)), z] for z in (300, 0) for p, q in zip(x, y)])
row("opengjk-52", "MattiaMontanari/openGJK#52", "Two boxes that overlap, far from the origin", "0.0032915156 apart",
    {"query": "distance", "precision": "f32", "a": prism(ax, ay), "b": prism(bx, by)}, {"distance": 0.0, "overlap": True}, "they have one centre", allow=0.0)

# Depths and overlaps.
row("libccd-25", "danfis/libccd#25", "Cubes of side 2, centres 1.9 apart along z", "0 deep, and a direction that is no number",
    {"query": "signed_distance", "a": posed(box(1, 1, 1), [0, 0, 1.9]), "b": box(1, 1, 1)}, {"signed_distance": float(mpf(1.9) - 2), "overlap": True}, "faces are parallel", allow=1e-12)
seg = mpf(2.03114343)
at = exact([-0.951660156, -2.09155273, -7.63574218])
gap = least(lambda y: to_cylinder([-at[0], y - at[1], -at[2]], mpf(0.3), mpf(0.4975)), -seg, seg) - mpf(7.19732189)
row("jolt-2103", "jrouwe/JoltPhysics#2103", "A cylinder that touches a capsule fourteen times as thick", "7.25 m deep",
    {"query": "signed_distance", "a": posed(cylinder(0.3, 0.4975), [-0.951660156, -2.09155273, -7.63574218]), "b": capsule(2.03114343, 7.19732189)},
    {"signed_distance": float(gap), "overlap": bool(gap <= 0)}, "distance of a segment from a cylinder", allow=1e-9)
rows = [[0.96193976625564348026, 0.15401279915737359216, 0.22572537250328919556], [-0.19134171618254486313, 0.96936494951283913579, 0.15401279915737359216], [-0.19509032201612822033, -0.19134171618254486313, 0.96193976625564348026]]
a = affine(box(0.25, 0.25, 0.25), rows, [2.0770063995786869349, 0.48468247475641951239, 1.1543291419087275962])
b = affine(box(0.25, 0.25, 0.25), rows, [2, 0, 1.25])
gap = signed_distance(a, b)
row("fcl-493", "flexible-collision-library/fcl#493", "Two boxes of one orientation that touch to rounding", "an exception: the origin is outside of the polytope",
    {"query": "signed_distance", "a": a, "b": b}, {"signed_distance": gap}, "least support value along the facets of the difference", allow=1e-12)
box319 = posed(box(0.025, 0.195, 0.735), [0.8, -0.385, 0.735], [0, 0, 0.707107, 0.707107])
cyl319 = posed(upright(cylinder(0.09, 0.18)), [0.4, -0.4, 0.93], [0, 0, -0.130526, 0.991445])
# The cylinder stands upright and within the height of the box: circle and rectangle in the plane.
c319 = turned([0, 0, -0.707107, 0.707107], [mpf(0.4) - mpf(0.8), mpf(-0.4) - mpf(-0.385), 0])
gap319 = to_box(c319[:2], [0.025, 0.195]) - mpf(0.18)
row("fcl-319", "flexible-collision-library/fcl#319", "A box and an upright cylinder beside it", "an exception: this should not happen",
    {"query": "signed_distance", "a": box319, "b": cyl319}, {"signed_distance": float(gap319), "overlap": bool(gap319 <= 0)}, "circle and rectangle in the plane", allow=1e-9)
a = points([[-119.5, -120.5, -119.5], [-119.5, -119.5, -119.5], [-119.5, -120.5, -120.5], [-119.5, -119.5, -120.5], [-89.5, -120.5, -119.5], [-89.5, -119.5, -119.5], [-89.5, -120.5, -120.5], [-89.5, -119.5, -120.5]])
b = points([[-90.0, -120.14644661, -120.85355335], [-90.0, -120.85355339, -120.14644656], [-90.70710679, -119.64644658, -120.35355338], [-90.70710679, -120.35355336, -119.64644659], [-89.29289321, -119.64644664, -120.35355341], [-89.29289321, -120.35355342, -119.64644662], [-90.0, -119.14644661, -119.85355344], [-90.0, -119.85355339, -119.14644665]])
row("distance3d-72", "AlexanderFabisch/distance3d#72", "A bar of length 30 and a cube at its end, far from the origin", "an assertion fails",
    {"query": "signed_distance", "a": a, "b": b}, {"signed_distance": signed_distance(a, b), "overlap": True}, "least support value along the facets of the difference", allow=1e-9)
gap = sqrt((mpf(11.5) - mpf(0.05) - mpf(10.97)) ** 2 + (mpf(61.02) - mpf(60.5) - mpf(0.5)) ** 2) - mpf(0.5)
row("ncollide-157", "dimforge/ncollide#157", "An upright cylinder and a cuboid", "intersecting by two functions, no contact by the third",
    {"query": "signed_distance", "a": posed(cylinder(0.925, 0.5), [10.97, 0.925, 61.02]), "b": posed(box(0.05, 0.75, 0.5), [11.5, 0.75, 60.5])},
    {"signed_distance": float(gap), "overlap": True}, "circle and rectangle in the plane", allow=1e-9)
row("parry-34", "dimforge/parry#34", "A unit ball whose centre is a corner of the square", "no contact",
    {"query": "signed_distance", "a": posed(ball(1), [1, 1]), "b": box(1, 1)}, {"signed_distance": -1.0, "overlap": True}, "the ball has to leave by its radius", allow=1e-9)
row("parry-315", "dimforge/parry#315", "Two unit boxes that touch by a face", "one point of contact for both boxes, and a normal along the face",
    {"query": "signed_distance", "a": posed(box(0.5, 0.5, 0.5), [0.5, 0.5, 0.5]), "b": posed(box(0.5, 0.5, 0.5), [1.5, 0.5, 0.5])},
    {"signed_distance": 0.0, "overlap": True, "normal": [-1, 0, 0]}, "faces are parallel", allow=1e-12, allow_fields={"normal": 1e-9})
row("parry-70", "dimforge/parry#70", "A capsule half in a cuboid", "no intersection, at some of 200 heights",
    {"query": "intersect", "a": posed(capsule(0.5, 0.5), [0, 0.1, 0]), "b": posed(box(50, 50, 50), [0, -50, 0])}, {"overlap": True}, "the end of its axis is inside", pose="after the report")
row("mujoco-2206", "google-deepmind/mujoco#2206", "A ball wholly inside a box, near its top", "the depth is wrong from where the ball is wholly inside",
    {"query": "signed_distance", "a": posed(ball(0.005), [0, 0, -0.0125]), "b": posed(box(0.5, 0.5, 0.25), [0, 0, -0.255])},
    {"signed_distance": float(-(mpf(0.005) + mpf(0.0125) - (mpf(0.255) - mpf(0.25)))), "overlap": True}, "the top is a plane", pose="after the report", allow=1e-12)
axis = turned([-0.16498479, 0.36682746, -0.48718625, 0.77515626], [mpf(0), mpf(0), mpf(1)])
extent = mpf(0.07) * abs(axis[2]) + mpf(0.02) * sqrt(1 - axis[2] ** 2)
row("newton-3773", "newton-physics/newton#3773", "A small cylinder in the middle of a triangle of 335 m", "58.8 m deep",
    {"query": "signed_distance", "a": posed(upright(cylinder(0.07, 0.02)), [28.87991333, 260.53430176, 0.00036136055], [-0.16498479, 0.36682746, -0.48718625, 0.77515626]),
     "b": {"type": "triangle", "points": [[0, 0, 0], [100, 320, 0], [0, 320, 0]]}},
    {"signed_distance": float(mpf(0.00036136055) - extent), "overlap": True}, "how far the cylinder extends across the plane", allow=1e-9)
mesh = [[-0.0611590669, -0.13801524, -0.158372656], [0.0620514415, 0.135089189, -0.159879193], [-0.105518319, -0.100999095, -0.188289702], [-0.107238553, -0.102976903, 0.1569262], [-0.0851279497, -0.122304708, 0.156887323], [-0.0590926372, -0.104567274, -0.242715642]]
q = [0.0029009761, 0.0001424328, 0.8400087479, 0.5425650813]
a, b = posed(points(mesh), [-0.141666584, 0, 0], q), posed(points(mesh), [0.141666584, 0, 0], q)
row("mujoco-warp-1527", "google-deepmind/mujoco_warp#1527", "Two hulls of six points", "a small positive distance, where MuJoCo has a negative one",
    {"query": "signed_distance", "a": a, "b": b}, {"signed_distance": signed_distance(a, b)}, "least support value along the facets of the difference", allow=1e-9)
row("box2d-883", "erincatto/box2d#883", "A square of half width 0.4 in the middle of one of 0.5", "no overlap",
    {"query": "signed_distance", "a": posed(box(0.4, 0.4), [3, 5]), "b": posed(box(0.5, 0.5), [3, 5])}, {"signed_distance": float(-(mpf(0.4) + mpf(0.5))), "overlap": True}, "faces are parallel", allow=1e-12)

# Ellipsoids.
row("cgal-6626", "CGAL/cgal#6626", "The ellipsoid around a cube", "a cube was said to have no volume",
    {"query": "enclosing_ellipsoid", "points": cube}, {"log_det": float(-3 * mp.log(3))}, "the ball through the corners", pose="after the report", allow=1e-9)
row("drake-20839", "RobotLocomotion/drake#20839", "The ellipse in a square whose half-spaces are given at any scale", "the solver failed",
    {"query": "inscribed_ellipsoid", "halfspaces": [{"normal": [1e-9, 0], "offset": 1e-9}, {"normal": [-1e12, 0], "offset": 1e12}, {"normal": [0, 3], "offset": 3}, {"normal": [0, -0.1], "offset": 0.1}]},
    {"log_det": 0.0}, "the unit disc", pose="after the report", allow=1e-9)
row("volesti-418", "GeomScale/volesti#418", "The ellipse in a rectangle 1e7 times as long as wide", "an ellipsoid that need not be valid, and no failure, if the solver does not converge",
    {"query": "inscribed_ellipsoid", "halfspaces": [{"normal": [1, 0], "offset": 1}, {"normal": [-1, 0], "offset": 1}, {"normal": [0, 1], "offset": 1e-7}, {"normal": [0, -1], "offset": 1e-7}]},
    {"log_det": float(-2 * mp.log(mpf(1e-7)))}, "the rectangle's own ellipse", pose="after the report", allow=1e-7)

# Rays.
row("bepu-253", "bepu/bepuphysics2#253", "A ray from the middle of a cylinder along its axis", "no hit; a ray from there across the axis hits",
    {"query": "ray_cast", "target": cylinder(2, 3), "source": [0, 0, 0], "direction": [0, 1, 0]}, {"hit": True, "lambda": 0.0, "normal": None},
    "the source is inside")
row("bvh-107", "svenstaro/bvh#107", "A ray across a box of no thickness", "no hit",
    {"query": "ray_cast", "target": posed(box(1, 1, 0), [0, 0, 1]), "source": [0, 0, 0], "direction": [0, 0, 1]}, {"hit": True, "lambda": 1.0},
    "the box is its face", allow=1e-12)
row("collision-rs-17", "csherratt/collision-rs#17", "A ray beside a box, parallel to its faces", "a hit",
    {"query": "ray_cast", "target": posed(box(2, 2, 2), [3, 3, 3]), "source": [0, 0, 0], "direction": [1, 0, 0]}, {"hit": False}, "y is 0 all along")
row("monogame-7590", "MonoGame/MonoGame#7590", "A ray that passes a unit sphere", "a hit at 3",
    {"query": "ray_cast", "target": ball(1), "source": [0, 4, 0], "direction": [-2, -1, 0]}, {"hit": False}, "the line is 3.58 from the centre")
row("parry-31", "dimforge/parry#31", "A ray and a segment whose ends are one point, in the plane", "a hit",
    {"query": "ray_cast", "target": segment([10, 10], [10, 10]), "source": [0, 0], "direction": [1, 0]}, {"hit": False}, "y is 0 all along")
o, e = [0.41169768366272996, 0.8990554132423699], [0.47249211625247445, 0.2523149692768657]
row("meshes-639", "JuliaGeometry/Meshes.jl#639", "A ray at a rectangle, in the plane", "no hit by one function, a segment by another",
    {"query": "ray_cast", "target": posed(box(2, 0.5), [3, 1.5]), "source": o, "direction": e}, {"hit": True, "lambda": float((1 - mpf(o[0])) / mpf(e[0]))},
    "the side is a line", allow=1e-12)
row("jolt-1554", "jrouwe/JoltPhysics#1554", "A ray that ends on a face", "an assertion fails in one overload, and not in the other",
    {"query": "ray_cast", "target": box(1, 1, 1), "source": [0.25, 5, 0.125], "direction": [0, -4, 0], "max_lambda": 1}, {"hit": True, "lambda": 1.0},
    "the face is a plane", pose="after the report", allow=1e-12)

# Linear casts.
ball_at, block, towards = [784.470154, -88.887802], [802.5, 0], [0.630261, -0.776384]
row("ncollide-4", "dimforge/ncollide#4", "A ball half a unit beside a block, in the plane", "a hit at 57.570999, at the far side of the block",
    {"query": "linear_cast", "a": posed(ball(15), ball_at), "b": posed(box(2.5, 450), block), "velocity_a": towards},
    {"hit": True, "time": float((mpf(802.5) - mpf(2.5) - 15 - mpf(784.470154)) / mpf(0.630261))}, "the side is a line", allow=1e-9)
row("ncollide-35", "dimforge/ncollide#35", "A ball of radius 0.5 moves to another, whose centre is ten away", "a hit at 0.496231",
    {"query": "linear_cast", "a": ball(0.5), "b": posed(ball(0.5), [0, 10, 0]), "velocity_a": [0, 10, 0]}, {"hit": True, "time": 0.9}, "(10 − 1)/10", allow=1e-12)
row("parry-19", "dimforge/parry#19", "A ball moves to a segment that was turned by a right angle, in the plane", "no hit",
    {"query": "linear_cast", "a": ball(0.5), "b": posed(segment([1, 1], [-1, 1]), rotation=-float(mp.pi / 2)), "velocity_a": [1, 0]},
    {"hit": True, "time": 0.5}, "the segment is upright, at x = 1", allow=1e-12)
tri = [[7.33294010, 79.6109009, -26.9337997], [7.61456013, 80.2574005, -27.3008995], [7.33294010, 80.2574005, -26.9337997]]
start, towards, radius, half = [7.74110079, 80.8543167, -27.2595482], [-0.929564953, -0.0281119142, 0.367584974], 0.265350759, 0.340350509
foot = lambda t: [mpf(s) + mpf(d) * t - (mpf(half) if k == 1 else 0) for k, (s, d) in enumerate(zip(start, towards))]
over = first(lambda t: to_segment(foot(t), exact(tri[1]), exact(tri[2])) - mpf(radius), 0, mpf("0.149537891"))
row("physx-597", "NVIDIAGameWorks/PhysX#597", "An upright capsule moves to the edge of a triangle", "no hit; the report expects 0.0944",
    {"query": "linear_cast", "a": posed(capsule(half, radius), start), "b": triangle(*tri), "velocity_a": towards, "max_time": 0.149537891},
    {"hit": True, "time": float(over)}, "distance of the end of its axis from the edge", allow=1e-9)
row("physx-600", "NVIDIAGameWorks/PhysX#600", "A capsule in a triangle moves in the triangle's plane", "the overlap at the start is missed",
    {"query": "linear_cast", "a": posed(capsule(1, 0.3), rotation=[0, 0, -1, 1]), "b": triangle([0, 0, 0], [1, 0, 0], [0, 0, -1]), "velocity_a": [-1, 0, 0], "max_time": 1},
    {"hit": True, "time": 0.0}, "a corner is on the axis")
row("jolt-1734", "jrouwe/JoltPhysics#1734", "A cylinder falls on a box", "a contact axis of (−0.0118, −0.0081, 0.0118), where it is vertical",
    {"query": "linear_cast", "a": posed(cylinder(1.2, 0.75), [0.25, 5, 0.125]), "b": box(2, 1, 2), "velocity_a": [0, -1, 0]},
    {"hit": True, "time": float(5 - mpf(1.2) - 1), "normal": [0, 1, 0]}, "faces are parallel", pose="after the report", allow=1e-12, allow_fields={"normal": 1e-9})
row("godot-85314", "godotengine/godot#85314", "A sphere falls on a box beside its middle", "heights of contact that differ by more than 0.1 with the start",
    {"query": "linear_cast", "a": posed(ball(0.5), [0.37, 3, 0.21]), "b": box(2, 0.5, 2), "velocity_a": [0, -1, 0]}, {"hit": True, "time": 2.0},
    "the top is a plane", pose="after the report", allow=1e-12)
row("godot-103123", "godotengine/godot#103123", "A square a quarter above another moves down, 8000 from the origin, in the plane", "no collision, though the fraction is 0.25",
    {"query": "linear_cast", "precision": "f32", "a": posed(box(8, 8), [8000, 7941.75]), "b": posed(box(50, 50), [8000, 8000]), "velocity_a": [0, 1], "max_time": 1},
    {"hit": True, "time": 0.25}, "sides are parallel", pose="after the report", allow=1e-5)

# Distances and overlaps.
row("parry-431", "dimforge/parry#431", "A square and a rectangle, in the plane", "3.710461 apart, and 3.5731668 in the other order",
    {"query": "distance", "a": box(1, 1), "b": posed(box(1, 2), [-5.573167, 0])}, {"distance": float(mpf(5.573167) - 2), "overlap": False}, "sides are parallel", allow=1e-12)
p, a, b = [1.10000002, -7.9000001, 16.5879993], [2.27699995, -7.9000001, 16.3180008], [-0.569999993, -8.10000038, 16.6070004]
row("parry-76", "dimforge/parry#76", "A point and a triangle of which two corners are one point", "0 apart",
    {"query": "distance", "a": point(*p), "b": triangle(a, b, b)}, {"distance": float(to_segment(exact(p), exact(a), exact(b))), "overlap": False},
    "distance of a point from a segment", allow=1e-9)
row("ncollide-314", "dimforge/ncollide#314", "A ball of radius 5 and the point (50, 0, 0)", "(1, 0, 0) as the nearest point of the ball",
    {"query": "distance", "a": ball(5), "b": point(50, 0, 0)}, {"distance": 45.0, "overlap": False, "point_a": [5, 0, 0]}, "50 − 5", allow=1e-12, allow_fields={"point_a": 1e-9})
row("geometri-19", "RiSearcher/GeometRi.CSharp#19", "A point above a triangle", "0 apart",
    {"query": "distance", "a": point(1, 1, 4), "b": triangle([0, 0, 0], [2, 0, 0], [0, 2, 0])}, {"distance": 4.0, "overlap": False}, "its foot is on the triangle's side", allow=1e-12)
row("sceneview-1139", "sceneview/sceneview#1139", "Two segments at a right angle", "√5 apart, at (0, 0, 0) and (1, 2, 0)",
    {"query": "distance", "a": segment([0, 0, 0], [2, 0, 0]), "b": segment([1, 1, 0], [1, 3, 0])},
    {"distance": 1.0, "overlap": False, "point_a": [1, 0, 0], "point_b": [1, 1, 0]}, "the end of one is above the middle of the other", allow=1e-12,
    allow_fields={"point_a": 1e-9, "point_b": 1e-9})
row("godot-55384", "godotengine/godot#55384", "Two parallel segments side by side", "points that are no numbers",
    {"query": "distance", "a": segment([1, 1, 0], [3, 1, 0]), "b": segment([0, 0, 0], [4, 0, 0])}, {"distance": 1.0, "overlap": False}, "they are parallel",
    pose="after the report", allow=1e-12)
t1 = [[-0.37579435, 0.014414025, 0.3265663], [-0.37263185, 0.0108978925, 0.36118037], [-0.35647663, 0.03625821, 0.34328437]]
t2 = [[0.23884095, -1.6477574, 0.116889484], [0.26891768, -1.6353351, 0.10821109], [0.26338503, -1.6657706, 0.10510237]]
row("convex-body-17", "arlk/ConvexBodyProximityQueries.jl#17", "Two triangles far from one another", "0 apart, and 1.7844534 in the other order",
    {"query": "distance", "a": triangle(*t1), "b": triangle(*t2)}, {"distance": signed_distance(triangle(*t1), triangle(*t2)), "overlap": False},
    "shortest vector to the difference", allow=1e-9)
p0, p1 = [44.2919, 39.7508, 18.8208], [[46.0659, 38.6251, 16.3637], [44.2764, 42.3867, 18.239], [50.0397, 38.4649, 19.9843], [47.1963, 40.4563, 19.1057], [48.0266, 38.5593, 18.2475], [45.1735, 40.495, 17.3336], [48.0415, 40.4456, 18.1963]]
row("dolfinx-3653", "FEniCS/dolfinx#3653", "A point and the hull of seven points", "no answer: the limit of iterations is reached",
    {"query": "distance", "a": point(*p0), "b": points(p1)}, {"distance": signed_distance(point(*p0), points(p1)), "overlap": False}, "shortest vector to the difference", allow=1e-9)
a, b = [[0.795121, -0.727851], [-0.178424, -0.989183], [-0.412644, -0.770664], [0.566564, 0.548772]], [[-0.211223, -0.511346], [-0.347973, 0.45872], [0.277308, 0.969689]]
row("opengjk-3", "MattiaMontanari/openGJK#3", "A quadrilateral and a triangle that overlap, in the plane", "0.508965 apart",
    {"query": "distance", "a": points(a), "b": points(b)}, {"distance": 0.0, "overlap": True}, "least support value along the sides of the difference", allow=0.0)
assert signed_distance(points(a), points(b)) < 0
row("meshes-810", "JuliaGeometry/Meshes.jl#810", "A box and a segment that passes it", "they intersect",
    {"query": "distance", "a": points([[x, y, z] for x in (-130, -110.75) for y in (-18.78, -5.05) for z in (46.25, 60)]), "b": segment([-70, -50, 0], [-130, 0, 50])},
    {"distance": signed_distance(points([[x, y, z] for x in (-130, -110.75) for y in (-18.78, -5.05) for z in (46.25, 60)]), segment([-70, -50, 0], [-130, 0, 50])), "overlap": False},
    "shortest vector to the difference", allow=1e-9)
axes = float(sqrt(mpf(1.9)))
row("lazysets-3833", "JuliaReach/LazySets.jl#3833", "A square and a disc beside its corner, in the plane; found in a review", "not disjoint",
    {"query": "distance", "a": box(1, 1), "b": {"type": "ellipsoid", "center": [2, -2], "semi_axes": [axes, axes]}}, {"distance": float(sqrt(mpf(2)) - mpf(axes)), "overlap": False},
    "√2 − √1.9", allow=1e-12)
row("mujoco-1473", "google-deepmind/mujoco#1473", "A capsule above a box", "1 apart, by MJX",
    {"query": "distance", "a": posed(upright(capsule(0.15, 0.15)), [0, 0, 1]), "b": box(0.1, 0.1, 0.1)}, {"distance": float(1 - 2 * mpf(0.15) - mpf(0.1)), "overlap": False},
    "the face is a plane", allow=1e-12)
row("mathgeolib-51", "juj/MathGeoLib#51", "A triangle inside a box", "no intersection",
    {"query": "intersect", "a": triangle([0, 0, 0], [1, 0, 0], [0, 1, 0]), "b": box(2, 2, 2)}, {"overlap": True}, "its corners are inside")
row("parry-396", "dimforge/parry#396", "A cylinder in the middle of a larger one", "no intersection",
    {"query": "intersect", "a": cylinder(50, 100), "b": cylinder(1.5, 1)}, {"overlap": True}, "they have one centre")
row("parry-396-second", "dimforge/parry#396", "A capsule in the middle of a cylinder", "no intersection",
    {"query": "intersect", "a": cylinder(50, 100), "b": capsule(50, 10)}, {"overlap": True}, "they have one centre")

# Depths.
OUTSIDE = "an exception: the origin is outside of the polytope"
FACETS = "least support value along the facets of the difference"


def boxes(id, issue, title, reported, first_box, second_box):
    (size1, rows1, at1), (size2, rows2, at2) = first_box, second_box
    a = affine(box(*(s / 2 for s in size1)), rows1, at1) if rows1 else posed(box(*(s / 2 for s in size1)), at1)
    b = affine(box(*(s / 2 for s in size2)), rows2, at2) if rows2 else posed(box(*(s / 2 for s in size2)), at2)
    gap = signed_distance(a, b)
    row(id, issue, title, reported, {"query": "signed_distance", "a": a, "b": b}, {"signed_distance": gap},
        FACETS if gap <= 0 else "shortest vector to the difference", allow=1e-9 if abs(gap) > 1e-12 else 1e-12)


boxes("fcl-390", "flexible-collision-library/fcl#390", "A small box beside a tall one", OUTSIDE,
      ([0.03, 0.12, 0.1], [[-3.0627937852578681533e-08, -0.99999999999999888978, -2.8893865161583314238e-08], [0.9999999999999980016, -3.0627939739957803544e-08, 6.4729926918527511769e-08],
                           [-6.4729927722963847085e-08, -2.8893863029448751323e-08, 0.99999999999999711342]], [0.63499979627350811029, -0.48500002215636439651, 1.0778146458339641356]),
      ([0.025, 0.35, 1.845], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], [0.8, -0.4575, 1.0225]))
boxes("fcl-395", "flexible-collision-library/fcl#395", "A tilted box and a board of 1 cm", "an exception: the size of a triangle is zero",
      ([0.46, 0.48, 0.01], None, [-0.72099999999999997424, -0.77200000000000001954, 0.81000000000000005329]),
      ([0.049521, 0.146, 0.0725], [[0.10758262492983036718, -0.6624881850015212903, -0.74130653817877356637], [0.22682184885125472595, -0.709614040775253474, 0.6670830248314786326],
                                   [-0.96797615037608542021, -0.23991106241273435495, 0.07392465377049164954]], [-0.42677133002999478872, -0.76596851247746788882, 0.80746731400091054098]))
boxes("fcl-415", "flexible-collision-library/fcl#415", "Two boxes turned about one axis", "an exception: a point is in line with an edge",
      ([0.49, 0.05, 0.21], [[4.8966386501092529215e-12, -1, 0], [1, 4.8966386501092529215e-12, 0], [0, 0, 1]], [-0.43999999999999994671, -0.61499999999858001587, 0.35499999999999998224]),
      ([0.035, 0.12, 0.03], [[0.83512153565236335595, -0.55006546945762568868, -9.4542360608233572896e-16], [0.55006546945762568868, 0.83512153565236313391, 1.1787444236552387666e-15],
                             [1.2902271444330665572e-16, -1.4878153530113264589e-15, 1]], [-0.40653441507331000704, -0.69166166923735727945, 0.43057093858718892276]))
boxes("fcl-398", "flexible-collision-library/fcl#398", "A board inside a long box", "an exception",
      ([0.614, 3, 0.37], None, [-0.675, 0, 0.9115]), ([0.494, 0.552, 0.01], None, [-0.692, 0, 0.935]))
boxes("fcl-428", "flexible-collision-library/fcl#428", "Two boxes of one orientation that overlap", "an exception",
      ([0.2, 0.33, 0.1], None, [-0.071000000000000035305, -0.77200000000000001954, 0.79999999999999993339]), ([0.452, 0.27, 0.6], None, [0.12099999999999999645, -0.78769605692727695523, 0.53422044196125151316]))
boxes("fcl-445", "flexible-collision-library/fcl#445", "Two upright boxes side by side", OUTSIDE,
      ([0.31650000000000000355, 0.22759999999999999676, 0.1768000000000000127],
       [[0.44540578475530234748, 0.89532881496493399442, -8.8937407685638678971e-09], [-0.89532881496493377238, 0.44540578475530190339, -2.8948680226084145336e-08],
        [-2.1957263975186326105e-08, 2.0856732016652919226e-08, 0.99999999999999955591]], [1.2652949075960071568, 1.4551012423210101243, 0.49480006232932938204]),
      ([0.49430000000000001714, 0.35460000000000002629, 0.075200000000000002953],
       [[0.44171122913485860728, 0.8971572827861190591, -1.622764514865468214e-09], [-0.8971572827861190591, 0.44171122913485860728, -5.1621053952306079594e-09],
        [-3.9144271413829990148e-09, 3.7360349218094348098e-09, 1]], [1.1304016226141906376, 1.8410802645284281009, 0.44400006232932492933]))
tilted = [[0.94096063217417758029, 0.29296840037289501035, 0.16959541586174811667], [-0.23569836841299879326, 0.92661523595848427348, -0.29296840037289506586], [-0.2429801799032638987, 0.23569836841299884878, 0.94096063217417758029]]
boxes("fcl-493-second", "flexible-collision-library/fcl#493", "Two boxes of one orientation, apart by rounding", OUTSIDE,
      ([0.25, 0.25, 0.25], tilted, [0.073242100093223821977, 0.2316538089896212349, 1.3089245921032497399]), ([0.25, 0.25, 0.25], tilted, [0, 0, 1.25]))
boxes("drake-21673", "RobotLocomotion/drake#21673", "Two boxes with one centre", OUTSIDE,
      ([0.050000000000000002776, 0.55000000000000004441, 0.2999999999999999889], [[0.00079632671073326442932, -0.99999968293183538748, 0], [0.99999968293183538748, 0.00079632671073326442932, 0], [0, 0, 1]],
       [0.75000000000000055511, -2.4083715535715553102684e-15, 0.14999999999999999445]),
      ([0.25, 0.2000000000000000111, 0.14999999999999999445], [[6.1232339957367660359e-17, 0, 1], [-1, 6.1232339957367660359e-17, 6.1232339957367660359e-17], [-6.1232339957367660359e-17, -1, 3.7493994566546440196e-33]],
       [0.75, 0, 0.14999999999999999445]))
c = 0.70710700000000004106
prism = affine(points([[x, y, z] for x in (0.5, -0.5) for y, z in ((c, -c), (0, -1), (1, 0), (-1, 0), (-c, -c), (0, 1), (-c, c), (c, c))]),
               [[-2.0399676677885372849e-09, 0.77129744817973977522, -0.63647485922966484662], [2.4720879917217940548e-09, 0.63647485922966484662, 0.77129744817973977522], [1, 0, -3.2051032938795742666e-09]],
               [11.477445682202462862, 9.7785056920756936449, 0])
wedge = points([[x, y, z] for z in (-0.5, 0.5) for x, y in ((10.294759000000000881, 8.9321570000000001244), (11.618370999999999782, 9.4565629999999991639), (11.452372999999999692, 8.2276720000000000965))])
row("drake-21673-prisms", "RobotLocomotion/drake#21673", "An octagonal prism and a triangular one", OUTSIDE,
    {"query": "signed_distance", "a": prism, "b": wedge}, {"signed_distance": signed_distance(prism, wedge)}, FACETS, allow=1e-9)
s, t = [1.7855056639081962376e-10, 0.039999999999999993894, 0.33000000000000012657], [0.05, 0.15, 0.35]
row("fcl-408", "flexible-collision-library/fcl#408", "A sphere that touches a box to rounding", OUTSIDE,
    {"query": "signed_distance", "a": posed(ball(0.06), s), "b": posed(box(0.05, 0.05, 0.05), t)},
    {"signed_distance": float(to_box([mpf(x) - mpf(y) for x, y in zip(s, t)], [0.05] * 3) - mpf(0.06))}, "distance of a point from a box", allow=1e-12)
row("fcl-545", "flexible-collision-library/fcl#545", "A small cube around a corner of a large one", "√3 times as deep, along the diagonal",
    {"query": "signed_distance", "a": posed(box(0.05, 0.05, 0.05), [0.4, 0.4, 0.4]), "b": box(0.5, 0.5, 0.5)},
    {"signed_distance": -float(mpf(0.5) + mpf(0.05) - mpf(0.4)), "overlap": True}, "faces are parallel", pose="after the report", allow=1e-12)
# The cylinder lies above the box, beside its edge along y: distances of that edge from the cylinder.
cyl = [[0.62286449762754547699, 0.71651535568044355529, -0.31407891153229777759], [-0.20605566270224237591, -0.23703718387133412837, -0.94939688083050233214], [-0.75470582445316081177, 0.65606334948423605802, 4.0172294049188053423e-17]]
cyl_at = [0.20238033346825459735, 0.027845683594011010065, 0.3114233939246693339]
into = lambda p: [dot([exact(r)[k] for r in cyl], [x - mpf(y) for x, y in zip(p, cyl_at)]) for k in range(3)]
edge = lambda y: to_cylinder([into([mpf(0.4) - mpf(0.15), y, mpf(0.26885) + mpf(0.008)])[k] for k in (0, 2, 1)], mpf(0.085), mpf(0.041))
row("drake-21234", "RobotLocomotion/drake#21234", "A cylinder that lies beside the edge of a board", OUTSIDE,
    {"query": "signed_distance", "a": affine(upright(cylinder(0.085, 0.041)), cyl, cyl_at), "b": posed(box(0.15, 0.3, 0.008), [0.4, 0, 0.26885])},
    {"signed_distance": float(least(edge, -0.3, 0.3)), "overlap": False}, "distance of a line from a cylinder", allow=1e-9)
row("drake-8049", "RobotLocomotion/drake#8049", "A cylinder stands in a half-space, turned upside down", "0.001 deep; the same cylinder upright, 0.051",
    {"query": "signed_distance", "a": posed(upright(cylinder(0.05, 0.05)), [0, 0, -0.001], [1, 0, 0, 0]), "b": {"type": "half_space", "normal": [0, 0, 1], "offset": 0}},
    {"signed_distance": -float(mpf(0.05) + mpf(0.001)), "overlap": True}, "its base is a plane", pose="after the report", allow=1e-12)
row("coal-779", "coal-library/coal#779", "Two flat cylinders side by side", "0.1 deep, where a depth along x was expected; withdrawn, since the depth is the shortest way out",
    {"query": "signed_distance", "a": posed(upright(cylinder(0.05, 0.25)), [0.1, 0, 0]), "b": upright(cylinder(0.05, 0.25))},
    {"signed_distance": -0.1, "overlap": True}, "their bases are parallel", pose="after the report", allow=1e-12)
row("ncollide-256", "dimforge/ncollide#256", "A unit ball whose centre is a corner of the cube", "0 deep",
    {"query": "signed_distance", "a": posed(ball(1), [1, 1, 1]), "b": box(1, 1, 1)}, {"signed_distance": -1.0, "overlap": True}, "the ball has to leave by its radius", allow=1e-9)
low, high = [114.899994, 703.65], [725.1, 1142.6]
a = posed(box(*((h - l) / 2 for l, h in zip(low, high))), [(h + l) / 2 for l, h in zip(low, high)])
b = segment([-1087.5709, -369.54813], [600, 1087.5])
row("ncollide-343", "dimforge/ncollide#343", "A rectangle and a segment across its corner, in the plane", "no contact",
    {"query": "signed_distance", "a": a, "b": b}, {"signed_distance": signed_distance(a, b), "overlap": True}, "least support value along the sides of the difference", allow=1e-9)
v1 = [[1.9408982677575293, 1.7555630101186028, 0.18558370457138618], [0.8325772811802072, 0.07348739881751665, 1.7363835855830982], [0.4647979626331866, 0.7802364656205514, 0.7683352436509485],
      [1.8147849498111688, 0.1710650007346617, 1.802196858095821], [0.05742372721610556, 1.6599005060005285, 0.014474511746654706], [1.5270861966500002, 0.4945624540164677, 0.7162419894551117]]
v2 = [[0.13746727993941066, 0.20129636190312772, 0.34482818309629215], [0.5315223185064999, 0.859293459032485, 0.6275795914219559], [0.5810087058274663, 0.42871589938255994, 0.6201313431197037],
      [0.48395328848552066, 0.35710287272501984, 0.27586601014041534], [0.1586377710691551, 0.6421620047252284, 0.6487788989727401], [0.5185197562895357, 0.058044153658207476, 0.4020269780737239]]
row("distance3d-27", "AlexanderFabisch/distance3d#27", "Two hulls of six points", "an error",
    {"query": "signed_distance", "a": points(v1), "b": points(v2)}, {"signed_distance": signed_distance(points(v1), points(v2))}, "shortest vector to the difference", allow=1e-9)
# Two boxes that share half an edge.
turn = [[0, 0, 1], [-0.5, 0.86602540378444, 0], [-0.86602540378444, -0.5, 0]]
row("mathgeolib-12", "juj/MathGeoLib#12", "Two boxes that share half an edge", "no intersection",
    {"query": "signed_distance", "a": posed(box(0.5, 0.5, 0.5), [0.5, 0.5, 0.5]), "b": affine(posed(box(1, 1, 1), [1, 1, 1]), turn, [0, 0, 0])},
    {"signed_distance": 0.0}, "the plane z = 0 separates them, and the origin is in both", allow=1e-12)
row("mujoco-warp-1430", "google-deepmind/mujoco_warp#1430", "A small box a millimetre in one of 200 m", "a depth that grows with the large box, and then no contact",
    {"query": "signed_distance", "a": posed(box(0.1, 0.1, 0.1), [0, 0, 0.599]), "b": posed(box(100, 100, 0.25), [0, 0, 0.25])},
    {"signed_distance": float(mpf(0.599) - mpf(0.1) - mpf(0.5)), "overlap": True}, "faces are parallel", pose="after the report", allow=1e-12)
rows = [[0.99996972084045410156, 0.00776371126994490623, -0.00043433305108919740], [-0.00776385562494397163, 0.99996984004974365234, -0.00033095158869400620], [0.00043175052269361913, 0.00033431366318836808, 0.99999988079071044922]]
at = [0.00015228791744448245, -0.00074981129728257656, 0.29839199781417846680]
z = exact(rows[2])
reach = mpf(0.2) * abs(z[2]) + mpf(0.1) * sqrt(z[0] ** 2 + z[1] ** 2)
row("mujoco-warp-657", "google-deepmind/mujoco_warp#657", "A cylinder stands on a box, tilted by half a thousandth", "bad contacts",
    {"query": "signed_distance", "a": affine(upright(cylinder(0.2, 0.1)), rows, at), "b": box(1, 1, 0.1)}, {"signed_distance": float(mpf(at[2]) - reach - mpf(0.1)), "overlap": True},
    "how far the cylinder extends across the top", allow=1e-9)

# Ellipsoids.
row("volesti-325", "GeomScale/volesti#325", "The ellipse in a square, in the plane", "an exception",
    {"query": "inscribed_ellipsoid", "halfspaces": [{"normal": [1, 0], "offset": 1}, {"normal": [-1, 0], "offset": 1}, {"normal": [0, 1], "offset": 1}, {"normal": [0, -1], "offset": 1}]},
    {"log_det": 0.0}, "the unit disc", pose="after the report", allow=1e-9)

HERE = os.path.dirname(os.path.abspath(__file__))
with open(os.path.join(HERE, "museum_today.json"), encoding="utf-8") as file:
    TODAY = json.load(file)
with open(os.path.join(HERE, "museum.jsonl"), "w", encoding="utf-8") as file:
    file.write("# Written by museum.py, which says what the fields are.\n")
    for line in ROWS:
        file.write(json.dumps({**line, "_today": TODAY.get(line["id"], "not asked")}, ensure_ascii=False) + "\n")
print(len(ROWS), "rows")
