#!/bin/sh
# Puts the policies that ship beside fixed, random and searched horizons: bench-runs/policies.sh DIR [NAME ...]
# Every policy leaves DIR/NAME.txt (the tables) and DIR/NAME.csv (every run). `python3 bench-runs/policies.py DIR`
# writes the table of the README.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
results=${1:-$here/policies-results}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- two_setpoint four_gate exchange_14 ring_8
mkdir -p "$results"

evaluate() { # evaluate NAME ARGUMENTS ...
    name=$1; shift
    rm -f "$results/$name.csv"
    "$root/run.sh" evaluate --policy "$root/policies/$name" "$@" --out "$results/$name.csv" >"$results/$name.txt"
    cat "$results/$name.txt"
}
for policy; do
    case $policy in
    two_setpoint) evaluate two_setpoint --scenario two_setpoint --profile paper --start-jitter 0.1 ;;
    four_gate) evaluate four_gate --scenario four_gate --profile paper --start-jitter 0.1 ;;
    exchange_14) evaluate exchange_14 --scenario ex14_d --profile paper --set vodca.rows=each --start-jitter 0.05 ;;
    ring_8) evaluate ring_8 --scenario ring:8 --profile safe --start-jitter 0.5 --generations 10 ;;
    *) echo "error: there is no policy \`$policy\`; they are: two_setpoint four_gate exchange_14 ring_8" >&2; exit 2 ;;
    esac
done
