//! Robots may be started by hand.

use std::process::Command;
use tests::{Run, wait_until};

#[test]
fn robots_started_by_hand_drive_like_launched_ones() {
    let run = Run::start_with(None, "--scenario two_setpoint");
    wait_until("the commands are printed", || run.printed().lines().count() == 2);
    let mut robots: Vec<_> = run
        .printed()
        .lines()
        .rev() // any order will do
        .map(|line| {
            let arguments = line.split_whitespace().skip(1);
            Command::new(tests::program("agent")).args(arguments).spawn().expect("the robot starts")
        })
        .collect();
    let finished = run.finish();
    assert_eq!(finished.status.code(), Some(0), "{finished:?}");
    for robot in &mut robots {
        assert!(robot.wait().expect("our own child").success());
    }
    let launched = Run::start("agent", "--scenario two_setpoint").finish();
    assert!(finished.steps == launched.steps && !launched.steps.is_empty());
}
