//! A robot's process may end at any moment: the others drive on round the body that is left.

use crate::checked;
use std::process::Command;
use tests::{Finished, Robots, Run, program, signal, wait_until};

/// Who was absent in a run, as `summary.json` says.
fn absences(finished: &Finished) -> Vec<serde_json::Value> {
    finished.summary["absences"].as_array().cloned().unwrap_or_default()
}

/// How many had arrived at its end.
fn arrived(finished: &Finished) -> usize {
    let robots = finished.summary["robots"].as_array().cloned().unwrap_or_default();
    robots.iter().filter(|robot| !robot["arrived_tick"].is_null()).count()
}

#[test]
fn the_others_arrive_round_a_body_whose_process_was_killed() {
    let mut bytes = Vec::new();
    for exchange in ["peer", "relay"] {
        let finished = checked(&format!("14 --chaos kill:3@30 --exchange {exchange}"));
        assert_eq!((finished.status.code(), arrived(&finished)), (Some(1), 13), "{finished:?}");
        assert!(finished.stdout.contains("no: 13 of 14 arrived, robot-3 lost at tick 30"), "{}", finished.stdout);
        assert!(finished.stdout.contains("robot-3 lost at tick 30: it was ended by signal 9"), "{}", finished.stdout);
        let [absence] = &absences(&finished)[..] else { panic!("one robot was lost: {finished:?}") };
        assert_eq!((&absence["state"], &absence["until"]), (&"lost".into(), &serde_json::Value::Null));
        bytes.push(finished.trajectory);
    }
    assert!(bytes[0] == bytes[1], "peer and relay differ");
}

#[test]
fn a_robot_that_is_started_anew_drives_on_and_arrives() {
    let again = || checked("14 --respawn 1 --chaos kill:3@30 --horizon random:2");
    let finished = again();
    assert_eq!((finished.status.code(), arrived(&finished)), (Some(0), 14), "{finished:?}");
    let [absence] = &absences(&finished)[..] else { panic!("one robot was lost: {finished:?}") };
    assert_eq!((absence["tick"].as_u64(), absence["until"].as_u64()), (Some(30), Some(32)), "{absence}");
    assert!(again().trajectory == finished.trajectory, "the same faults give the same bytes");
}

#[test]
fn a_robot_is_started_anew_as_often_as_was_asked_for_and_then_stays_where_it_is() {
    let finished = checked("14 --respawn 2 --chaos kill:3@20,kill:3@24,kill:3@30");
    assert_eq!((finished.status.code(), arrived(&finished)), (Some(1), 13), "{finished:?}");
    let untils: Vec<_> = absences(&finished).iter().map(|absence| absence["until"].as_u64()).collect();
    assert_eq!(untils, [Some(22), Some(27), None]);
}

#[test]
fn robots_that_panic_or_give_up_are_lost_with_their_last_words() {
    for (fault, words) in [
        ("3:panic:10", "ended with exit code 101, saying \"panicked at"),
        ("0:exit:0", "ended with exit code 7, saying \"error: the fake robot was told to give up\""),
        ("13:abort:20", "was ended by signal 6"),
    ] {
        let finished = Run::start(Robots::Faulty(fault), "14").finish();
        assert_eq!((finished.status.code(), arrived(&finished)), (Some(1), 13), "{finished:?}");
        assert!(finished.stdout.contains(words), "{}", finished.stdout);
    }
}

#[test]
fn a_robot_killed_from_outside_comes_back_by_hand() {
    let mut run = Run::start(Robots::Real, "14 --real-time --set model.sample_time=0.05 --max-ticks 1000");
    run.wait_until_driving();
    let pid = *run.robots().first().expect("robots drive");
    let line = std::fs::read(format!("/proc/{pid}/cmdline")).expect("it lives");
    let line = String::from_utf8_lossy(&line).into_owned();
    let robot = line.split('\0').skip_while(|word| *word != "--robot").nth(1).expect("its number").to_string();
    signal(pid, "KILL");
    let changes = run.folder.join("membership.csv");
    wait_until("it is lost", || std::fs::read_to_string(&changes).is_ok_and(|text| text.contains(",lost,1,")));
    let mut successor = Command::new(program("vodca"))
        .args(["agent", "--run"])
        .arg(&run.folder)
        .args(["--robot", &robot])
        .spawn()
        .expect("it starts");
    run.wait();
    assert!(successor.wait().expect("our own child").success());
    let folder = run.folder.clone();
    let verified = evaluation::verify::verify(&folder).expect("a recorded run");
    assert!(verified.findings.is_empty(), "{:?}", verified.findings);
    let replayed = evaluation::replay::replay(&folder).expect("a recorded run");
    assert_eq!(replayed.difference, None);
    let finished = run.finish();
    assert_eq!((finished.status.code(), arrived(&finished)), (Some(0), 14), "{finished:?}");
}

#[test]
fn a_second_process_for_a_robot_that_drives_is_refused() {
    let mut run = Run::start(Robots::Real, &format!("2 {}", tests::ENDLESS));
    run.wait_until_driving();
    let output = Command::new(program("agent")).arg("--run").arg(&run.folder).args(["--robot", "1"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1));
    assert!(message.contains("robot 1 was not admitted") && message.contains("another process drives it"), "{message}");
    run.signal("TERM");
    assert_eq!(run.finish().status.code(), Some(0));
}
