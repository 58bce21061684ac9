#!/usr/bin/env python3
"""Writes gradients.jsonl: queries with "gradient": true, whose true answers and derivatives are formulas of a few lines.

    python3 gradients.py > gradients.jsonl

Everything is evaluated in 60 digits on the doubles as written, and rounded once. With n the normal out of b and p the closest
point, the derivative of a distance by the pose of a is the force n at p, that of a time −n/(n·w), turned back to the start pose.
"""

import json
import random
from decimal import Decimal as D
from decimal import getcontext

getcontext().prec = 60
rng = random.Random(20260911)
lines = []


def num(span=4):
    return rng.randint(-(2**10), 2**10) / 2**10 * span


def size():
    return rng.randint(2**8, 2**10) / 2**10


def dec(v):
    return [D(x) for x in v]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def add(a, b, s=1):
    return [x + y * s for x, y in zip(a, b)]


def scaled(v, s):
    return [x * s for x in v]


def norm(v):
    return dot(v, v).sqrt()


def cross(a, b):
    if len(a) == 2:
        return a[0] * b[1] - a[1] * b[0]
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def trig(angle):
    """Cosine and sine by their series."""
    angle, c, s, term, k = D(angle), D(1), D(0), D(1), 0
    while k < 200:
        k += 1
        term = term * angle / k
        if k % 4 == 1:
            s += term
        elif k % 4 == 2:
            c -= term
        elif k % 4 == 3:
            s -= term
        else:
            c += term
    return c, s


def turn(omega, t):
    """The matrix, by rows, of the rotation by |omega|·t about omega; in 2D by the angle."""
    if not isinstance(omega, list):
        c, s = trig(D(omega) * t)
        return [[c, -s], [s, c]]
    w = dec(omega)
    rate = norm(w)
    if rate == 0:
        return [[D(i == j) for j in range(3)] for i in range(3)]
    x, y, z = scaled(w, 1 / rate)
    c, s = trig(rate * t)
    d = 1 - c
    return [
        [c + x * x * d, x * y * d - z * s, x * z * d + y * s],
        [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
        [z * x * d - y * s, z * y * d + x * s, c + z * z * d],
    ]


def quaternion(q):
    x, y, z, w = scaled(dec(q), 1 / norm(dec(q)))
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]


def times(m, v):
    return [dot(row, v) for row in m]


def back(m, v):
    return times(list(zip(*m)), v)


def force(f, p):
    """The derivative that is the force f at the point p."""
    return {"translation": f, "rotation": cross(p, f)}


def floats(value):
    if isinstance(value, D):
        return float(value)
    if isinstance(value, dict):
        return {k: floats(v) for k, v in value.items()}
    return [floats(v) for v in value] if isinstance(value, list) else value


def emit(name, query, expect, scalar=None, precision="f64", allowed=1):
    """`allowed` is by how much the derivatives magnify what the inputs are wrong by."""
    case = {"id": "gradient/%s/%d" % (name, len(lines)), **query, "gradient": True, "tags": ["gradient", name, precision]}
    relative = 1e-5 if precision == "f32" else 1e-11
    if precision == "f32":
        case["precision"] = "f32"
    case["expect"] = floats(expect)
    if scalar is not None:
        case["allow"] = relative * max(abs(float(scalar)), float(allowed))
    fields = {k: 100 * relative * float(allowed) for k in ("gradient_a", "gradient_b") if k in expect}
    if fields:
        case["allow_fields"] = fields
    lines.append(json.dumps(case, separators=(",", ":")))


def ball(center, radius):
    return {"type": "posed", "translation": center, "of": {"type": "ball", "radius": radius}}


