//! Set-points change at run time: by tasks, and by orders from outside.

use super::checked;
use std::fs;
use std::process::Command;
use tests::{Robots, Run};

#[test]
fn robots_with_tasks_are_sent_on_and_one_that_was_killed_too() {
    let arguments = "6 --scenario ring:6 --tasks random:1 --max-ticks 200 --chaos kill:2@60 --respawn 3 --exchange";
    let [peer, relay] = ["peer", "relay"].map(|exchange| checked(&format!("{arguments} {exchange}")));
    assert_eq!(peer.status.code(), Some(0), "{peer:?}");
    let tasks = &peer.summary["tasks"];
    assert!(tasks["endless"] == true && tasks["arrivals"].as_u64().is_some_and(|count| count > 12), "{tasks}");
    assert!(peer.stdout.contains("arrivals"), "{}", peer.stdout);
    assert!(peer.trajectory == relay.trajectory);
}

#[test]
fn a_list_of_tasks_is_done_and_then_the_run_is_over() {
    let home = tempfile::tempdir().unwrap();
    let list = home.path().join("tasks.csv");
    let scenario = vodca::scenario::Scenario::resolve(Some("ring:4"), None).unwrap();
    let of = |robot: usize| scenario.robots[robot].set_point;
    // The first two exchange their places, then one goes to the middle.
    let text = format!("robot,x,y,after\n0,{},{},0\n1,{},{},0\n1,0,0,150\n", of(1).x, of(1).y, of(0).x, of(0).y);
    fs::write(&list, text).unwrap();
    let run = checked(&format!("4 --scenario ring:4 --tasks {}", list.display()));
    assert_eq!(run.status.code(), Some(0), "{run:?}");
    assert_eq!(run.summary["tasks"]["arrivals"], 7, "{}", run.summary);
    assert!(run.summary["ticks"].as_u64().is_some_and(|ticks| ticks > 150));
}

#[test]
fn a_robot_goes_where_it_is_sent_and_a_place_that_cannot_be_is_refused() {
    let mut run = Run::start(Robots::Real, "4 --scenario ring:4 --real-time --max-ticks 100000 --tasks orders");
    run.wait_until_driving();
    let folder = run.folder.clone();
    let go = |place: [f64; 2]| {
        let mut command = Command::new(tests::program("vodca"));
        command.arg("go").arg(&folder).arg("0").args(place.map(|axis| axis.to_string()));
        command.output().expect("vodca runs")
    };
    let scenario = vodca::scenario::Scenario::resolve(Some("ring:4"), None).unwrap();
    let taken = scenario.robots[1].set_point;
    let refused = go([taken.x, taken.y]);
    let why = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(2) && why.contains("both can never be there"), "{why}");
    let sent = go([0.25, -0.5]);
    assert!(sent.status.success(), "{}", String::from_utf8_lossy(&sent.stderr));
    assert!(String::from_utf8_lossy(&sent.stdout).contains("goes to [0.25, -0.5] m from tick"));
    run.signal_until_ended("INT");
    let set_points = fs::read_to_string(run.folder.join("set_points.csv")).unwrap();
    assert!(set_points.lines().count() == 2 && set_points.contains(",0,0.25,-0.5"), "{set_points}");
    assert_eq!(evaluation::replay::replay(&run.folder).unwrap().difference, None);
    let ended = go([0.0, 0.0]);
    assert!(String::from_utf8_lossy(&ended.stderr).contains("has ended"));
    assert!(!run.folder.join("orders").exists());
    run.finish();
}
