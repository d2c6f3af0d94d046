//! Runs with a policy, one file per promise. Apart from the others because only these need the policy
//! server, the heaviest build of the project.
#![allow(clippy::unwrap_used)] // a panic is how a test fails

mod bench;
mod compared;
mod fence;
mod killed;
mod picked_up;
mod rollouts;
mod swap;
mod training;

use policy::contract::Contract;
use policy::onnx::{Activation, ActorGraph, Dense};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Where the policy server is: beside the coordinator, which looks for it there.
fn policy_server() -> PathBuf {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| alone("policy-server")).clone()
}

/// Where the learner is: beside the coordinator, for which it looks there.
fn learner() -> PathBuf {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| alone("learner")).clone()
}

/// The program of `package`, built by itself: only these tests need it. `cargo test --workspace` has built it with the
/// same features, so that nothing is left to do.
fn alone(package: &str) -> PathBuf {
    let status = Command::new(env!("CARGO"))
        .args(["build", "--release", "--bins", "-p", package])
        .current_dir(tests::root())
        .status()
        .expect("cargo is there");
    assert!(status.success(), "{package} does not build");
    tests::program("vodca").with_file_name(package)
}

/// An actor for `robots` that answers everything with the horizon `steps`.
fn actor(robots: usize, steps: usize) -> (Vec<u8>, Contract) {
    let mean = ((steps as f64 - 1.5) / 24.0 - 1.0).atanh() as f32;
    let layer = |inputs: usize, outputs: usize, weight: f32, bias: f32| Dense {
        inputs,
        outputs,
        weight: vec![weight; inputs * outputs],
        bias: vec![bias; outputs],
    };
    let graph = ActorGraph {
        hidden: vec![layer(2 * robots, 64, 0.01, 0.0)],
        activation: Activation::Relu,
        mean: layer(64, robots, 0.0, mean),
        log_std: Some(layer(64, robots, 0.0, -1.0)),
        log_std_bounds: (-20.0, 2.0),
        metadata: BTreeMap::new(),
    };
    (graph.write(), Contract::standard(robots, true))
}

/// The ticks of `policy.csv` so far: source, version, sha256.
fn acted(run: &Path) -> Vec<[String; 3]> {
    let text = std::fs::read_to_string(run.join("policy.csv")).unwrap_or_default();
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    let columns = |line: &str| {
        let mut fields = line.split(',').skip(1).map(String::from);
        std::array::from_fn(|_| fields.next().unwrap_or_default())
    };
    whole.lines().skip(1).map(columns).collect()
}

/// Repeats the run in one process from its recorded horizons; the same bytes or a panic.
fn assert_same_bytes_in_process(run: &Path) {
    let output = Command::new(tests::program("vodca")).arg("replay").arg(run).output().expect("it starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}
