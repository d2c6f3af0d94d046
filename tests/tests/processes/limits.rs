//! Teams of every size that is promised, and clear errors beyond.

use std::process::Command;
use tests::{ENDLESS, Robots, Run, program};

#[test]
fn teams_from_one_to_a_hundred_robots_drive() {
    for (robots, exchange) in [(1, "peer"), (2, "peer"), (32, "peer"), (50, "relay"), (100, "relay")] {
        let run = Run::start(Robots::Real, &format!("{robots} --max-ticks 10 --exchange {exchange}"));
        let finished = run.finish();
        assert_eq!(finished.status.code(), Some(1), "{robots} robots: {finished:?}");
        assert_eq!(finished.trajectory.lines().count(), 1 + 11 * robots, "{robots} robots");
    }
}

#[test]
fn two_hundred_robots_start_and_keep_to_the_clock() {
    let finished = Run::start(Robots::Real, "200 --max-ticks 5 --real-time").finish();
    assert_eq!(finished.status.code(), Some(1), "{finished:?}");
    assert_eq!(finished.trajectory.lines().count(), 1 + 6 * 200);
    let summary = &finished.summary;
    assert_eq!((summary["ticks"].as_u64(), summary["end"].as_str()), (Some(5), Some("out_of_ticks")));
    assert_eq!(summary["lateness"]["count"], 5, "{summary}");
    assert_eq!(summary["tick_parts"]["wake"]["count"], 5 * 200, "{summary}");
}

#[test]
fn a_robot_that_does_not_exist_is_refused() {
    let mut run = Run::start(Robots::Real, &format!("2 {ENDLESS}"));
    run.wait_until_driving();
    let output = Command::new(program("agent")).arg("--run").arg(&run.folder).args(["--robot", "2"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1));
    assert!(message.contains("there is no robot 2: the team has robots 0..=1"), "{message}");
    run.signal("TERM");
    assert_eq!(run.finish().status.code(), Some(0));
}

#[test]
fn a_robot_without_a_run_says_what_is_missing() {
    let output = Command::new(program("agent")).args(["--run", "/nowhere", "--robot", "0"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1));
    assert!(message.contains("/nowhere/team.toml") && message.lines().count() == 1, "{message}");
}

#[test]
fn a_robot_of_a_run_that_has_ended_says_so() {
    let mut run = Run::start(Robots::Real, "2");
    run.wait();
    let output = Command::new(program("agent")).arg("--run").arg(&run.folder).args(["--robot", "0"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1));
    assert!(message.contains("has the run ended"), "{message}");
    run.finish(); // checks that the late robot left nothing in shared memory either
}
