#!/bin/sh
# Runs what the tables of the README are made of; README.md beside this file says what each part shows.
#   bench-runs/suite.sh                    all parts, into bench-runs/results
#   bench-runs/suite.sh DIR PART ...       these parts: quality robustness ablations random patience orca
# Every part leaves DIR/PART/ with runs.csv, table.md and summary.json. A part that is there already is kept:
# remove its folder to run it anew.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
results=${1:-$here/results}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- quality robustness ablations random patience orca
mkdir -p "$results"

compare() { # compare PART ARGUMENTS OF compare ...
    part=$1; shift
    if [ -e "$results/$part" ]; then echo "$results/$part is there already: kept" >&2; return; fi
    echo "== $part" >&2
    "$root/run.sh" compare "$@" --out "$results/$part"
}

# Thirty-eight layouts, some of each kind.
mixed="two_setpoint ex14_a ex14_b ex14_c ex14_d ex14_e ex14_f ex14_g four_gate four_wall four_cross
antipodal4 antipodal8 antipodal16 rand16o0_s0 rand16o0_s1 rand16o0_s2 rand16o0_s3
rand16o3_s0 rand16o3_s1 rand16o3_s2 rand16o3_s3 rand16o3_s4 rand16o3_s5 rand16o3_s6 rand16o3_s7 rand16o3_s8 rand16o3_s9
rand32o0_s0 rand32o0_s1 rand32o0_s2 rand32o0_s3
segregate3x4_s0 segregate3x4_s1 segregate3x4_s2 segregate4x4_s0 segregate4x4_s1 segregate4x4_s2"

# The jitter of the safe profile makes its fixed horizons random too: 25 runs per layout.
quality() { # every layout, fixed and random horizons, against the paper's controller and ORCA
    compare quality suite:all --seeds 5 \
        --controllers safe:each:10,20,30,49,random paper:fixed:20 orca 'orca[orca.push=0.3]' orca-rh
}
robustness() { # noise, late and lost plans, lost positions
    # shellcheck disable=SC2086 # a list of names
    compare robustness $mixed --max-ticks 700 --seeds 1 --controllers \
        safe:random \
        'safe[disturbance.noise=0.02]:random' \
        'safe[disturbance.noise=0.02,cell.noise_bound=0.02]:random' \
        'safe[disturbance.plan_delay=1]:random' \
        'safe[disturbance.plan_delay=2]:random' \
        'safe[disturbance.plan_loss=0.1]:random' \
        'safe[disturbance.plan_loss=0.3]:random' \
        'safe[disturbance.plan_delay=2,disturbance.plan_loss=0.3]:random' \
        'safe[disturbance.plan_loss=1]:random' \
        'safe[disturbance.position_loss=0.1]:random' \
        'safe[disturbance.position_loss=0.3]:random' \
        'safe[disturbance.position_loss=0.6]:random'
}
ablations() { # each rule of the safe profile left out or changed
    compare ablations suite:all --seeds 1 --controllers \
        safe:fixed:20 \
        'safe[vodca.turn=0,vodca.turn_lasting=0]:fixed:20' \
        'safe[aim.angle=0]:fixed:20' \
        'safe[aim.angle=0,aim.look_ahead=0]:fixed:20' \
        'safe[vodca.turn=0,vodca.turn_lasting=0,aim.angle=0,aim.look_ahead=0]:fixed:20' \
        'safe[vodca.turn_lasting=0.16]:fixed:20' \
        'safe[vodca.turn=0.35,vodca.turn_lasting=0.35]:fixed:20' \
        'safe[vodca.turn=0.15,vodca.turn_lasting=0.15]:fixed:20' \
        'safe[give_way.radius=0]:fixed:20' \
        'safe[give_way.radius=0.5]:fixed:20' \
        'safe[give_way.radius=1.5]:fixed:20' \
        'safe[give_way.radius=1000]:fixed:20' \
        'safe[aim.memory=1]:fixed:20' \
        'safe[aim.memory=0.1]:fixed:20' \
        'safe[aim.angle=0.35]:fixed:20' \
        'safe[aim.look_ahead=0]:fixed:20' \
        'safe[aim.look_ahead=25]:fixed:20' \
        'safe[aim.most=0.3]:fixed:20' \
        'safe[aim.most=0.9]:fixed:20' \
        'safe[aim.price=1]:fixed:20' \
        'safe[aim.price=9]:fixed:20' \
        'safe[vodca.patience=1]:fixed:20' \
        'safe[vodca.patience=0.5]:fixed:20' \
        'safe[vodca.back_off=1]:fixed:20' \
        'safe[vodca.back_off=0.8]:fixed:20' \
        'safe[cell.enabled=false]:fixed:20' \
        'safe[cell.separation=0.75]:fixed:20' \
        'safe[vodca.slack_linear=100000]:fixed:20' \
        'safe[vodca.slack_linear=1000]:fixed:20' \
        'safe[mpc.input_weight=10]:fixed:20' \
        'safe[mpc.input_weight=1]:fixed:20' \
        'safe[mpc.reference=set_point]:fixed:20' \
        'safe[horizon.jitter=0]:fixed:20' \
        'safe[horizon.jitter=2]:fixed:20'
}
random() { # ten thousand layouts nobody has looked at
    compare random random-boxes:10000 --controllers safe:random 'safe[vodca.patience=1]:random' orca orca-rh
}
patience() { # what is left waiting in dense boxes when the rules that free it are left out; seeds of its own
    # shellcheck disable=SC2046 # a list of names
    compare patience $(for seed in 0 1 2 3 4 5 6 7 8 9; do echo "rand32o0_s$seed rand48o0_s$seed"; done) \
        --seed-list 100..105 --controllers safe:each:10,20,30,49,random \
        'safe[vodca.patience=1]:each:10,20,30,49,random' 'safe[vodca.back_off=1]:each:10,20,30,49,random'
}
orca() { # ORCA over its time horizon, to be held against published numbers
    compare orca suite:all --seeds 10 --max-ticks 1000 --controllers \
        orca:1 orca:2 orca:3 orca:5 'orca[orca.push=0.3]:2' 'orca[orca.push=0.3]:5' orca-rh
}

for part; do
    case $part in
    quality | robustness | ablations | random | patience | orca) "$part" ;;
    *) echo "error: there is no part \`$part\`; the parts are: quality robustness ablations random patience orca" >&2; exit 2 ;;
    esac
done
