//! Promise: the policy server's death never ends the run; horizons are held, then the default is used,
//! and a server started again joins in.

use crate::{acted, actor, assert_same_bytes_in_process, policy_server};
use policy::folder::PolicyFolder;
use policy::run_folder;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use tests::{Robots, Run, wait_until};
use vodca::random::{self, Use};

/// Starts another server for the run in `folder`, as its user would by hand.
fn restart(folder: &Path) -> Child {
    Command::new(policy_server())
        .args(["serve", "--run"])
        .arg(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// The process that serves the run in `folder`.
fn server_of(folder: &Path) -> u32 {
    PolicyFolder::new(run_folder(folder)).read_status().unwrap().unwrap().pid
}

#[test]
fn a_server_killed_at_any_tick_and_started_again_does_not_keep_the_run_from_arriving() {
    /// Ticks from which the moment of the kill is drawn; the team needs about twice as many.
    const KILLED_WITHIN: u64 = 180;
    policy_server();
    let runs = [1, 2, 3].map(|seed| {
        std::thread::spawn(move || {
            let tick = random::below(&mut random::stream(seed, Use::Policy, 0, 0), KILLED_WITHIN) as usize;
            survive_a_kill_at(tick);
            tick
        })
    });
    println!("killed at ticks {:?}", runs.map(|run| run.join().unwrap()));
}

fn survive_a_kill_at(tick: usize) {
    let place = tempfile::tempdir().unwrap();
    let source = PolicyFolder::new(place.path().join("policy"));
    let (model, contract) = actor(14, 20);
    source.publish(&model, &contract, None).unwrap();
    let arguments = format!(
        "14 --policy {} --policy-hold 3 --policy-default 25 --real-time --set model.sample_time=0.05 --max-ticks 1000",
        source.root().display()
    );
    let mut run = Run::start(Robots::Real, &arguments);
    wait_until("the tick of the kill", || acted(&run.folder).len() >= tick.max(1));
    tests::signal(server_of(&run.folder), "KILL");
    // A quick successor would be there before the next question: nobody would have missed the dead one.
    let bridged = || acted(&run.folder).last().is_some_and(|[source, ..]| source != "policy");
    wait_until("its absence is bridged", bridged);
    let mut successor = restart(&run.folder);
    run.wait();
    wait_until("the successor ends with the run", || successor.try_wait().unwrap().is_some());
    let recorded = acted(&run.folder);
    assert_same_bytes_in_process(&run.folder);
    let finished = run.finish();
    assert_eq!(finished.status.code(), Some(0), "killed at tick {tick}: {finished:?}");
    assert_eq!(finished.summary["end"], "arrived");
    assert_eq!(finished.summary["ticks"], recorded.len(), "every tick says who acted");
    let without: Vec<usize> = (0..recorded.len()).filter(|&at| recorded[at][0] != "policy").collect();
    let (first, last) = (*without.first().unwrap(), *without.last().unwrap());
    assert!((tick.saturating_sub(1)..tick + 40).contains(&first), "killed at tick {tick}: bridged from {first}");
    assert_eq!(without.len(), last + 1 - first, "one gap: {without:?}");
    assert!(last + 1 < recorded.len(), "the successor acts at the end");
}

#[test]
fn a_killed_server_is_bridged_and_its_successor_joins_in() {
    let place = tempfile::tempdir().unwrap();
    let source = PolicyFolder::new(place.path().join("policy"));
    let (model, contract) = actor(14, 12);
    source.publish(&model, &contract, None).unwrap();
    policy_server();
    let arguments = format!(
        "14 --policy {} --policy-hold 3 --policy-default 25 --real-time --set model.sample_time=0.05 --set horizon.jitter=0 --max-ticks 200",
        source.root().display()
    );
    let mut run = Run::start(Robots::Real, &arguments);
    run.wait_until_driving();
    tests::signal(server_of(&run.folder), "KILL");
    let last = |run: &Run| acted(&run.folder).last().map(|[source, ..]| source.clone());
    wait_until("the default is used", || last(&run).as_deref() == Some("default"));
    let mut successor = restart(&run.folder);
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
