//! A robot that hangs ends the run like one that crashes, and nobody else hangs.

use tests::{ENDLESS, Robots, Run};

fn lost(fault: &'static str, exchange: &str) -> String {
    let finished =
        Run::start(Robots::Faulty(fault), &format!("14 {ENDLESS} --on-loss stop --exchange {exchange}")).finish();
    assert_eq!(finished.status.code(), Some(3), "{finished:?}");
    finished.stderr
}

#[test]
fn a_sleeping_robot_is_lost_at_its_tick() {
    let message = lost("2:hang:30", "peer");
    assert!(message.contains("robot 2 (robot-2) was lost at tick 30: it gave no answer for 1.2 s"), "{message}");
}

#[test]
fn a_spinning_robot_is_lost_at_its_tick() {
    let message = lost("7:spin:10", "relay");
    assert!(message.contains("robot 7 (robot-7) was lost at tick 10: it gave no answer"), "{message}");
}

#[test]
fn a_robot_that_never_gets_ready_is_lost() {
    let message = lost("4:hang", "relay");
    assert!(message.contains("robot 4 (robot-4) was lost before tick 0: it gave no answer"), "{message}");
}

#[test]
fn robots_give_up_when_the_coordinator_hangs() {
    let mut run = Run::start(Robots::Real, &format!("2 {ENDLESS} --on-loss stop"));
    run.wait_until_driving();
    run.signal("STOP");
    let ended = |pid: &u32| shared::os::start_time(*pid).is_none();
    let robots = run.robots();
    assert_eq!(robots.len(), 2);
    tests::wait_until("the robots give up", || robots.iter().all(ended));
    run.signal("CONT");
    let finished = run.finish();
    assert_eq!(finished.status.code(), Some(3), "{finished:?}");
    assert!(finished.stderr.contains("the coordinator has announced nothing for"), "{finished:?}");
}
