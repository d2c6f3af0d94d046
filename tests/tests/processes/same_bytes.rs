//! Peer, relay, a busy machine and the team in one process give the same bytes.

use coordinator::record::trajectory::{HEADER, push_end, push_tick};
use std::process::{Child, Command, Stdio};
use tests::{Robots, Run};
use vodca::horizon::Horizon;
use vodca::horizon_source::HorizonSource;
use vodca::params::Profile;
use vodca::team::Team;

/// The trajectory of the team in this process.
fn in_process(scenario: &str, horizon: &str, profile: Profile, ticks: u64) -> String {
    let (scenario, params) = vodca::scenario::set_up(Some(scenario), None, profile, &[]).expect("a valid scenario");
    let spec = horizon.parse().expect("a valid source");
    let source = HorizonSource::new(&spec, scenario.robots.len(), 7, params.horizon.jitter);
    let source = source.expect("horizons for all");
    trajectory(Team::new(&scenario, &params, 7), ticks, |robot, tick| source.horizon(robot, tick))
}

/// What `team` does in `ticks` ticks, as a recorded run says it.
pub(crate) fn trajectory(mut team: Team, ticks: u64, horizon: impl Fn(usize, u64) -> Horizon) -> String {
    let (mut text, mut positions) = (format!("{HEADER}\n"), Vec::new());
    for tick in 0..ticks {
        let horizons: Vec<Horizon> = (0..team.measured().len()).map(|robot| horizon(robot, tick)).collect();
        let steps = team.step(&horizons);
        push_tick(&mut text, tick, steps);
        positions = steps.iter().map(|step| step.next_position).collect();
    }
    push_end(&mut text, ticks, &positions);
    text
}

/// The trajectory of real processes.
fn processes(scenario: &str, horizon: &str, profile: Profile, ticks: u64, exchange: &str) -> String {
    let finished = Run::start(
        Robots::Real,
        &format!(
            "--scenario {scenario} --horizon {horizon} --profile {profile} --seed 7 --max-ticks {ticks} \
             --exchange {exchange}"
        ),
    )
    .finish();
    assert_eq!(finished.status.code(), Some(1), "the ticks are too few to arrive: {finished:?}");
    finished.trajectory
}

#[test]
fn peer_and_relay_do_what_one_process_does() {
    let cases = [
        ("ex14_d", "random:3", Profile::Safe, 80),
        ("ex14_b", "random:4", Profile::Paper, 80),
        ("four_gate", "fixed:9,40,20,1", Profile::Paper, 120),
        ("two_setpoint", "fixed:9,40", Profile::Safe, 60),
        ("antipodal32", "fixed:20", Profile::Safe, 60),
    ];
    for (scenario, horizon, profile, ticks) in cases {
        let expected = in_process(scenario, horizon, profile, ticks);
        for exchange in ["peer", "relay"] {
            let found = processes(scenario, horizon, profile, ticks, exchange);
            let differs = found.lines().zip(expected.lines()).find(|(one, other)| one != other);
            assert!(found == expected, "{scenario} {exchange}: {differs:?}");
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
    let calm = in_process("ex14_d", "random:5", Profile::Safe, 80);
    let cores = std::thread::available_parallelism().map_or(2, usize::from);
    let _busy: Vec<Busy> = (0..cores).map(|_| Busy::new()).collect();
    for exchange in ["peer", "relay"] {
        assert!(processes("ex14_d", "random:5", Profile::Safe, 80, exchange) == calm, "{exchange}");
    }
}
