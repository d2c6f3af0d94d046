#!/bin/sh
# What looking on costs a tick: runs without a view and runs with one take turns, so that whatever else the machine
# does falls on both.
#   results/latency/views.sh                 30 rounds into results/latency/views.csv
#   results/latency/views.sh FILE ROUNDS
# Every run is fourteen robots in lock step (as fast as they answer: the hardest case for a view) at 50 ticks per second
# of the layout, about 900 ticks. `--live` has a reader that takes every frame, `--tui` draws on a terminal of `script`.
# Needs curl, script (util-linux) and python3.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-$root/results/latency/views.csv}
rounds=${2:-30}
port=18764
for tool in curl script python3; do
    command -v "$tool" >/dev/null || { echo "error: $tool is missing" >&2; exit 2; }
done
cargo build -q --release --locked --manifest-path "$root/Cargo.toml" -p cli -p agent --bins
vodca=${CARGO_TARGET_DIR:-$root/target}/release/vodca
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

drive() { # drive FOLDER OPTIONS OF run ...: it may end without arrival, but not otherwise
    folder=$1; shift
    "$vodca" run 14 --set model.sample_time=0.02 --max-ticks 1000 --out "$folder" "$@" >/dev/null || [ $? = 1 ]
}
one() { # one VIEW NUMBER
    folder=$work/run
    rm -rf "$folder"
    case $1 in
    none) drive "$folder" ;;
    live)
        (until curl -sN "http://127.0.0.1:$port/frames" >/dev/null 2>&1; do sleep 0.02; done) & reader=$!
        drive "$folder" --live $port
        wait $reader || true ;;
    tui) # the terminal is script's; what is drawn goes nowhere
        script -qec "'$vodca' run 14 --set model.sample_time=0.02 --max-ticks 1000 --out '$folder' --tui" /dev/null >/dev/null ;;
    esac
    cut -d, -f2 "$folder/latency.csv" | python3 "$root/results/latency/views.py" row "$2" "$1" >>"$out"
}

echo "pair,view,ticks,p50_us,p99_us,mean_us" >"$out"
pair=0
round=0
while [ "$round" -lt "$rounds" ]; do
    for view in live tui; do
        # The one that comes first takes turns as well.
        if [ $((round % 2)) = 0 ]; then order="none $view"; else order="$view none"; fi
        for which in $order; do one "$which" "$pair"; done
        pair=$((pair + 1))
    done
    round=$((round + 1))
    echo "round $round of $rounds" >&2
done
python3 "$root/results/latency/views.py" table "$out"
