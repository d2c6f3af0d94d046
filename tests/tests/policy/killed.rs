//! Promise: the policy server's death never ends the run; horizons are held, then the default is used,
//! and a server started again joins in.

use crate::{acted, actor, assert_same_bytes_in_process, policy_server};
use shared::policy::folder::PolicyFolder;
use shared::policy::run_folder;
use std::process::{Command, Stdio};
use tests::{Robots, Run, wait_until};

#[test]
fn a_killed_server_is_bridged_and_its_successor_joins_in() {
    let place = tempfile::tempdir().unwrap();
    let source = PolicyFolder::new(place.path().join("policy"));
    let (model, contract) = actor(14, 12);
    source.publish(&model, &contract, None).unwrap();
    let server = policy_server();
    let arguments = format!(
        "14 --policy {} --policy-hold 3 --policy-default 25 --real-time --set model.sample_time=0.05 --set horizon.jitter=0 --max-ticks 200",
        source.root().display()
    );
    let mut run = Run::start(Robots::Real, &arguments);
    run.wait_until_driving();
    let status = PolicyFolder::new(run_folder(&run.folder)).read_status().unwrap().unwrap();
    tests::signal(status.pid, "KILL");
    let last = |run: &Run| acted(&run.folder).last().map(|[source, ..]| source.clone());
    wait_until("the default is used", || last(&run).as_deref() == Some("default"));
    let mut successor = Command::new(server)
        .args(["serve", "--run"])
        .arg(&run.folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_until("the successor answers", || last(&run).as_deref() == Some("policy"));
    run.wait();
    wait_until("the successor ends with the run", || successor.try_wait().unwrap().is_some());

    let recorded = acted(&run.folder);
    let horizons = std::fs::read_to_string(run.folder.join("horizons.csv")).unwrap();
    let used = |line: &str| line.split(',').nth(1).unwrap().to_string();
    for (tick, ([source, ..], line)) in recorded.iter().zip(horizons.lines().skip(1)).enumerate() {
        let expected = if source == "default" { "25" } else { "12" };
        assert_eq!(used(line), expected, "tick {tick}: {source}");
    }
    let count = |what: &str| recorded.iter().filter(|[source, ..]| source == what).count();
    assert_eq!(count("held"), 3, "{recorded:?}");
    assert_same_bytes_in_process(&run.folder);
    let summary = run.finish().summary;
    assert_eq!(summary["policy"]["held"], 3);
    assert_eq!(summary["policy"]["default_used"], count("default"));
    assert_eq!(summary["policy"]["answered"], count("policy"));
}
