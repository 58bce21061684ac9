#!/usr/bin/env python3
"""Ellipsoids around points, and margins of ellipsoids: the suite's file of them, and what others answer.

    benches/peers/ellipsoids.py --suite      # writes xtask/data/suite/ellipsoids.jsonl; needs numpy and mpmath
    benches/peers/ellipsoids.py --record     # asks ours and the others, and writes docs/ellipsoids.csv and the table

Twenty clouds of a hundred points in space, normally distributed, and a hundred pairs of ellipsoids with semi-axes of 0.1 to
1. Truths are in fifty digits: of a cloud by Newton's method on its contact points, held against all points; of a margin by its
secular equation.

Others, as they come: `ellipsoidhull` of R's package cluster (tolerance 0.01); the semidefinite programme in cvxpy, solved by
Clarabel and timed by it; and for margins the 2N×2N eigenvalue problem of Rimon and Boyd, by faer, through the feature `paper`. An ellipsoid is scaled until it
just holds the points, and the error is that of ln det.
"""

import argparse
import csv
import json
import os
import subprocess
import tempfile
import time

import numpy as np

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SUITE = os.path.join(ROOT, "xtask", "data", "suite", "ellipsoids.jsonl")
CSV = os.path.join(ROOT, "docs", "ellipsoids.csv")
NOTE = os.path.join(ROOT, "docs", "comparison.md")


def enclosing_truth(points):
    """ln det of the matrix of the least ellipsoid, in fifty digits."""
    from mpmath import mp, matrix, lu_solve, det, log, inverse

    mp.dps = 50
    n = points.shape[1]
    # The contact points, by the multiplicative method in doubles.
    q = np.hstack([points, np.ones((len(points), 1))])
    u = np.full(len(q), 1.0 / len(q))
    for _ in range(200_000):
        omega = np.einsum("ij,jk,ik->i", q, np.linalg.inv(q.T * u @ q), q)
        u *= omega / (n + 1)
        if omega.max() < (n + 1) * (1 + 1e-9):
            break
    keep = [k for k in range(len(q)) if u[k] > 1e-6]
    while True:
        exact = matrix([[mp.mpf(float(c)) for c in q[k]] for k in keep])
        weights = matrix([mp.mpf(float(u[k])) for k in keep])
        for _ in range(60):
            moment = matrix(n + 1, n + 1)
            for k in range(len(keep)):
                row = exact[k, :]
                moment += weights[k] * (row.T * row)
            gram = exact * inverse(moment) * exact.T
            residual = matrix([gram[k, k] - (n + 1) for k in range(len(keep))])
            step = lu_solve(matrix([[gram[i, j] ** 2 for j in range(len(keep))] for i in range(len(keep))]), residual)
            weights += step
            if max(abs(s) for s in step) < mp.mpf(10) ** -45:
                break
        if min(weights) > 0:
            break
        keep.pop(min(range(len(keep)), key=lambda k: weights[k]))
    inverse_moment = inverse(moment)
    for row in q:
        x = matrix([mp.mpf(float(c)) for c in row])
        assert (x.T * inverse_moment * x)[0] < (n + 1) * (1 + mp.mpf(10) ** -40), "a point is outside: other contacts"
    # ln det X = -ln det S - N ln N, and det M = det S.
    return float(-log(det(moment)) - n * log(n))


