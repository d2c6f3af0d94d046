//! Promise: what the learner exports answers in the policy server as it did in training.
#![allow(clippy::unwrap_used)] // a panic is how a test fails

use learner::export::export;
use learner::settings::Settings;
use policy::contract::Contract;
use policy::folder::PolicyFolder;
use std::path::PathBuf;
use std::process::Command;
use vodca::random::{Use, stream, unit};

const ROBOTS: usize = 14;

/// Positions within 25 m.
fn state(number: u64) -> Vec<f64> {
    let mut generator = stream(11, Use::Problem, 1, number);
    (0..2 * ROBOTS).map(|_| 25.0 * (2.0 * unit(&mut generator) - 1.0)).collect()
}

/// The policy server beside this test; `cargo test --workspace` has built it.
fn policy_server() -> Option<PathBuf> {
    let beside = std::env::current_exe().ok()?.parent()?.parent()?.join("policy-server");
    beside.is_file().then_some(beside)
}

#[test]
fn a_thousand_states_are_answered_as_in_training() {
    let Some(server) = policy_server() else {
        return eprintln!("skipped: cargo build --release -p policy-server");
    };
    let settings = Settings { log_std_min: -0.1, ..Settings::default() };
    let trained = learner::Actor::new(2 * ROBOTS, ROBOTS, &settings, 5);
    let mut contract = Contract::standard(ROBOTS, true);
    contract.observation.scale = [0.05, 0.04];
    contract.observation.offset = [3.0, -2.0];
    let place = tempfile::tempdir().unwrap();
    let folder = PolicyFolder::new(place.path().join("trained"));
    let states: Vec<Vec<f64>> = (0..1000).map(state).collect();
    export(&trained, &contract, &states, &folder).unwrap();

    let run = |command: &str, last: Option<&PathBuf>| {
        let output = Command::new(&server).arg(command).arg(folder.root()).args(last).output().unwrap();
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    run("check", None); // The whole ladder, the exported reference set included.
    let file = place.path().join("states.json");
    std::fs::write(&file, serde_json::to_vec(&states).unwrap()).unwrap();
    let answers: Vec<serde_json::Value> = serde_json::from_slice(&run("eval", Some(&file))).unwrap();
    assert_eq!(answers.len(), 1000);
    let mut largest = 0.0f64;
    for (answer, state) in answers.iter().zip(&states) {
        let positions: Vec<vodca::Position> =
            state.chunks_exact(2).map(|xy| vodca::Position::new(xy[0], xy[1])).collect();
        let mut input = vec![0.0; 2 * ROBOTS];
        contract.normalise(&positions, &mut input);
        let (mean, log_std) = trained.answer(&input);
        for (name, expected) in [("mean", mean), ("log_std", log_std)] {
            let served = answer[name].as_array().unwrap();
            assert_eq!(served.len(), ROBOTS);
            for (served, expected) in served.iter().zip(expected) {
                largest = largest.max((served.as_f64().unwrap() - f64::from(expected)).abs());
            }
        }
    }
    assert!(largest < 1e-5, "{largest}");
}
