#!/usr/bin/env python3
"""Writes the tables of the README's section "Speed" from the folder of a `./run.sh bench all`.

    python3 bench-runs/speed.py bench-runs/2026-11-22-MACHINE

`peers.csv` in the folder (see peers.py) adds the other solvers. Python's standard library is all it needs.
"""

import csv
import pathlib
import sys

DATA = pathlib.Path(sys.argv[1])
README = pathlib.Path(__file__).resolve().parent.parent / "README.md"


def read(name):
    path = DATA / name
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def number(value):
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


ROWS = {(row["part"], row["what"], row["n"]): row for row in read("rows.csv")}
FIGURES = {row["what"]: number(float(row["value"])) + " " + row["unit"] for row in read("figures.csv")}
PEERS = {(row["what"], row["n"]): row for row in read("peers.csv")}


def cell(part, what, n, key="p50_us"):
    row = ROWS.get((part, what, str(n)))
    return row[key] if row else "-"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def solver():
    others = list(dict.fromkeys(what.split(": ")[1] for what, _ in PEERS))
    rows = []
    for family in ("safe", "paper"):
        for n in (20, 49):
            for count in (0, 3, 10):
                case = f"{family}, {count} rows"
                ours, theirs = (cell("solver", f"{case}: {name}", n) for name in ("ladder", "Clarabel"))
                ratio = cell("solver", f"{case}: Clarabel", n, "ratio")
                peers = [PEERS.get((f"{case}: {name}", str(n)), {}).get("p50_us", "-") for name in others]
                rows.append([case, str(n), ours, f"{theirs} ({float(ratio):.0f}x)", *peers])
    return table(["QP", "N", "ours", "Clarabel, tuned", *others], rows)


def steps():
    cases = [("safe, fixed:20", 20), ("safe, fixed:49", 49), ("paper, fixed:20", 20), ("paper, fixed:49", 49)]
    cases += [("orca, fixed:20", ""), ("orca-rh, fixed:20", "")]
    rows = []
    for name, n in cases:
        found = [cell("step", f"{name}: step", n, key) for key in ("p50_us", "p99_us")]
        found += [cell("step", f"{name}: {part}", n) for part in ("detect", "solve")]
        rows.append([f"`{name.replace(', ', ':')}`" if n else f"`{name.split(',')[0]}`", *found])
    return table(["fourteen robots, one step", "p50", "p99", "detect p50", "solve p50"], rows)


def exchange():
    rows = []
    for n in (2, 14, 32, 50, 100, 200):
        full = [cell("exchange", f"{kind}, no QP, full speed", n, key) for kind in ("peer", "relay") for key in ("p50_us", "ratio")]
        used = "peer" if n <= 20 else "relay"
        safe = [cell("exchange", f"{used}, safe, full speed", n, key) for key in ("p50_us", "p99_us")]
        floor = cell("exchange", "futex floor, full speed", n)
        real = cell("exchange", f"{used}, safe, real time", n, "p99_us")
        rows.append([str(n), floor, f"{full[0]} ({full[1]}x)", f"{full[2]} ({full[3]}x)", *safe, real])
    head = ["robots", "futex floor", "peer, no QP", "relay, no QP", "safe p50", "safe p99", "real time, safe p99"]
    return table(head, [[text.replace("- (-x)", "-") for text in row] for row in rows])


def hop():
    rows = []
    for row in read("rows.csv"):
        if row["part"] == "hop":
            rows.append([row["what"], *(row[key] for key in ("p50_us", "p90_us", "p99_us", "p999_us", "ratio"))])
    return table(["one way, two processes", "p50", "p90", "p99", "p99.9", "over the floor"], rows)


def figures():
    wanted = [name for name in FIGURES if name.startswith(("start of", "14 ", "mean QP", "share of", "largest diff"))]
    wanted = [name for name in wanted if not name.startswith("start of the back-end")]
    rows = [[name.replace("|", ""), FIGURES[name].strip()] for name in wanted]
    for n in (100, 200):
        rows.append([f"tick of {n} robots in real time, p99", f"{float(cell('scale', 'tick, safe, real time', n, 'p99_us')) / 1e3:.1f} ms"])
    for n in (2, 14, 64):
        for what in ("inference", "observation to horizons"):
            found = [cell("policy", f"{what}, embedded", n, key) for key in ("p50_us", "p99_us")]
            rows.append([f"policy, {n} robots: {what}", f"p50 {found[0]} us, p99 {found[1]} us"])
    return table(["figure", "value"], rows)


text = README.read_text(encoding="utf-8")
for name, make in (("solver", solver), ("steps", steps), ("exchange", exchange), ("hop", hop), ("figures", figures)):
    start, end = f"<!-- table: speed {name} -->", f"<!-- /table: speed {name} -->"
    before, rest = text.split(start)
    text = before + start + "\n" + make() + "\n" + end + rest.split(end)[1]
README.write_text(text, encoding="utf-8")
