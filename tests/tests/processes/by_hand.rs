//! Robots may be started by hand.

use std::process::Command;
use tests::{Robots, Run, wait_until};

#[test]
fn robots_started_by_hand_drive_like_launched_ones() {
    let run = Run::start(Robots::Real, "2 --by-hand");
    wait_until("the commands are printed", || commands(&run).len() == 2);
    let start = |line: &String| {
        let arguments = line.split_whitespace().skip(1);
        Command::new(tests::program("agent")).args(arguments).spawn().expect("the robot starts")
    };
    let mut robots: Vec<_> = commands(&run).iter().rev().map(start).collect(); // any order will do
    let finished = run.finish();
    assert_eq!(finished.status.code(), Some(0), "{finished:?}");
    for robot in &mut robots {
        assert!(robot.wait().expect("our own child").success());
    }
    let launched = Run::start(Robots::Real, "2").finish();
    assert!(finished.trajectory == launched.trajectory && !launched.trajectory.is_empty());
}

/// The commands that a waiting coordinator has printed.
fn commands(run: &Run) -> Vec<String> {
    run.printed().lines().filter(|line| line.contains(" --robot ")).map(String::from).collect()
}
