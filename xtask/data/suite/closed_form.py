#!/usr/bin/env python3
"""Writes closed_form.jsonl: queries whose true answers are a formula of a line or two.

    python3 closed_form.py > closed_form.jsonl

Every formula is evaluated in 60 digits on the doubles as written, and rounded once. What is allowed is 1e-12 (in f32
1e-5) of the scalar or of the size of the bodies, whichever is larger: far above rounding, far below any shortcut.
"""

import json
import random
from decimal import Decimal as D
from decimal import getcontext

getcontext().prec = 60
rng = random.Random(20240607)
lines = []


def num(x):
    """A number with few digits, so that sums and products of a few are exact in doubles and nearly so in floats."""
    return rng.randint(-(2**10), 2**10) / 2**8


def size():
    return rng.randint(1, 2**10) / 2**8


def dec(v):
    return [D(x) for x in v]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def scaled(v, s):
    return [x * s for x in v]


def emit(name, query, expect, scalar, extent, tags, precision="f64"):
    case = {"id": "closed/%s/%d" % (name, len(lines)), **query}
    if precision == "f32":
        case["precision"] = "f32"
    case["tags"] = ["closed-form", name] + tags
    case["expect"] = {k: float(v) if isinstance(v, D) else v for k, v in expect.items()}
    if scalar is not None:
        relative = D("1e-5") if precision == "f32" else D("1e-12")
        case["allow"] = float(relative * max(abs(scalar), D(extent)))
    lines.append(json.dumps(case, separators=(",", ":")))


def ball(center, radius):
    return {"type": "posed", "translation": center, "of": {"type": "ball", "radius": radius}}


def box(center, half):
    return {"type": "posed", "translation": center, "of": {"type": "cuboid", "half_extents": half}}


def first_contact(relative, velocity, reach):
    """The smallest t >= 0 with |relative + t·velocity| = reach, or none; a point against a ball."""
    a, b, c = dot(velocity, velocity), dot(relative, velocity), dot(relative, relative) - reach * reach
    if c <= 0:
        return D(0)
    discriminant = b * b - a * c
    return None if b >= 0 or discriminant < 0 else c / (-b + discriminant.sqrt())


def entry(source, direction, low, high):
    """Where a ray enters a box, by slabs; none where it misses."""
    near, far = D(0), D("Infinity")
    for s, d, l, h in zip(source, direction, low, high):
        if d == 0:
            if not l <= s <= h:
                return None
            continue
        t = sorted(((l - s) / d, (h - s) / d))
        near, far = max(near, t[0]), min(far, t[1])
    return near if near <= far else None


def clear(t, bound="1e-6"):
    """Whether a hit or miss is beyond doubt of rounding is decided by the caller; here: far from 0."""
    return t is None or t > D(bound)


