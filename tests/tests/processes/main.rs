//! Whole runs, one file per promise.

mod bench;
mod by_hand;
mod check_solver;
mod crash;
mod fence;
mod full_disk;
mod golden;
mod hang;
mod interrupt;
mod kills;
mod late;
mod leftovers;
mod limits;
mod lost;
mod same_bytes;
mod slow_viewer;
mod tasks;
mod two_runs;

/// Starts a run, waits for its end, and checks what it left: nothing off in its record, and the same bytes when it is
/// repeated, faults included.
fn checked(arguments: &str) -> tests::Finished {
    let mut run = tests::Run::start(tests::Robots::Real, arguments);
    run.wait();
    let verified = evaluation::verify::verify(&run.folder).expect("a recorded run");
    assert!(verified.findings.is_empty(), "{arguments}: {:?}", verified.findings);
    let replayed = evaluation::replay::replay(&run.folder).expect("a recorded run");
    assert_eq!(replayed.difference, None, "{arguments}");
    run.finish()
}
