#!/usr/bin/env python3
"""Writes the tables of the README between its `<!-- table: NAME -->` marks from the data of a bench run.

    python3 bench-runs/readme.py bench-runs/2026-11-22

Python's standard library is all it needs.
"""

import json
import pathlib
import sys

DATA = pathlib.Path(sys.argv[1])
README = pathlib.Path(__file__).resolve().parent.parent / "README.md"


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


def disturbances():
    return table(
        ["controller", "arrived", "path / straight", "time s", "least separation m"],
        [[f"`{row['controller']}`", *figures(row)] for row in part("robustness")["totals"]],
    )


def ablations():
    return table(
        ["controller", "arrived", "path / straight", "time s", "least separation m"],
        [[f"`{row['controller']}`", *figures(row)] for row in part("ablations")["totals"]],
    )


text = README.read_text()
for name, make in (("suite", suite), ("robustness", disturbances), ("ablations", ablations)):
    start, end = f"<!-- table: {name} -->", f"<!-- /table: {name} -->"
    before, rest = text.split(start)
    text = before + start + "\n" + make() + "\n" + end + rest.split(end)[1]
README.write_text(text)
