#!/bin/sh
# The front door: builds what a command needs, then hands over to the program.
#   ./run.sh 14              fourteen robots, one process each
#   ./run.sh test            all tests
#   ./run.sh --help          everything else
set -eu
root=$(cd "$(dirname "$0")" && pwd)
target=${CARGO_TARGET_DIR:-$root/target}

command -v cargo >/dev/null || { echo "error: cargo is missing; install Rust with rustup (see the README)" >&2; exit 2; }
command -v cc >/dev/null || { echo "error: a C compiler (cc) is missing; install it: apt-get install build-essential" >&2; exit 2; }
ulimit -n "$(ulimit -H -n)" 2>/dev/null || true # every robot's process and service takes a few files

cargo_release() { # cargo_release build|test ARGUMENTS
    action=$1; shift
    cargo "$action" --release --locked --manifest-path "$root/Cargo.toml" "$@"
}
build() { # build PACKAGE...: silent when there is little to do
    quiet=-q
    [ -x "$target/release/vodca" ] || { quiet=; echo "building for the first time, some minutes ..." >&2; }
    packages=
    for package; do packages="$packages -p $package"; done
    # shellcheck disable=SC2086 # words on purpose
    cargo_release build $quiet --bins $packages $features >&2
}
features=

case ${1-} in
test) shift; cargo_release test --workspace "$@"; exit ;;
[0-9]* | --scenario*) set -- run "$@" ;;
esac
# Only commands with a policy need its server: the embedded back-end is the heaviest build of all.
# By itself, so that its dependencies have the same features (and are built once) in every command.
server=
case " $* " in
*" --policy "* | *" --policy="* | *policy:* | " figures "*) server=policy-server ;;
" figures "*) for name in two_setpoint four_gate ex14_d; do [ ! -d "policies/$name" ] || server=policy-server; done ;;
esac
case " $* " in
*" --foxglove "* | *" --foxglove="*) foxglove=cli/foxglove ;;
*) foxglove= ;;
esac
case " $* " in
*" solver "* | *" step "* | *" exchange "* | *" hop "* | *" scale "* | *" --help "*) ;;
" bench "*) server=policy-server ;;
esac
case ${1-} in
policy) build policy-server; shift; exec "$target/release/policy-server" "$@" ;;
*) [ -z "$server" ] || build "$server" ;;
esac
features=${foxglove:+--features $foxglove}
case ${1-} in
run | bench | rollout) build cli agent ;;
learn) build learner; exec "$target/release/learner" "$@" ;;
learner) build learner; shift; exec "$target/release/learner" "$@" ;;
train) # Rollouts are runs of real processes with the policy server.
    build policy-server
    build cli agent
    build learner
    exec "$target/release/learner" "$@" ;;
*) build cli ;;
esac
exec "$target/release/vodca" "$@"
