#!/bin/sh
# Updates per second of the learner and of PyTorch, by turns, so that both see the same machine:
#   learner/bench/compare.sh [CSV] [ROUNDS] [PYTHON]
# PyTorch: python3 -m venv DIR && DIR/bin/pip install torch numpy, then PYTHON is DIR/bin/python.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
csv=${1:-$root/results/training/updates.csv}
rounds=${2:-5}
python=${3:-python3}
learner=${CARGO_TARGET_DIR:-$root/target}/release/learner
[ -x "$learner" ] || "$root/run.sh" learner --version
mkdir -p "$(dirname "$csv")"
echo "program,robots,batch,threads,updates,seconds,cpu_seconds,updates_per_second,updates_per_cpu_second" >"$csv"
for _ in $(seq "$rounds"); do
    for threads in 1 2; do
        for robots in 2 14; do
            "$learner" bench --no-heading --robots "$robots" --threads "$threads" | tee -a "$csv"
            "$python" "$root/learner/bench/cleanrl_sac.py" bench --robots "$robots" --threads "$threads" | tee -a "$csv"
        done
    done
done
