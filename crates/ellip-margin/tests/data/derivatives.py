#!/usr/bin/env python3
"""Makes derivatives.csv: the margin, the distance and the common scale of random pairs, with their gradients and Hessians by the motion
of the first ellipsoid, from differences of 70-digit values. Needs mpmath; takes half a minute.

    python3 derivatives.py >derivatives.csv
    python3 derivatives.py 100 >more.csv      100 pairs of each dimension and condition instead of 4

None of the formulas of the crate is used: the margin is minimised over E2 by the secular equation of its matrices, the distance
comes from its two multipliers, the scale from Perram and Wertheim's function of one number, each solved by Newton's method;
derivatives are central differences with a step of 1e-14, whose error is of the order of its square.

A line: dimension, log10 of the condition, then the bodies (centre, semi-axes, axes column by column), each number as Rust reads it
back to the bit; then for margin, distance, scale: the value, the gradient, the upper triangle of the Hessian row by row.
The axes are the stored ones, made orthonormal to all digits; the difference is their rounding.
"""

import random
import sys

from mpmath import diag, eye, lu_solve, matrix, mp, mpf, norm, nstr, sqrt

mp.dps = 70
H = mpf(10) ** -14


def root(f, x, steps=60):
    """A zero of f near x by Newton's method with a numeric slope."""
    for _ in range(steps):
        h = abs(x) * mpf(10) ** -35
        y = f(x)
        step = y * 2 * h / (f(x + h) - f(x - h))
        x -= step
        if abs(step) < abs(x) * mpf(10) ** -60:
            return x
    raise ArithmeticError("no root")


class Body:
    def __init__(self, center, a, axes):
        self.center, self.a, self.axes = center, a, axes

    def inner(self, power):
        return self.axes * diag([x**power for x in self.a]) * self.axes.T


def margin(e1, e2, hint):
    n = len(e1.a)
    p, half = e1.inner(-2), e2.axes * diag(e2.a)
    c, b = half.T * p * half, half.T * p * (e1.center - e2.center)

    # 1/|y| is concave in nu: from below its root Newton's method rises to it, from above it comes back below.
    nu = hint.get("nu", mpf(0))
    for _ in range(200):
        y = lu_solve(c + nu * eye(n), b)
        length = norm(y)
        step = (length - 1) * length**2 / (y.T * lu_solve(c + nu * eye(n), y))[0]
        nu = max(nu + step, mpf(0))
        if abs(step) < abs(nu) * mpf(10) ** -60:
            break
    else:
        raise ArithmeticError("no margin")
    hint["nu"] = nu
    w = e2.center + half * lu_solve(c + nu * eye(n), b) - e1.center
    return (w.T * p * w)[0] - 1


def scale(e1, e2, hint):
    s1, s2, r = e1.inner(2), e2.inner(2), e2.center - e1.center

    def value(t):
        return t * (1 - t) * (r.T * lu_solve((1 - t) * s1 + t * s2, r))[0]

    def slope(t):  # of value/(t(1 - t)) and of t(1 - t), exactly
        x = lu_solve((1 - t) * s1 + t * s2, r)
        return (1 - 2 * t) * (r.T * x)[0] - t * (1 - t) * (x.T * (s2 - s1) * x)[0]

    if "t" not in hint:
        low, high = mpf(0), mpf(1)
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if slope(middle) > 0 else (low, middle)
        hint["t"] = (low + high) / 2
    t = hint["t"] = root(slope, hint["t"])
    return sqrt(value(t))


def distance(e1, e2, hint):
    n = len(e1.a)
    s1, s2, r = e1.inner(2), e2.inner(2), e2.center - e1.center

    def residual(beta):
        d = lu_solve(eye(n) + s1 / beta[0] + s2 / beta[1], r)
        h = [sqrt((d.T * s * d)[0]) for s in (s1, s2)]
        return d, matrix([mp.log(h[0] / beta[0]), mp.log(h[1] / beta[1])])

    beta = hint.get("beta")
    if beta is None:
        beta = matrix([norm(r), norm(r)])
        for _ in range(400):  # reweighting always descends
            _, rest = residual(beta)
            beta = matrix([beta[k] * mp.exp(rest[k]) for k in range(2)])
    for _ in range(60):
        d, rest = residual(beta)
        if norm(rest) < mpf(10) ** -58:
            hint["beta"] = beta
            return norm(d)
        jacobian = matrix(2, 2)
        for j in range(2):
            by = mpf(10) ** -35
            shifted = matrix([beta[k] * (mp.exp(by) if k == j else 1) for k in range(2)])
            jacobian[:, j] = (residual(shifted)[1] - rest) / by
        step = lu_solve(jacobian, -rest)
        beta = matrix([beta[k] * mp.exp(max(min(step[k], 2), -2)) for k in range(2)])
    raise ArithmeticError("no distance")