def margin_truth(e1, e2):
    """The margin, in fifty digits: BᵀBy + νy = Bᵀg, |y| = 1."""
    from mpmath import mp, matrix, lu_solve, eye, cholesky, inverse, findroot, norm

    mp.dps = 50
    exact = lambda rows: matrix([[mp.mpf(c) for c in row] for row in rows])
    P, Q = exact(e1["matrix"]), exact(e2["matrix"])
    r = matrix([mp.mpf(a) - mp.mpf(b) for a, b in zip(e1["center"], e2["center"])])
    back = inverse(cholesky(Q).T)
    c, C = cholesky(Q).T * r, back.T * P * back
    if norm(c) <= 1:
        return -1.0
    y = lambda nu: lu_solve(C + nu * eye(3), C * c)
    low, high = mp.mpf(0), mp.mpf(1)
    while norm(y(high)) > 1:
        high *= 2
    for _ in range(180):
        middle = (low + high) / 2
        low, high = (middle, high) if norm(y(middle)) > 1 else (low, middle)
    w = y((low + high) / 2) - c
    return float((w.T * C * w)[0] - 1)


def rotation(rng):
    q, r = np.linalg.qr(rng.standard_normal((3, 3)))
    return q * np.sign(np.diag(r))


def suite():
    rng = np.random.default_rng(18)
    with open(SUITE, "w") as file:
        file.write("# Written by benches/peers/ellipsoids.py: what other programs are asked too.\n")
        for k in range(20):
            points = np.round(rng.standard_normal((100, 3)), 4)
            query = {"id": f"cloud-{k}", "query": "enclosing_ellipsoid", "points": points.tolist(),
                     "expect": {"log_det": enclosing_truth(points)}, "allow": 1e-9}
            file.write(json.dumps(query) + "\n")
        for k in range(100):
            matrix = lambda: (lambda m: np.round((m + m.T) / 2, 9).tolist())(
                (lambda R: R @ np.diag([1.0, 1 / rng.uniform(0.1, 1) ** 2, 100.0]) @ R.T)(rotation(rng)))
            towards = rng.standard_normal(3)
            e1, e2 = {"center": [0.0, 0.0, 0.0], "matrix": matrix()}, {
                "center": np.round(3 * towards / np.linalg.norm(towards), 6).tolist(), "matrix": matrix()}
            query = {"id": f"pair-{k}", "query": "margin", "e1": e1, "e2": e2, "expect": {"margin": margin_truth(e1, e2)}}
            file.write(json.dumps(query) + "\n")


def cases(query):
    lines = [json.loads(line) for line in open(SUITE) if not line.startswith("#")]
    return [case for case in lines if case["query"] == query]


def gap(points, X, c, truth):
    """The error of ln det, of the ellipsoid scaled until it just holds all points."""
    d = points - c
    most = np.einsum("ij,jk,ik->i", d, X, d).max()
    return abs(np.linalg.slogdet(X / most)[1] - truth)


def by_r(clouds):
    with tempfile.TemporaryDirectory() as folder:
        for k, points in enumerate(clouds):
            np.savetxt(os.path.join(folder, f"{k}.csv"), points, delimiter=",", fmt="%.17g")
        script = f"""library(cluster); for (k in 0:{len(clouds) - 1}) {{
            x <- as.matrix(read.csv(sprintf("{folder}/%d.csv", k), header = FALSE))
            e <- ellipsoidhull(x, maxit = 100000)
            t <- min(sapply(1:7, function(i) system.time(for (j in 1:50) ellipsoidhull(x, maxit = 100000))["elapsed"] / 50))
            cat(t, solve(e$cov * e$d2), e$loc, "\\n", sep = " ") }}"""
        said = subprocess.run(["Rscript", "-e", f"options(digits=17); {script}"], text=True, capture_output=True, check=True)
        for line in said.stdout.splitlines():
            seconds, *rest = map(float, line.split())
            yield seconds * 1e9, np.array(rest[:9]).reshape(3, 3), np.array(rest[9:12])


def by_clarabel(clouds):
    import cvxpy

    for points in clouds:
        A, b = cvxpy.Variable((3, 3), PSD=True), cvxpy.Variable(3)
        problem = cvxpy.Problem(cvxpy.Maximize(cvxpy.log_det(A)), [cvxpy.norm(A @ p + b, 2) <= 1 for p in points])
        problem.solve(solver=cvxpy.CLARABEL)
        X = A.value.T @ A.value
        yield problem.solver_stats.solve_time * 1e9, X, -np.linalg.solve(A.value, b.value)