def balls(n, precision):
    for query, sign in (("distance", 1), ("signed_distance", 1), ("signed_distance", -1)):
        (ra, rb), axis = (size(), size()), [num() for _ in range(n)]
        b = [num() for _ in range(n)]
        away = (1 + 0.5 * sign) * (ra + rb) / float(norm(dec(axis)))
        a = [x + y * away for x, y in zip(b, axis)]
        between = add(dec(a), dec(b), -1)
        apart, normal = norm(between) - D(ra) - D(rb), scaled(between, 1 / norm(between))
        expect = {query: apart, "gradient_a": force(normal, dec(a)), "gradient_b": force(scaled(normal, D(-1)), dec(b)), "smooth": True}
        emit("balls", {"query": query, "a": ball(a, ra), "b": ball(b, rb)}, expect, apart, precision, 8)


def pose(n):
    """A rotation as written, and its matrix."""
    if n == 2:
        angle = num(3)
        return angle, turn(angle, D(1))
    q = [num(1) for _ in range(3)] + [1 + size()]
    return q, quaternion(q)


def above_floor(n, precision, depth):
    """A leaning body over a floor of half extent 50, whose top is at y = 1: its lowest point decides."""
    rotation, matrix = pose(n)
    half = [size() for _ in range(n)]
    for kind in ("cuboid", "ellipsoid"):
        # The lowest point of the body about zero.
        row = scaled(matrix[1], D(-1))
        if kind == "cuboid":
            local = [D(h).copy_sign(r) for h, r in zip(half, row)]
        else:
            reach = norm([D(h) * r for h, r in zip(half, row)])
            local = [D(h) ** 2 * r / reach for h, r in zip(half, row)]
        lowest = times(matrix, local)
        at = [num() for _ in range(n)]
        at[1] = float(1 - lowest[1]) + (-0.0625 if depth else 0.5)
        p = add(dec(at), lowest)
        apart, up = p[1] - 1, [D(i == 1) for i in range(n)]
        if kind == "cuboid":
            a = {"type": "posed", "translation": at, "rotation": rotation, "of": {"type": "cuboid", "half_extents": half}}
        else:
            a = {"type": "ellipsoid", "center": at, "semi_axes": half, "rotation": rotation}
        floor = {"type": "cuboid", "half_extents": [50.0, 1.0] + [50.0] * (n - 2)}
        pair = {"a": a, "b": floor}
        expect = {"gradient_a": force(up, p), "gradient_b": force(scaled(up, D(-1)), p), "smooth": True}
        for query in ("signed_distance",) if depth else ("distance", "signed_distance"):
            emit("above-floor", {"query": query, **pair}, {query: apart, **expect}, apart, precision, 8)
        if depth and kind == "ellipsoid" and precision == "f64":
            # The search for the way out of a curved body ends at 1e-9 of the size, here of the floor's.
            case = json.loads(lines[-1])
            lines[-1] = json.dumps({**case, "allow": 1.5e-7}, separators=(",", ":"))
        if not depth:
            velocity = [num(1) for _ in range(n)]
            velocity[1] = -1.5
            v = dec(velocity)
            fall = scaled(up, 1 / -v[1])
            t = apart / -v[1]
            # The floor is where its own point is, and does not move.
            there = add(p, v, t)
            expect = {"hit": True, "time": t, "gradient_a": force(fall, p), "gradient_b": force(scaled(fall, D(-1)), there), "smooth": True}
            emit("falling", {"query": "linear_cast", **pair, "velocity_a": velocity}, expect, t, precision, 8)


