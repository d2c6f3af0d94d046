//! A run whose coordinator was killed leaves nothing: its robots end by themselves, and the last one tidies up. What is
//! left when everything is killed at once the next run sweeps.

use tests::{ENDLESS, Robots, Run, robots_of, shared_files, signal, wait_until};

#[test]
fn robots_end_with_a_killed_coordinator_and_the_last_one_tidies_up() {
    for exchange in ["peer", "relay"] {
        let mut run = Run::start(Robots::Real, &format!("14 {ENDLESS} --exchange {exchange}"));
        run.wait_until_driving();
        let (pid, folder) = (run.pid(), run.folder.clone());
        let stopped = *run.robots().first().expect("robots drive");
        signal(stopped, "STOP"); // it must end, too
        run.signal("KILL");
        run.wait();
        wait_until("its robots end", || robots_of(&folder).is_empty());
        let left = shared_files(pid);
        assert!(left.is_empty(), "{left:?}");
    }
}

#[test]
fn a_robot_that_hangs_ends_with_its_coordinator() {
    let mut run = Run::start(Robots::Faulty("1:spin:5"), "2 --tick-deadline 60");
    run.wait_until_driving();
    let (pid, folder) = (run.pid(), run.folder.clone());
    run.signal("KILL");
    run.wait();
    wait_until("its robots end", || robots_of(&folder).is_empty());
    assert!(shared_files(pid).is_empty());
}

#[test]
fn what_is_left_when_everything_is_killed_the_next_run_sweeps() {
    for exchange in ["peer", "relay"] {
        let mut run = Run::start(Robots::Real, &format!("14 {ENDLESS} --exchange {exchange}"));
        run.wait_until_driving();
        let (pid, folder) = (run.pid(), run.folder.clone());
        assert_eq!(robots_of(&folder).len(), 14);
        run.signal("STOP"); // that it cannot react
        run.robots().into_iter().for_each(|robot| signal(robot, "KILL"));
        run.signal("KILL");
        run.wait();
        wait_until("its robots end", || robots_of(&folder).is_empty());
        // Nobody could clean up, unless a test beside this one has just swept; a reader must see the difference.
        let left = shared_files(pid);
        let next = Run::start(Robots::Real, "2").finish();
        assert_eq!(next.status.code(), Some(0), "{next:?}");
        let still = shared_files(pid);
        assert!(still.is_empty(), "of {left:?} were not swept: {still:?}");
    }
}
