//! Ctrl-C and SIGTERM end a run at any moment, and it leaves nothing behind.

use std::os::unix::process::ExitStatusExt;
use std::thread::sleep;
use std::time::Duration;
use tests::{ENDLESS, Robots, Run};

#[test]
fn an_interrupted_run_ends_in_order() {
    for (signal, exchange) in [("INT", "peer"), ("TERM", "relay"), ("HUP", "peer")] {
        let mut run = Run::start(Robots::Real, &format!("14 {ENDLESS} --exchange {exchange}"));
        run.wait_until_driving();
        run.signal(signal);
        let finished = run.finish();
        assert_eq!(finished.status.code(), Some(0), "{signal}: {finished:?}");
        // What was done is there, whole: a row per robot and tick, and the final positions.
        let rows = finished.trajectory.lines().count() as u64 - 1;
        assert_eq!(Some(rows), finished.summary["ticks"].as_u64().map(|ticks| 14 * (ticks + 1)), "{signal}");
        assert!(rows > 14, "{signal}");
    }
}

#[test]
fn an_interrupt_between_two_real_time_ticks_ends_the_run() {
    let mut run = Run::start(Robots::Real, "2 --real-time --set model.sample_time=5");
    run.wait_until_driving();
    run.signal("INT");
    let finished = run.finish();
    assert_eq!(finished.status.code(), Some(0), "{finished:?}");
}

#[test]
fn an_interrupt_during_the_start_leaves_nothing() {
    // The start of 30 robots takes a few hundred milliseconds: hit it everywhere, the first instants above all.
    for milliseconds in [0, 1, 2, 3, 5, 8, 12, 20, 30, 50, 80, 120, 180, 250] {
        let mut run = Run::start(Robots::Real, &format!("30 {ENDLESS}"));
        sleep(Duration::from_millis(milliseconds));
        run.signal_until_ended(if milliseconds % 2 == 0 { "INT" } else { "TERM" });
        let made = run.folder.exists();
        let finished = run.finish();
        // Before it can catch signals it is ended by them, however late that is on a busy machine, and has made
        // nothing yet.
        let caught = finished.status.code() == Some(0);
        let uncaught = finished.status.signal().is_some() && !made;
        assert!(caught || uncaught, "after {milliseconds} ms: {finished:?}");
    }
}