def moved(e, theta):
    n = len(e.a)
    w = matrix(n, n)
    if n == 2:
        w[0, 1], w[1, 0] = -theta[2], theta[2]
    else:
        x, y, z = theta[3:]
        w = matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = eye(n) + w + w * w / 2 + w * w * w / 6 + w * w * w * w / 24  # |theta| ~ 1e-14
    return Body(e.center + matrix(theta[:n]), e.a, turn * e.axes)


def derivatives(f, e1, e2):
    count = 3 if len(e1.a) == 2 else 6
    hint = {}
    middle = f(e1, e2, hint)

    def at(*terms):
        theta = [mpf(0)] * count
        for i, sign in terms:
            theta[i] += sign * H
        return f(moved(e1, theta), e2, dict(hint))

    plus = [at((i, 1)) for i in range(count)]
    minus = [at((i, -1)) for i in range(count)]
    gradient = [(plus[i] - minus[i]) / (2 * H) for i in range(count)]
    hessian = []
    for i in range(count):
        hessian.append((plus[i] - 2 * middle + minus[i]) / H**2)
        for j in range(i + 1, count):
            both = at((i, 1), (j, 1)) + at((i, -1), (j, -1))
            # f(++) + f(−−) − f(+0) − f(−0) − f(0+) − f(0−) + 2f = 2h²·∂²f + O(h⁴)
            hessian.append((both - plus[i] - minus[i] - plus[j] - minus[j] + 2 * middle) / (2 * H**2))
    return [middle, *gradient, *hessian]


def orthonormal(axes):
    for _ in range(8):
        axes = (axes + (axes**-1).T) / 2
    return axes


def rotation(rng, n):
    if n == 2:
        angle = rng.uniform(-3, 3)
        return matrix([[mp.cos(angle), -mp.sin(angle)], [mp.sin(angle), mp.cos(angle)]])
    x, y, z, w = (rng.gauss(0, 1) for _ in range(4))
    s = (x * x + y * y + z * z + w * w) ** 0.5
    x, y, z, w = x / s, y / s, z / s, w / s
    return matrix([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])


def body(rng, n, condition, reach):
    shortest = 10 ** (-condition / 2)
    a = [1.0, shortest] + [shortest ** rng.random() for _ in range(n - 2)]
    rng.shuffle(a)
    center = [rng.uniform(-reach, reach) for _ in range(n)]
    axes = [[float(x) for x in row] for row in rotation(rng, n).T.tolist()]
    exact = Body(matrix(center), [mpf(x) for x in a], orthonormal(matrix(axes).T))
    return exact, [*center, *a, *(x for column in axes for x in column)]


def main():
    each = int(sys.argv[1]) if len(sys.argv) > 1 else 4
    rng = random.Random(19)
    print("# made by derivatives.py")
    for n in (2, 3):
        for condition in (0, 1, 2, 4, 6, 8):
            made = 0
            while made < each:
                # The first half is disjoint; the others overlap, the centre of one in the other or not, as it comes.
                apart = made < each // 2
                reach = 2.5 if apart else 0.4
                (e1, first), (e2, second) = body(rng, n, condition, reach), body(rng, n, condition, reach)
                alpha = scale(e1, e2, {})
                if (alpha > mpf("1.05")) != apart or mpf("0.95") < alpha < mpf("1.05"):
                    continue
                outside = (matrix(e1.center - e2.center).T * e2.inner(-2) * (e1.center - e2.center))[0]
                if mpf("0.9") < outside < mpf("1.1"):
                    continue
                count = 10 if n == 2 else 28
                zero = [mpf(0)] * count
                answers = [
                    derivatives(margin, e1, e2) if outside > 1 else [mpf(-1), *zero[1:]],
                    derivatives(distance, e1, e2) if alpha > 1 else zero,
                    derivatives(scale, e1, e2),
                ]
                fields = [str(n), str(condition), *(repr(x) for x in (*first, *second))]
                print(",".join(fields + [nstr(x, 20) for answer in answers for x in answer]), flush=True)
                made += 1
                print(n, condition, made, file=sys.stderr)


main()