def casts(n, scale, precision, tags):
    for _ in range(4):
        # A ball of which the ray is certain: the discriminant well away from 0.
        center, radius = scaled([num(0) for _ in range(n)], scale), size() * scale
        source = scaled([num(0) * 4 for _ in range(n)], scale)
        aim = [c - s + num(0) * radius / 8 for c, s in zip(center, source)]
        relative, direction = sub(dec(source), dec(center)), dec(aim)
        if dot(relative, relative) < 2 * D(radius) ** 2:
            continue
        b = dot(relative, direction)
        disc = b * b - dot(direction, direction) * (dot(relative, relative) - D(radius) ** 2)
        if abs(disc) < D("1e-2") * b * b:
            continue
        t = first_contact(relative, direction, D(radius))
        query = {"query": "ray_cast", "target": ball(center, radius), "source": source, "direction": aim}
        expect = {"hit": t is not None}
        if t is not None:
            expect["lambda"] = t
        emit("ray-ball", query, expect, t, 0, tags, precision)
    for _ in range(4):
        center = scaled([num(0) for _ in range(n)], scale)
        half = scaled([size() for _ in range(n)], scale)
        source = scaled([num(0) * 8 for _ in range(n)], scale)
        aim = [c - s + h * rng.choice([-0.5, 0, 0.25, 4]) for c, s, h in zip(center, source, half)]
        low, high = sub(dec(center), dec(half)), [c + h for c, h in zip(dec(center), dec(half))]
        if not any(aim):
            continue
        answers = {
            entry(dec(source), dec(aim), [l * (1 + g) - c * g for l, c in zip(low, dec(center))],
                  [h * (1 + g) - c * g for h, c in zip(high, dec(center))]) is None
            for g in (D("-1e-3"), D("1e-3"))
        }
        t = entry(dec(source), dec(aim), low, high)
        if len(answers) > 1 or not clear(t):
            continue
        query = {"query": "ray_cast", "target": box(center, half), "source": source, "direction": aim}
        expect = {"hit": t is not None}
        if t is not None:
            expect["lambda"] = t
        emit("ray-box", query, expect, t, 0, tags, precision)
    for _ in range(4):
        a, b = scaled([num(0) for _ in range(n)], scale), scaled([num(0) * 4 for _ in range(n)], scale)
        ra, rb = size() * scale / 2, size() * scale / 2
        velocity = [(y - x) / 4 for x, y in zip(a, b)]
        relative = sub(dec(a), dec(b))
        reach = D(ra) + D(rb)
        if dot(relative, relative) < 2 * reach * reach:
            continue
        t = first_contact(relative, dec(velocity), reach)
        query = {"query": "linear_cast", "a": ball(a, ra), "b": ball(b, rb), "velocity_a": velocity}
        emit("linear-balls", query, {"hit": True, "time": t}, t, 0, tags, precision)


def distances(n, scale, precision, tags):
    for _ in range(4):
        a, b = [scaled([num(0) for _ in range(n)], scale) for _ in range(2)]
        ra, rb = size() * scale / 4, size() * scale / 4
        d = sub(dec(a), dec(b))
        apart = dot(d, d).sqrt() - D(ra) - D(rb)
        if abs(apart) < D("1e-2") * D(ra + rb):
            continue
        query = {"a": ball(a, ra), "b": ball(b, rb)}
        extent = D(ra + rb) / 16
        expect = {"distance": max(apart, D(0)), "overlap": apart < 0}
        emit("distance-balls", {"query": "distance", **query}, expect, expect["distance"], extent, tags, precision)
        emit("intersect-balls", {"query": "intersect", **query}, {"overlap": apart < 0}, None, 0, tags, precision)
    for _ in range(4):
        a, b = [scaled([num(0) * 2 for _ in range(n)], scale) for _ in range(2)]
        ha, hb = [scaled([size() / 2 for _ in range(n)], scale) for _ in range(2)]
        gaps = [abs(x - y) - p - q for x, y, p, q in zip(dec(a), dec(b), dec(ha), dec(hb))]
        if any(abs(g) < D("1e-2") * D(scale) for g in gaps):
            continue
        d = sum(max(g, D(0)) ** 2 for g in gaps).sqrt()
        query = {"query": "distance", "a": box(a, ha), "b": box(b, hb)}
        extent = D(max(ha + hb))
        emit("distance-boxes", query, {"distance": d, "overlap": d == 0}, d, extent, tags, precision)
        # The same boxes as sums of flat boxes, rounded: the radii come off the distance.
        if d > 0:
            r = float(d) / 4
            parts = [{"type": "cuboid", "half_extents": [h if i == k else 0.0 for i in range(n)]} for k, h in enumerate(ha)]
            a_sum = {"type": "posed", "translation": a, "of": {"type": "minkowski_sum", "of": parts}}
            query = {"query": "distance", "a": {"type": "rounded", "radius": r, "of": a_sum}, "b": box(b, hb)}
            emit("distance-rounded-sum", query, {"distance": d - D(r), "overlap": False}, d - D(r), extent, tags, precision)


