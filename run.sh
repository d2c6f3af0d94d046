#!/bin/sh
# The front door: builds what a command needs, then hands over to the program.
#   ./run.sh 14              fourteen robots, one process each
#   ./run.sh test            all tests
#   ./run.sh --help          everything else
set -eu
root=$(cd "$(dirname "$0")" && pwd)
target=${CARGO_TARGET_DIR:-$root/target}

missing() { echo "error: $1 is missing; install it: $2" >&2; exit 2; }
command -v cargo >/dev/null || missing "the Rust compiler (cargo)" "with rustup from https://rustup.rs, on Debian 13 apt-get install rustup && rustup default stable"
command -v cc >/dev/null || missing "a C compiler (cc)" "apt-get install build-essential"
ulimit -n "$(ulimit -H -n)" 2>/dev/null || true # every robot's process and service takes a few files

cargo_release() { # cargo_release build|test ARGUMENTS
    action=$1; shift
    cargo "$action" --release --locked --manifest-path "$root/Cargo.toml" "$@"
}
build() { # build ARGUMENTS: silent when there is little to do
    quiet=-q
    [ -x "$target/release/vodca" ] || { quiet=; echo "building for the first time, some minutes ..." >&2; }
    cargo_release build $quiet --bins "$@" >&2
}

case ${1-} in
test) shift; cargo_release test --workspace "$@"; exit ;;
python) shift; exec "$root/python/install.sh" "$@" ;;
policy) shift; build -p policy-server; exec "$target/release/policy-server" "$@" ;;
learner) shift; build -p learner; exec "$target/release/learner" "$@" ;;
learn) build -p learner; exec "$target/release/learner" "$@" ;;
train) build -p learner -p cli -p agent -p policy-server; exec "$target/release/learner" "$@" ;; # robots play, a server serves
[0-9]* | --scenario*) set -- run "$@" ;;
esac
build -p cli -p agent
# The program itself says what else its arguments need: the policy server is the heaviest build of all.
# Always built beside the two above: alone, cargo would compile what they share anew, with other features.
for need in $("$target/release/vodca" needs -- "$@"); do
    case $need in
    foxglove) build -p cli -p agent --features cli/foxglove ;;
    *) build -p cli -p agent -p "$need" ;;
    esac
done
exec "$target/release/vodca" "$@"
