//! Ctrl-C and SIGTERM end a run at any moment, and it leaves nothing behind.

use std::os::unix::process::ExitStatusExt;
use std::thread::sleep;
use std::time::Duration;
use tests::Run;

#[test]
fn an_interrupted_run_ends_in_order() {
    for (signal, exchange) in [("INT", ""), ("TERM", "--relay"), ("HUP", "")] {
        let mut run = Run::start("agent", &format!("--scenario ex14_d --to-the-end --max-ticks 10000000 {exchange}"));
        run.wait_until_driving();
        run.signal(signal);
        let finished = run.finish();
        assert_eq!(finished.status.code(), Some(0), "{signal}: {finished:?}");
        assert!(finished.stdout.contains("Stopped after"), "{signal}: {finished:?}");
        assert!(finished.steps.starts_with("0,0,"), "{signal}: what was done must be there");
    }
}

#[test]
fn an_interrupt_between_two_real_time_ticks_does_not_wait_for_the_next() {
    let mut run = Run::start("agent", "--scenario two_setpoint --real-time --relay");
    run.wait_until_driving();
    run.signal("INT");
    let finished = run.finish();
    assert_eq!(finished.status.code(), Some(0), "{finished:?}");
}

#[test]
fn an_interrupt_during_the_start_leaves_nothing() {
    // The start of 30 robots takes a few hundred milliseconds: hit it everywhere, the first instants above all.
    for milliseconds in [0, 1, 2, 3, 5, 8, 12, 20, 30, 50, 80, 120, 180, 250] {
        let run = Run::start("agent", "--scenario ring:30 --to-the-end --max-ticks 10000000");
        sleep(Duration::from_millis(milliseconds));
        run.signal(if milliseconds % 2 == 0 { "INT" } else { "TERM" });
        let finished = run.finish();
        // Before it can catch signals it is ended by them, and has made nothing yet.
        let caught = finished.status.code() == Some(0);
        let uncaught = finished.status.signal().is_some() && milliseconds < 50;
        assert!(caught || uncaught, "after {milliseconds} ms: {finished:?}");
    }
}