def no_smooth_place(n):
    box = {"type": "cuboid", "half_extents": [1.0] * n}
    at = lambda v: {"type": "posed", "translation": v, "of": box}
    beside = at([2.5] + [0.25] * (n - 1))
    corner = at([3.0] * n)
    for query in ("distance", "signed_distance"):
        emit("parallel", {"query": query, "a": beside, "b": box}, {query: 0.5, "smooth": False}, 0.5)
        apart = D(n).sqrt()
        normal = [1 / apart] * n
        expect = {query: apart, "gradient_a": force(normal, [D(2)] * n), "gradient_b": force(scaled(normal, D(-1)), [D(1)] * n), "smooth": True}
        emit("corners", {"query": query, "a": corner, "b": box}, expect, apart)
    emit("parallel", {"query": "signed_distance", "a": at([1.5] + [0.25] * (n - 1)), "b": box}, {"signed_distance": -0.5, "smooth": False}, 0.5)
    emit("equal-ways-out", {"query": "signed_distance", "a": at([1.0] * n), "b": box}, {"signed_distance": -1.0, "smooth": False}, 1.0)
    emit("corners", {"query": "linear_cast", "a": corner, "b": box, "velocity_a": [-1.0] * n}, {"hit": True, "time": 1.0, "smooth": False}, 1.0)
    emit("faces", {"query": "linear_cast", "a": beside, "b": box, "velocity_a": [-1.0] + [0.0] * (n - 1)}, {"hit": True, "time": 0.5, "smooth": False}, 0.5)
    # Within one another: the distance and the time are 0, and stay so.
    none = {"translation": [0.0] * n, "rotation": [0.0] * 3 if n == 3 else 0.0}
    floor = {"gradient_a": none, "gradient_b": none, "smooth": True}
    within = {"a": at([0.5] * n), "b": box}
    emit("within", {"query": "distance", **within}, {"distance": 0.0, "overlap": True, **floor}, 0)
    emit("within", {"query": "linear_cast", **within, "velocity_a": [1.0] * n}, {"hit": True, "time": 0.0, **floor}, 0)


def turning(n, precision):
    """A ball that turns about a centre that moves, and one that moves: the first time at which they are near enough."""
    while True:
        (ra, rb) = size(), size()
        a, b, center = ([num(2) for _ in range(n)] for _ in range(3))
        va, vb = ([num(1) for _ in range(n)] for _ in range(2))
        omega = [num(1) for _ in range(3)] if n == 3 else num(1)
        reach = D(ra) + D(rb)

        def at(t):
            r = turn(omega, t)
            arm = times(r, add(dec(a), dec(center), -1))
            x = add(add(dec(center), dec(va), t), arm)
            spun = cross(dec(omega), arm) if n == 3 else scaled([-arm[1], arm[0]], D(omega))
            return r, x, add(dec(b), dec(vb), t), add(add(dec(va), spun), dec(vb), -1)

        gap = lambda t: norm(add(at(t)[1], at(t)[2], -1)) - reach
        steps = [D(k) / 16 for k in range(33)]
        gaps = [gap(t) for t in steps]
        first = next((k for k in range(1, 33) if gaps[k] < D("-0.02")), None)
        if gaps[0] < D("0.1") or first is None or any(g < D("0.02") for g in gaps[: max(first - 1, 1)]):
            continue
        low, high = steps[first - 1] if gaps[first - 1] > 0 else steps[first - 2], steps[first]
        for _ in range(180):
            middle = (low + high) / 2
            low, high = (middle, high) if gap(middle) > 0 else (low, middle)
        r, x, y, w = at(low)
        normal = scaled(add(x, y, -1), 1 / reach)
        closing = -dot(normal, w)
        if closing < D("0.2"):
            continue
        f = scaled(normal, 1 / closing)
        expect = {"hit": True, "time": low, "gradient_a": force(back(r, f), dec(a)), "gradient_b": force(scaled(f, D(-1)), dec(b)), "smooth": True}
        query = {"query": "motion_cast", "a": ball(a, ra), "b": ball(b, rb), "max_time": 2.5}
        query["motion_a"] = {"velocity": va, "angular_velocity": omega, "center": center}
        query["motion_b"] = {"velocity": vb}
        emit("turning", query, expect, low, precision, 40)
        return


for n in (2, 3):
    for precision in ("f64", "f32"):
        for _ in range(5):
            balls(n, precision)
            above_floor(n, precision, False)
            above_floor(n, precision, True)
            turning(n, precision)
    no_smooth_place(n)

print("# Written by gradients.py.")
print("\n".join(lines))
