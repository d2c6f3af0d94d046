//! Peer, relay, a busy machine and the team in one process give the same bytes.

use agent::team::Team;
use shared::horizon_source::HorizonSource;
use shared::params::Profile;
use std::fmt::Write;
use std::process::{Child, Command, Stdio};
use tests::Run;

/// What the conductor writes, from the team in this process.
fn in_process(scenario: &str, horizon: &str, ticks: u64) -> String {
    let (scenario, params) = shared::scenario::set_up(Some(scenario), None, Profile::Safe, &[]).unwrap();
    let spec = horizon.parse().unwrap();
    let source = HorizonSource::new(&spec, scenario.robots.len(), 7, params.horizon.jitter).unwrap();
    let mut team = Team::new(&scenario, &params, 7);
    let mut text = String::new();
    for tick in 0..ticks {
        for (robot, step) in team.step(|robot| source.horizon(robot, tick)).iter().enumerate() {
            let (p, u) = (step.next_position, step.input);
            writeln!(text, "{tick},{robot},{:?},{:?},{:?},{:?},{}", p.x, p.y, u.x, u.y, step.horizon).unwrap();
        }
    }
    text
}

fn processes(scenario: &str, horizon: &str, ticks: u64, exchange: &str) -> String {
    let arguments = format!("--scenario {scenario} --horizon {horizon} --max-ticks {ticks} --to-the-end {exchange}");
    let finished = Run::start("agent", &arguments).finish();
    assert_eq!(finished.status.code(), Some(1), "{finished:?}"); // the ticks were used up
    finished.steps
}

#[test]
fn peer_and_relay_do_what_one_process_does() {
    for (scenario, horizon) in [("ex14_d", "random:3"), ("four_gate", "fixed:9,40,20,1"), ("antipodal32", "fixed:20")] {
        let expected = in_process(scenario, horizon, 120);
        for exchange in ["", "--relay"] {
            let steps = processes(scenario, horizon, 120, exchange);
            let differs = steps.lines().zip(expected.lines()).find(|(one, other)| one != other);
            assert!(steps == expected, "{scenario} {exchange}: {differs:?}");
        }
    }
}

/// Keeps a core busy until dropped.
struct Busy(Child);

impl Busy {
    fn new() -> Self {
        let child = Command::new("sh").args(["-c", "while :; do :; done"]).stdin(Stdio::null()).spawn();
        Self(child.expect("a shell is there"))
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn a_busy_machine_changes_no_byte() {
    let calm = in_process("ex14_d", "random:5", 150);
    let cores = std::thread::available_parallelism().map_or(2, usize::from);
    let _busy: Vec<Busy> = (0..cores).map(|_| Busy::new()).collect();
    for exchange in ["", "--relay"] {
        assert!(processes("ex14_d", "random:5", 150, exchange) == calm, "{exchange}");
    }
}
