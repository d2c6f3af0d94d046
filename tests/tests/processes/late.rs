//! A robot that is late is not lost: the others go on without it, and it catches up.

use crate::checked;
use tests::{ENDLESS, Robots, Run, signal, wait_until};

#[test]
fn messages_that_come_late_twice_or_never_cost_ticks_and_no_more() {
    let faults = "delay:0.02,drop:0.02,duplicate:0.1,stop:0.005x4,seed:5";
    for exchange in ["relay", "peer"] {
        let arguments = format!("14 --horizon random:4 --chaos {faults} --exchange {exchange}");
        let runs = [(); 2].map(|()| checked(&arguments));
        for finished in &runs {
            assert_eq!(finished.status.code(), Some(0), "{finished:?}");
            assert!(finished.summary["statuses"]["late"].as_u64() > Some(20), "{}", finished.summary["statuses"]);
            assert_eq!(finished.summary["statuses"]["lost"], 0);
        }
        assert!(runs[0].trajectory == runs[1].trajectory, "{exchange}: the same faults give the same bytes");
    }
}

#[test]
fn messages_that_come_twice_change_nothing() {
    let calm = checked("14 --horizon random:4");
    let finished = checked("14 --horizon random:4 --chaos duplicate:0.5,seed:1");
    assert!(finished.trajectory == calm.trajectory);
}

#[test]
fn a_stopped_robot_holds_up_one_tick_and_goes_on_when_it_is_continued() {
    let mut run = Run::start(
        Robots::Real,
        "14 --real-time --set model.sample_time=0.05 --tick-deadline 0.4 --lost-after 60 --max-ticks 1000",
    );
    run.wait_until_driving();
    let pid = *run.robots().first().expect("robots drive");
    signal(pid, "STOP");
    let changes = run.folder.join("membership.csv");
    let says = |word: &str| std::fs::read_to_string(&changes).is_ok_and(|text| text.contains(word));
    wait_until("it is late", || says(",late,1,"));
    signal(pid, "CONT");
    wait_until("it is back", || says(",back,1,"));
    run.wait();
    let replayed = evaluation::replay::replay(&run.folder).expect("a recorded run");
    assert_eq!(replayed.difference, None);
    let finished = run.finish();
    assert_eq!(finished.status.code(), Some(0), "{finished:?}");
}

#[test]
fn a_robot_that_hangs_for_good_is_ended_and_the_others_arrive() {
    for fault in ["2:hang:30", "7:spin:10"] {
        let finished = Run::start(Robots::Faulty(fault), "14 --tick-deadline 0.5 --lost-after 0.5").finish();
        assert_eq!(finished.status.code(), Some(1), "{finished:?}");
        assert!(finished.stdout.contains("s and was ended"), "{}", finished.stdout);
    }
}

#[test]
fn a_machine_that_stood_still_as_a_whole_goes_on() {
    let mut run = Run::start(Robots::Real, &format!("14 {ENDLESS} --tick-deadline 0.3"));
    run.wait_until_driving();
    let all: Vec<u32> = run.robots().into_iter().chain([run.pid()]).collect();
    all.iter().for_each(|pid| signal(*pid, "STOP"));
    std::thread::sleep(std::time::Duration::from_secs(1));
    all.iter().for_each(|pid| signal(*pid, "CONT"));
    let before = std::fs::read_to_string(run.folder.join("trajectory.csv")).unwrap_or_default().lines().count();
    wait_until("it goes on", || {
        let text = std::fs::read_to_string(run.folder.join("trajectory.csv")).unwrap_or_default();
        let last: Vec<&str> = text.lines().rev().take(14).collect();
        text.lines().count() > before + 140 && last.iter().all(|line| line.ends_with(",solved"))
    });
    run.signal("TERM");
    let finished = run.finish();
    assert_eq!(finished.status.code(), Some(0), "{finished:?}");
    assert_eq!(finished.summary["statuses"]["lost"], 0, "{finished:?}");
}
