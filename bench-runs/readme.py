#!/usr/bin/env python3
"""Writes the tables of the README between its `<!-- table: NAME -->` marks from the data of a bench run.

    python3 bench-runs/readme.py bench-runs/2026-11-22

Python's standard library is all it needs.
"""

import csv
import json
import math
import pathlib
import statistics
import sys
import tomllib

DATA = pathlib.Path(sys.argv[1])
HERE = pathlib.Path(__file__).resolve().parent
README = HERE.parent / "README.md"


def part(name):
    return json.loads((DATA / name / "summary.json").read_text())


def figures(row):
    """success, ratio, seconds, least separation."""
    def median(key, digits):
        return f"{row[key]['median']:.{digits}f}" if row[key] else "-"
    return [f"{row['successes']}/{row['runs']}", median("ratio", 3), median("time_s", 1), f"{row['min_separation']:.3f}"]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def suite():
    quality = part("quality")
    safe, *others = [row["controller"] for row in quality["totals"]]
    shown = [safe] + [name for name in others if name in ("orca", "orca-rh", "paper:fixed:20")]
    families = list(dict.fromkeys(row["family"] for row in quality["rows"])) + ["all"]
    cell = {(row["family"], row["controller"]): figures(row) for row in quality["rows"] + quality["totals"]}
    head = ["layouts"] + [f"{name.split(':')[0]}: runs, ratio, s, m" for name in shown]
    rows = [[family] + [", ".join(cell[family, name]) for name in shown] for family in families]
    return table(head, rows)


def totals(name):
    return table(
        ["controller", "arrived", "path / straight", "time s", "least separation m"],
        [[f"`{row['controller']}`", *figures(row)] for row in part(name)["totals"]],
    )


def least_time(layout):
    """Seconds until the last robot of a layout is within 0.1 m of its set-point if all walk straight at full speed."""
    stride = 0.2 * 1.5  # m per tick and axis
    robots = tomllib.loads((HERE.parent / "scenarios" / f"{layout}.toml").read_text())["robot"]
    ways = [[to - at for at, to in zip(robot["start"], robot["set_point"])] for robot in robots]
    ticks = [max(map(abs, way)) * (1 - 0.1 / math.hypot(*way)) / stride for way in ways]
    return 0.2 * max(math.floor(count) + 1 for count in ticks)


def targets():
    """Medians over the same horizons as the targets: the large rings were measured at 20 and random ones only."""
    runs, layouts = {}, {}
    with open(DATA / "quality" / "runs.csv") as file:
        for run in csv.DictReader(file):
            few = run["family"] in ("antipodal64", "antipodal100")
            if run["controller"].startswith("safe") and (not few or run["horizon"] in ("fixed:20", "random")):
                runs.setdefault(run["family"], []).append(run)
                layouts.setdefault(run["family"], {})[run["scenario"]] = None
    rows = []
    with open(HERE / "targets.csv") as file:
        for want in csv.DictReader(file):
            cells = [want["family"]]
            for key, column, digits in (("ratio", "ratio", 3), ("s", "time_s", 1)):
                arrived = [float(run[column]) for run in runs[want["family"]] if run["success"] == "true"]
                median = round(statistics.median(arrived), digits)
                names = [f"reference_{key}", f"orca_rh_{key}"]
                mark = "" if median <= min(float(want[name]) for name in names if want[name]) else " (above)"
                cells += [*(want[name] or "-" for name in names), f"{median:.{digits}f}{mark}"]
            cells.append(f"{statistics.median(map(least_time, layouts[want['family']])):.1f}")
            rows.append(cells)
    head = ["layouts", "ratio: reference", "ORCA-RH", "safe", "time s: reference", "ORCA-RH", "safe", "nobody is faster than"]
    return table(head, rows)


def boxes():
    return table(
        ["controller", "arrived", "path / straight", "time s", "least separation m", "runs with a pair nearer than 1.5 m"],
        [[f"`{row['controller']}`", *figures(row), str(row["runs_below"])] for row in part("random")["totals"]],
    )


text = README.read_text()
tables = {"suite": suite, "targets": targets, "random": boxes}
tables |= {name: lambda name=name: totals(name) for name in ("robustness", "ablations", "patience")}
for name, make in tables.items():
    start, end = f"<!-- table: {name} -->", f"<!-- /table: {name} -->"
    before, rest = text.split(start)
    text = before + start + "\n" + make() + "\n" + end + rest.split(end)[1]
README.write_text(text)
