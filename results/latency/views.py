#!/usr/bin/env python3
"""The arithmetic of views.sh.

    ... | python3 results/latency/views.py row PAIR VIEW      durations of ticks (ns, a header first) as one line of runs.csv
    python3 results/latency/views.py table runs.csv           views against the runs without, as Markdown

Python's standard library is all it needs.
"""

import csv
import random
import statistics
import sys

RESAMPLES = 2000


def row(pair, view):
    ticks = sorted(int(line) / 1e3 for line in sys.stdin.read().split()[1:])
    p99 = ticks[int(0.99 * (len(ticks) - 1))]
    mean = statistics.fmean(ticks)
    print(f"{pair},{view},{len(ticks)},{statistics.median(ticks):.1f},{p99:.1f},{mean:.1f}")


def interval(values):
    """Median with its 95 % percentile bootstrap interval, seeded."""
    generator = random.Random(1)
    medians = sorted(statistics.median(generator.choices(values, k=len(values))) for _ in range(RESAMPLES))
    cut = RESAMPLES // 40
    return f"{statistics.median(values):.3f} ({medians[cut]:.3f}..{medians[-1 - cut]:.3f})"


def table(path):
    pairs = {}
    for line in csv.DictReader(open(path)):
        pairs.setdefault(line["pair"], {})[line["view"]] = line
    print("| view | pairs of runs | without: p50 us | with: p50 us | ratio of medians (95 %) | ratio of means (95 %) |")
    print("|---|---|---|---|---|---|")
    for view in ("live", "tui"):
        own = [pair for pair in pairs.values() if view in pair]
        def column(key, which):
            return [float(pair[which][key]) for pair in own]
        def ratio(key):
            return interval([there / without for there, without in zip(column(key, view), column(key, "none"))])
        p50 = [f"{statistics.median(column('p50_us', which)):.0f}" for which in ("none", view)]
        print(f"| `--{view}` | {len(own)} | {p50[0]} | {p50[1]} | {ratio('p50_us')} | {ratio('mean_us')} |")


if __name__ == "__main__":
    {"row": row, "table": table}[sys.argv[1]](*sys.argv[2:])
