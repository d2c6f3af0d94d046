//! A robot that crashes ends the run: exit code 3, its name, how it ended and its last words.

use tests::{ENDLESS, Robots, Run};

fn lost(fault: &'static str, exchange: &str) -> String {
    let finished =
        Run::start(Robots::Faulty(fault), &format!("14 {ENDLESS} --on-loss stop --exchange {exchange}")).finish();
    assert_eq!(finished.status.code(), Some(3), "{finished:?}");
    assert_eq!(finished.summary["success"], false, "{finished:?}");
    finished.stderr
}

#[test]
fn a_panic_is_reported_with_its_message() {
    let message = lost("3:panic:40", "peer");
    assert!(message.contains("robot 3 (robot-3) was lost at tick 40: it ended with exit code 101"), "{message}");
    assert!(message.contains("the fake robot was told to panic"), "{message}");
}

#[test]
fn a_robot_that_gives_up_in_the_first_tick_is_reported_with_its_error() {
    let message = lost("13:exit:0", "relay");
    assert!(message.contains("robot 13 (robot-13) was lost at tick 0: it ended with exit code 7"), "{message}");
    assert!(message.contains("error: the fake robot was told to give up"), "{message}");
}

#[test]
fn a_robot_that_ends_before_it_is_ready_is_reported() {
    let message = lost("0:exit", "relay");
    assert!(message.contains("robot 0 (robot-0) was lost before tick 0: it ended with exit code 7"), "{message}");
}

#[test]
fn a_robot_killed_from_outside_is_reported_by_signal() {
    let mut run = Run::start(Robots::Real, &format!("14 {ENDLESS} --on-loss stop"));
    run.wait_until_driving();
    let robot = *run.robots().first().expect("robots drive");
    tests::signal(robot, "KILL");
    let finished = run.finish();
    assert_eq!(finished.status.code(), Some(3), "{finished:?}");
    assert!(finished.stderr.contains("was ended by signal 9"), "{finished:?}");
}