def asked(lines):
    """What `cargo xtask validate` finds of some queries: rows of its cases.csv."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "asked.jsonl")
        open(file, "w").write("".join(json.dumps(line) + "\n" for line in lines))
        xtask = ["cargo", "run", "--release", "--package", "xtask", "--features", "paper", "--target-dir", "target/paper"]
        command = [*xtask, "--", "validate", "--quick", "--report", folder, file]
        # An answer by eigenvalues may be wrong, which the exit status says; the file is written all the same.
        subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL)
        return list(csv.DictReader(open(os.path.join(folder, "cases.csv"))))


def note(rows):
    """Writes the table into docs/comparison.md."""
    said = lambda ns: f"{ns:.0f} ns" if ns < 1e3 else f"{ns / 1e3:.0f} µs" if ns < 1e6 else f"{ns / 1e6:.0f} ms"
    small = lambda error: f"{error:.0e}".replace("e-0", "e-")
    lines = ["| question | program | asked | error of 99 in 100 below | worst error | median time |", "|---|---|---:|---:|---:|---:|"]
    lines += [f"| {r[0]} | {r[1]} | {r[2]} | {small(r[9])} | {small(r[10])} | {said(r[11])} |" for r in rows]
    processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "")
    lines += ["", f"Measured on {processor}, {time.strftime('%Y-%m-%d', time.gmtime())}, on a busy machine."]
    page = open(NOTE, encoding="utf-8").read()
    begin, end = "<!-- ellipsoids, written by `ellipsoids.py` -->", "<!-- end of ellipsoids -->"
    head, rest = page.split(begin)
    text = "\n".join(lines)
    open(NOTE, "w", encoding="utf-8").write(f"{head}{begin}\n\n{text}\n\n{end}{rest.split(end)[1]}")


def record():
    rows = []

    def add(question, who, times, errors, allowed):
        at = lambda values, p: sorted(values)[max(0, -(-int(p * len(values) * 100) // 100) - 1)]
        off = sum(error > allowed for error in errors)
        rows.append([question, who, len(times), len(times) - off, off, 0, 0, 0, at(errors, 0.5), at(errors, 0.99), max(errors), round(at(times, 0.5), 1)])

    clouds, pairs = cases("enclosing_ellipsoid"), cases("margin")
    times = lambda rows: [float(row["ns"]) for row in rows]
    ours = asked(clouds)
    add("ellipsoid around points", "ours f64", times(ours), [float(row["error"]) for row in ours], 1e-2)
    points, truths = [np.array(case["points"]) for case in clouds], [case["expect"]["log_det"] for case in clouds]
    for who, solve in (("R cluster", by_r), ("Clarabel", by_clarabel)):
        answers = list(solve(points))
        add("ellipsoid around points", who, [ns for ns, _, _ in answers],
            [gap(p, X, c, truth) for p, (_, X, c), truth in zip(points, answers, truths)], 1e-2)
    by_eigenvalues = asked([{**pair, "method": "eigen"} for pair in pairs])
    for who, rows_of in (("ours f64", asked(pairs)), ("faer eigenvalues", by_eigenvalues)):
        errors = [float(row["error"]) / (1 + pair["expect"]["margin"]) for row, pair in zip(rows_of, pairs)]
        add("margin of ellipsoids", who, times(rows_of), errors, 1e-7)
    note(rows)
    with open(CSV, "w") as file:
        file.write("question,who,asked,right,inaccurate,disproved,no answer,undecided,median error,99th percentile,worst,median time\n")
        for row in rows:
            file.write(",".join(str(cell) for cell in row) + "\n")


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--suite", action="store_true")
parser.add_argument("--record", action="store_true")
given = parser.parse_args()
if given.suite:
    suite()
if given.record:
    record()