def margins(n, scale, precision, tags):
    for _ in range(4):
        a, b = [scaled([num(0) * 2 for _ in range(n)], scale) for _ in range(2)]
        ra, rb = size() * scale, size() * scale
        d = dot(sub(dec(a), dec(b)), sub(dec(a), dec(b))).sqrt()
        if abs(d - D(rb)) < D("1e-2") * D(rb):
            continue
        # The nearest point of ball 2 is d − r2 away from centre 1, in units of r1.
        m = ((d - D(rb)) / D(ra)) ** 2 - 1 if d > D(rb) else D(-1)
        e1, e2 = ({"center": c, "semi_axes": [r] * n} for c, r in ((a, ra), (b, rb)))
        query = {"query": "margin", "e1": e1, "e2": e2}
        emit("margin-balls", query, {"margin": m}, m, 1, tags, precision)
    for aspect in (1, 1e3, 1e6):
        # Both ellipsoids on the first axis, with all axes along it: the contact is on the axis where its curvature is
        # the flattest, that is, where no other axis of E2 reaches round.
        r1, r2 = size() * scale, size() * scale
        gap = size() * scale
        e1 = {"center": [0.0] * n, "semi_axes": [r1] + [r1 * aspect] * (n - 1)}
        e2 = {"center": [r1 + gap + r2] + [0.0] * (n - 1), "semi_axes": [r2] * n}
        centre = D(r1 + gap + r2)
        near = centre - D(r2)
        if D(r2) * D(aspect) ** 2 < D(r1 * aspect) ** 2 / near:
            continue
        m = (near / D(r1)) ** 2 - 1
        emit("margin-on-axis", {"query": "margin", "e1": e1, "e2": e2}, {"margin": m}, m, 1, tags, precision)


def ellipsoids(n, scale, tags):
    aspect = [scale * 2.0 ** rng.randint(-8, 8) for _ in range(n)]
    offset = [scale * rng.randint(-8, 8) / 8 for _ in range(n)]
    logs = sum(D(a).ln() for a in aspect)
    at = lambda v: [o + a * x for o, a, x in zip(offset, aspect, v)]
    unit = lambda k, s: [s if i == k else 0.0 for i in range(n)]
    # The cross polytope: the unit ball, stretched. ln det X = −2·Σ ln aᵢ.
    cross = [at(unit(k, s)) for k in range(n) for s in (1.0, -1.0)]
    emit("enclosing-cross", {"query": "enclosing_ellipsoid", "points": cross}, {"log_det": -2 * logs}, None, 0, tags)
    lines[-1] = allow(lines[-1], 1e-8)
    # The cube: the ball of radius √n.
    corners = [at([1.0 if i >> k & 1 else -1.0 for k in range(n)]) for i in range(2**n)]
    due = -2 * logs - n * D(n).ln()
    emit("enclosing-cube", {"query": "enclosing_ellipsoid", "points": corners}, {"log_det": due}, None, 0, tags)
    lines[-1] = allow(lines[-1], 1e-8)
    # Inside the box: the unit ball, stretched.
    sides = []
    for k in range(n):
        for s in (1.0, -1.0):
            sides.append({"normal": unit(k, s), "offset": s * offset[k] + aspect[k]})
    emit("inscribed-box", {"query": "inscribed_ellipsoid", "halfspaces": sides}, {"log_det": -2 * logs}, None, 0, tags)
    lines[-1] = allow(lines[-1], 1e-8)
    if n <= 3:
        emit("inscribed-cube", {"query": "inscribed_ellipsoid", "points": corners}, {"log_det": -2 * logs}, None, 0, tags)
        lines[-1] = allow(lines[-1], 1e-8)


def allow(line, value):
    case = json.loads(line)
    case["allow"] = value
    return json.dumps(case, separators=(",", ":"))


for n in (2, 3):
    for exponent in (0, -30, 30):
        tags = ["%dd" % n, "scale2^%d" % exponent]
        for precision in ("f64", "f32"):
            casts(n, 2.0**exponent, precision, tags + [precision])
            distances(n, 2.0**exponent, precision, tags + [precision])
            margins(n, 2.0**exponent, precision, tags + [precision])
for n in range(2, 7):
    for exponent in (0, -30, 30):
        ellipsoids(n, 2.0**exponent, ["n%d" % n, "scale2^%d" % exponent])

print("# Written by closed_form.py.")
print("\n".join(lines))
