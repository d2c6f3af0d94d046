//! A run that was killed leaves files; the next run sweeps them. Its robots end by themselves.

use tests::{ENDLESS, Robots, Run, robots_of, shared_files, wait_until};

#[test]
fn a_killed_coordinator_takes_its_robots_along_and_the_next_run_sweeps() {
    for exchange in ["peer", "relay"] {
        let mut run = Run::start(Robots::Real, &format!("14 {ENDLESS} --exchange {exchange}"));
        run.wait_until_driving();
        let (pid, folder) = (run.pid(), run.folder.clone());
        assert_eq!(robots_of(&folder).len(), 14);
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
