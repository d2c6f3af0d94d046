#!/usr/bin/env python3
"""Other solvers on the QPs that `./run.sh bench solver --dump qps.json` writes; prints the same table.

    python3 -m venv venv && venv/bin/pip install numpy scipy daqp osqp piqp quadprog
    venv/bin/python results/latency/peers.py qps.json --out peers.csv

Solvers that are not installed are left out. Each problem is solved five times and its shortest time
counts; the distribution is over problems. Set-up counts: the robots' QP is another one at every tick.
"""

import argparse
import csv
import json
import time

import numpy as np

REPEATS = 5


def condensed(problem):
    """min 1/2 z'Hz + f'z, A z <= b, |u| <= bound; z = (u, slack), u interleaved x and y per step."""
    n, h = problem["horizon"], problem["sample_time"]
    rows = problem["rows"]
    soft = [i for i, row in enumerate(rows) if not row["hard"]]
    size = 2 * n + len(soft)
    q, w = problem["state_weight"], problem["input_weight"]
    forced = h * np.kron(np.tril(np.ones((n, n))), np.eye(2))
    free = np.tile(problem["position"], n)
    wanted = np.ravel(problem["state_target"])
    inputs = np.ravel(problem["input_target"])
    hessian = np.zeros((size, size))
    hessian[: 2 * n, : 2 * n] = 2 * (q * forced.T @ forced + w * np.eye(2 * n))
    gradient = np.zeros(size)
    gradient[: 2 * n] = 2 * (q * forced.T @ (free - wanted) - w * inputs)
    for k in range(len(soft)):
        hessian[2 * n + k, 2 * n + k] = problem["slack_quadratic"]
        gradient[2 * n + k] = problem["slack_linear"]
    a, b = np.zeros((len(rows), size)), np.zeros(len(rows))
    for i, row in enumerate(rows):
        step = row["step"] - 1
        normal = np.array(row["normal"])
        a[i, : 2 * n] = -normal @ forced[2 * step : 2 * step + 2]
        b[i] = normal @ free[2 * step : 2 * step + 2] - row["offset"]
        if i in soft:
            a[i, 2 * n + soft.index(i)] = -1.0
    bound = problem["max_speed"]
    low = np.concatenate([np.full(2 * n, -bound), np.zeros(len(soft))])
    high = np.concatenate([np.full(2 * n, bound), np.full(len(soft), 1e6)])
    return hessian, gradient, a, b, low, high, n


def with_daqp():
    import daqp
    from ctypes import c_int

    def solve(hessian, gradient, a, b, low, high, n):
        upper, lower = np.concatenate([high, b]), np.concatenate([low, np.full(len(b), -1e30)])
        sense = np.zeros(len(upper), dtype=c_int)
        start = time.perf_counter_ns()
        x, _, flag, _ = daqp.solve(hessian, gradient, a, upper, lower, sense)
        return time.perf_counter_ns() - start, x if flag > 0 else None

    return solve


def with_osqp():
    import osqp
    from scipy import sparse

    def solve(hessian, gradient, a, b, low, high, n):
        p = sparse.csc_matrix(np.triu(hessian))
        all_rows = sparse.csc_matrix(np.vstack([np.eye(len(gradient)), a]))
        lower, upper = np.concatenate([low, np.full(len(b), -np.inf)]), np.concatenate([high, b])
        start = time.perf_counter_ns()
        solver = osqp.OSQP()
        solver.setup(p, gradient, all_rows, lower, upper, verbose=False, eps_abs=1e-6, eps_rel=1e-6, max_iter=100000)
        result = solver.solve()
        elapsed = time.perf_counter_ns() - start
        return elapsed, result.x if result.info.status == "solved" else None

    return solve


def with_piqp():
    import piqp

    def solve(hessian, gradient, a, b, low, high, n):
        start = time.perf_counter_ns()
        solver = piqp.DenseSolver()
        solver.settings.verbose = False
        none = np.zeros((0, len(gradient)))
        lower = np.full(len(b), -1e30)
        solver.setup(hessian, gradient, none, np.zeros(0), a, lower, b, low, high)
        status = solver.solve()
        elapsed = time.perf_counter_ns() - start
        return elapsed, np.array(solver.result.x) if status == piqp.PIQP_SOLVED else None

    return solve


def with_quadprog():
    import quadprog

    def solve(hessian, gradient, a, b, low, high, n):
        size = len(gradient)
        rows = np.vstack([np.eye(size), -np.eye(size), -a])
        offsets = np.concatenate([low, -high, -b])
        start = time.perf_counter_ns()
        try:
            x = quadprog.solve_qp(hessian, -gradient, rows.T, offsets)[0]
        except ValueError:  # infeasible
            x = None
        return time.perf_counter_ns() - start, x

    return solve


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("qps", help="file that bench solver --dump wrote")
    parser.add_argument("--out", help="CSV to write")
    parser.add_argument("--most", type=int, default=100, help="problems per case (default 100)")
    args = parser.parse_args()
    with open(args.qps, encoding="utf-8") as file:
        problems = json.load(file)
    solvers = {}
    for name, make in [("DAQP", with_daqp), ("OSQP", with_osqp), ("PIQP", with_piqp), ("quadprog", with_quadprog)]:
        try:
            solvers[name] = make()
        except ImportError:
            print(f"{name} is not installed and left out")
    cases = {}
    for problem in problems:
        cases.setdefault((problem["family"], problem["rows_wanted"], problem["horizon"]), []).append(problem)
    table = [["what", "n", "count", "p50_us", "p90_us", "p99_us", "max_us", "largest_du", "verdicts_differ"]]
    for (family, rows, horizon), group in sorted(cases.items()):
        group = group[: args.most]
        forms = [condensed(problem) for problem in group]
        for name, solve in solvers.items():
            times, largest, differ = [], 0.0, 0
            for problem, form in zip(group, forms):
                runs = [solve(*form) for _ in range(REPEATS)]
                times.append(min(elapsed for elapsed, _ in runs) / 1e3)
                x, ours = runs[-1][1], problem["inputs"]
                if x is None or ours is None:
                    differ += (x is None) != (ours is None)
                else:
                    largest = max(largest, np.max(np.abs(x[: 2 * horizon] - np.ravel(ours))))
            figures = [f"{np.percentile(times, p):.1f}" for p in (50, 90, 99, 100)]
            case = f"{family}, {rows} rows: {name}"
            table.append([case, horizon, len(times), *figures, f"{largest:.1e}", differ])
    widths = [max(len(str(row[i])) for row in table) for i in range(len(table[0]))]
    for row in table:
        print("  ".join(str(cell).ljust(w) if i == 0 else str(cell).rjust(w) for i, (cell, w) in enumerate(zip(row, widths))))
    if args.out:
        with open(args.out, "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(table)


if __name__ == "__main__":
    main()
