//! A run that was killed leaves files; the next run sweeps them. Its robots end by themselves.

use tests::{Run, robots_of, shared_files, wait_until};

#[test]
fn a_killed_coordinator_takes_its_robots_along_and_the_next_run_sweeps() {
    for exchange in ["", "--relay"] {
        let mut run = Run::start("agent", &format!("--scenario ex14_d --to-the-end --max-ticks 10000000 {exchange}"));
        run.wait_until_driving();
        let (pid, folder) = (run.pid(), run.folder.clone());
        assert_eq!(robots_of(&folder).len(), 14);
        run.signal("KILL");
        run.wait();
        wait_until("its robots end", || robots_of(&folder).is_empty());
        // Nobody could clean up, unless a test beside this one has just swept; a reader must see the difference.
        let left = shared_files(pid);
        let next = Run::start("agent", "--scenario two_setpoint").finish();
        assert_eq!(next.status.code(), Some(0), "{next:?}");
        let still = shared_files(pid);
        assert!(still.is_empty(), "of {left:?} were not swept: {still:?}");
    }
}
