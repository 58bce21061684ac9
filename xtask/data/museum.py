#!/usr/bin/env python3
"""Writes `museum.jsonl`: poses out of public trackers, with their truth. Needs mpmath, numpy and scipy.

Every line is a query of the query format, and says in fields of its own where it is from: `_issue`, `_title`, `_reported`, and
`_pose`, which is "given" where all numbers that decide are those of the report, and "after the report" where a number that it
leaves out was chosen here. `_truth` says how the truth is known. Truths are closed forms in fifty digits. Those of polytopes
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
    if kind == "cuboid":
        h = exact(shape["half_extents"])
        return [[s * c for s, c in zip(signs, h)] for signs in np.ndindex(*[2] * len(h))
                for signs in [[2 * s - 1 for s in signs]]]
    if kind == "polytope":
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
    if least >= 0:
        return float(-least)
    # Apart: the shortest vector, by its active points.
    size = max(abs(float(c)) for p in v for c in p)
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


def to_box(p, h):
    d = [max(abs(c) - mpf(e), 0) for c, e in zip(p, h)]
    return sqrt(dot(d, d))


# Rays.
row("bullet-1947", "bulletphysics/bullet3#1947", "Nearly perpendicular rays at a wall a kilometre wide",
    "z from 49.6 to 50 across the wall, whose front is at 50",
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
row("godot-jolt-652", "godot-jolt/godot-jolt#652", "A ray that starts inside a solid", "the normal of some surface; a convention, not an error of geometry",
    {"query": "ray_cast", "target": cylinder(2, 1), "source": [0.05, 0.02, -0.03], "direction": [0, 1, 0]}, {"hit": True, "lambda": 0.0, "normal": None},
    "the source is inside: the hit is at 0 and has no normal", pose="after the report")

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
row("rapier-js-258-second", "dimforge/rapier.js#258", "The same with another bar", "the ray hits, the shape cast misses",
    {"query": "linear_cast", "a": posed(ball(1), [894, 328]), "b": posed(box(335, 0.5), [408, 286.5]), "velocity_a": [-509, -111], "max_time": 1},
    {"hit": True, "time": float(over)}, "distance of a point from a box", pose="after the report", allow=1e-12)
row("physx-610", "NVIDIAGameWorks/PhysX#610", "A cube falls on a cube, from y = 15 to 10", "2.9975",
    {"query": "linear_cast", "a": posed(box(1, 1, 1), [0, 15, 0]), "b": posed(box(1, 1, 1), [0, 10, 0]), "velocity_a": [0, -1, 0]},
    {"hit": True, "time": 3.0}, "faces are parallel", allow=1e-12)
slab, start, end = [19.92, 0.92, 49.92], [-27.449842, -2.994380, 109.886520], [-27.529308, -3.604819, 109.553276]
q = [-0.057141, 0.572179, 0.040011, 0.817157]
velocity = [float(mpf(repr(b)) - mpf(repr(a))) for a, b in zip(start, end)]
place = lambda t: turned(inverse(q), [mpf(a) + mpf(v) * t - c for a, v, c in zip(start, velocity, [0, 0, 120])])
gap = lambda t: to_box(place(t), slab) - mpf(0.45)
near = min((gap(mpf(k) / 1000), k) for k in range(1001))
expect = {"hit": True, "time": float(first(gap, 0, mpf(near[1]) / 1000))} if near[0] < 0 and gap(0) > 0 else ({"hit": True, "time": 0.0} if gap(0) <= 0 else {"hit": False})
row("bullet-596", "bulletphysics/bullet3#596", "A ball and a turned slab of 100 m", "a hit 10.8 m away, depending on what was asked before",
    {"query": "linear_cast", "a": posed(ball(0.45), start), "b": posed(box(*slab), [0, 0, 120], q), "velocity_a": velocity, "max_time": 1},
    expect, "distance of a point from a box", allow=1e-9)
row("box3d-32", "erincatto/box3d#32", "A box a tenth of a millimetre above another moves away", "a hit at fraction 0, in every direction",
    {"query": "linear_cast", "a": posed(box(1, 1, 1), [0, 2.0001, 0]), "b": box(1, 1, 1), "velocity_a": [0, 1, 0]}, {"hit": False},
    "the gap grows", pose="after the report")
row("parry-107", "dimforge/parry#107", "A ball slides along a wall, which it is 3 mm deep in, in the plane", "no hit through the tree, a hit at 3.4e-8 without it",
    {"query": "linear_cast", "a": posed(ball(96), [216.02324, -1632.0032]), "b": posed(box(1280, 96), [0, -1824]), "velocity_a": [-636.3961, -636.3961], "max_time": 1 / 60},
    {"hit": True, "time": 0.0}, "it overlaps at the start")

cubes = lambda v: {"query": "linear_cast", "a": posed(box(0.5, 0.5, 0.5), [0, 1.1, 0]), "b": box(0.5, 0.5, 0.5), "velocity_a": v}
row("ncollide-141", "dimforge/ncollide#141", "Two cubes that rest, a tenth apart", "a hit at 0", cubes([0, 0, 0]), {"hit": False}, "nothing moves")
row("ncollide-214", "dimforge/ncollide#214", "A square moves to a rectangle ten away, in the plane", "no hit",
    {"query": "linear_cast", "a": box(1, 1), "b": posed(box(1, 1.5), [10, 0]), "velocity_a": [1, 0]}, {"hit": True, "time": 8.0}, "faces are parallel", allow=1e-12)

# Turning casts, whose truths were found in ninety digits.
TURNING = {
    "physx-398": ("NVIDIAGameWorks/PhysX#398", "A box swings about a point 205 away", "what turns is let into what it hits"),
    "ncollide-369": ("dimforge/ncollide#369", "Two boxes move side by side at one velocity", "an endless loop"),
    "godot-jolt-389": ("godot-jolt/godot-jolt#389", "A rod turns by half a turn within one step, past a ball", "tunnels: the turn is left out, as the documentation of Jolt says"),
    "box2d-115": ("erincatto/box2d#115", "A long box and a square that turns by 0.26, in the plane", "touching, where there is a gap; an endless loop without taking whole turns off"),
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
row("fcl-508", "flexible-collision-library/fcl#508", "Unit boxes four apart along y", "3.16228",
    {"query": "distance", "a": posed(box(0.5, 0.5, 0.5), [0, 4, 0]), "b": box(0.5, 0.5, 0.5)}, {"distance": 3.0, "overlap": False}, "faces are parallel", allow=1e-12)
row("fcl-275", "flexible-collision-library/fcl#275", "Spheres of radius 20 and 10, centres 40 apart along y", "25",
    {"query": "distance", "a": ball(20), "b": posed(ball(10), [0, 40, 0])}, {"distance": 10.0, "overlap": False}, "40 − 20 − 10", allow=1e-12)
row("fcl-127", "flexible-collision-library/fcl#127", "A unit sphere and a box", "the distance is right, the nearest points are not",
    {"query": "distance", "a": ball(1), "b": posed(box(5, 1, 5), [0, 5, 3])}, {"distance": 3.0, "overlap": False, "point_a": [0, 1, 0], "point_b": [0, 4, 0]},
    "the nearest face is a plane", allow=1e-12, allow_fields={"point_a": 1e-9, "point_b": 1e-9})
a = affine(box(0.1815, 0.1385, 0.1815), [[0.9999195703, 0.01021849413, 0.007512347878], [-0.01021878248, 0.9999477869, -3.329855922e-17], [-0.007511955635, -7.676704888e-05, 0.9999717819]], [1.503354966, -0.8531707835, 0.7700092418])
b = affine(box(0.1815, 0.1815, 0.1385), [[0.9998670967, -0.01297708324, 0.009868343982], [0.01297771517, 0.9999157859, 5.255670031e-17], [-0.009867512928, 0.0001280685574, 0.9999513067]], [1.48838308, -1.102020834, 0.4497073799])
gap = signed_distance(a, b)
row("coal-604", "coal-library/coal#604", "Two boxes nearly parallel and close", "totally wrong, with a tolerance above 1e-6",
    {"query": "distance", "a": a, "b": b}, {"distance": gap, "overlap": False}, "shortest vector to the difference", allow=1e-9)
row("jitter-302", "notgiven688/jitterphysics2#302", "A unit box, and a cloud of one point", "the distance says apart, the overlap test says together",
    {"query": "distance", "a": points([[1, 0, 0]]), "b": box(0.5, 0.5, 0.5)}, {"distance": 0.5, "overlap": False}, "the face is a plane", allow=1e-12)
ax, ay = [90945.08, 91077.46, 91454.92, 91322.54], [54122.54, 53745.082, 53877.46, 54254.918]
bx, by = [90919.64, 91162.62, 91480.36, 91237.38], [54037.383, 53719.637, 53962.617, 54280.363]
prism = lambda x, y: points([[float(np.float32(p)), float(np.float32(q)), z] for z in (300, 0) for p, q in zip(x, y)])
row("opengjk-52", "MattiaMontanari/openGJK#52", "Two boxes that overlap, far from the origin", "0.0032915156",
    {"query": "distance", "precision": "f32", "a": prism(ax, ay), "b": prism(bx, by)}, {"distance": 0.0, "overlap": True}, "the same middle is in both", allow=0.0)

# Depths and overlaps.
row("libccd-25", "danfis/libccd#25", "Cubes of side 2, centres 1.9 apart along z", "depth 0, and a direction that is no number",
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
row("parry-315", "dimforge/parry#315", "Two unit boxes that touch by a face", "one point for both, and a normal along the face",
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
    {"signed_distance": float(mpf(0.00036136055) - extent), "overlap": True}, "how far the cylinder reaches across the plane", allow=1e-9)
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
row("volesti-418", "GeomScale/volesti#418", "The ellipse in a rectangle 1e7 times as long as wide", "called solved, and is not",
    {"query": "inscribed_ellipsoid", "halfspaces": [{"normal": [1, 0], "offset": 1}, {"normal": [-1, 0], "offset": 1}, {"normal": [0, 1], "offset": 1e-7}, {"normal": [0, -1], "offset": 1e-7}]},
    {"log_det": float(-2 * mp.log(mpf(1e-7)))}, "the rectangle's own ellipse", pose="after the report", allow=1e-7)

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "museum.jsonl"), "w", encoding="utf-8") as file:
    file.write("# Written by museum.py, which says what the fields are.\n")
    for line in ROWS:
        file.write(json.dumps(line, ensure_ascii=False) + "\n")
print(len(ROWS), "rows")
