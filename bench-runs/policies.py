#!/usr/bin/env python3
"""Writes the README's table of policies between its `<!-- table: policies -->` marks.

    python3 bench-runs/policies.py bench-runs/2026-11-22-policies

Reads what `bench-runs/policies.sh` left there. Python's standard library is all it needs.
"""

import csv
import pathlib
import statistics
import sys

DATA = pathlib.Path(sys.argv[1])
README = pathlib.Path(__file__).resolve().parent.parent / "README.md"
NAMES = ["two_setpoint", "four_gate", "exchange_14", "ring_8"]
GRID = [f"fixed:{steps}" for steps in (5, 10, 15, 20, 25, 30, 35, 40, 45, 49)]


def cell(runs):
    """Median path of the runs that succeeded, median ticks, and how many succeeded."""
    good = [run for run in runs if run["success"] == "true"]
    if not good:
        return f"- ({len(good)}/{len(runs)})"
    path = statistics.median(float(run["path_m"]) for run in good)
    ticks = statistics.median(int(run["ticks"]) for run in good)
    return f"{path:.1f} m, {ticks:.0f} ({len(good)}/{len(runs)})"


def best(by_name, names):
    """The name with the most successes, then the shortest median path."""
    def rank(name):
        good = [float(run["path_m"]) for run in by_name[name] if run["success"] == "true"]
        return (-len(good), statistics.median(good) if good else float("inf"))
    return min((name for name in names if name in by_name), key=rank)


def rows(name):
    with open(DATA / f"{name}.csv") as file:
        runs = list(csv.DictReader(file))
    for jitter in sorted({run["jitter_start_m"] for run in runs}, key=float):
        by_name = {}
        for run in runs:
            if run["jitter_start_m"] == jitter:
                by_name.setdefault(run["horizons"], []).append(run)
        everything = [f"fixed:{steps}" for steps in range(1, 50)]
        start = "as it is" if float(jitter) == 0 else f"moved by {jitter} m"
        grid, fixed = best(by_name, GRID), best(by_name, everything)
        constants = cell(by_name["constants"]) if "constants" in by_name else "-"
        yield [f"`{name}`", start, cell(by_name["policy"]), cell(by_name["fixed:20"]),
               f"{cell(by_name[grid])}, N={grid[6:]}",
               f"{cell(by_name[fixed])}, N={fixed[6:]}", cell(by_name["random"]), constants]


head = ["policy", "start", "policy", "fixed 20", "best fixed of the grid", "best fixed of 49", "random", "constants, searched"]
lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
for name in NAMES:
    if (DATA / f"{name}.csv").exists():
        lines += ["| " + " | ".join(row) + " |" for row in rows(name)]
text = README.read_text()
start, end = "<!-- table: policies -->", "<!-- /table: policies -->"
before, after = text.split(start)[0], text.split(end)[1]
README.write_text(before + start + "\n" + "\n".join(lines) + "\n" + end + after)
