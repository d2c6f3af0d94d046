//! Promise: versions are swapped while fourteen robots drive; bad ones never act, no tick is late, the
//! record tells the version of every tick.

use crate::{acted, actor, assert_same_bytes_in_process, policy_server};
use policy::digest::sha256;
use policy::folder::PolicyFolder;
use policy::run_folder;
use tests::{Finished, Robots, Run};

const ROBOTS: usize = 14;
const TICKS: usize = 350;
/// Ticks between two swaps.
const EVERY: usize = 5;

fn start(policy: &PolicyFolder) -> Run {
    policy_server();
    let arguments = format!(
        "{ROBOTS} --policy {} --policy-poll 1 --policy-wait 1000 --real-time --set model.sample_time=0.05 --set horizon.jitter=0 --max-ticks {TICKS}",
        policy.root().display()
    );
    Run::start(Robots::Real, &arguments)
}

#[test]
fn swaps_every_five_ticks_are_recorded_and_delay_nobody() {
    let place = tempfile::tempdir().unwrap();
    let source = PolicyFolder::new(place.path().join("policy"));
    let (short, long) = (actor(ROBOTS, 12), actor(ROBOTS, 31));
    source.publish(&short.0, &short.1, None).unwrap();

    let quiet = start(&source).finish();

    let mut run = start(&source);
    run.wait_until_driving();
    let folder = PolicyFolder::new(run_folder(&run.folder));
    let mut not_finite = long.0.clone();
    let bias = not_finite.len() - 300; // within the last stored tensors
    not_finite[bias..bias + 16].fill(0xff);
    let wrong_team = actor(3, 20);
    let versions =
        [&long, &(long.0[..500].to_vec(), long.1.clone()), &short, &(not_finite, long.1.clone()), &wrong_team];
    for (number, (model, contract)) in versions.iter().cycle().enumerate() {
        let begun = (number + 1) * EVERY;
        if begun >= TICKS || !reached(&run, begun) {
            break;
        }
        folder.publish(model, contract, None).unwrap();
    }
    let driven = run.folder.clone();
    let status = folder.read_status().unwrap().unwrap();
    let recorded = wait_for_record(&mut run);
    assert_same_bytes_in_process(&driven);
    let swapped = run.finish();

    check_versions(&recorded, [(sha256(&short.0), 12), (sha256(&long.0), 31)]);
    assert!(status.rejected.len() >= 3, "{status:?}");
    for (name, finished) in [("without swaps", &quiet), ("with swaps", &swapped)] {
        assert_eq!(finished.summary["policy"]["late"], 0, "{name}: {}", finished.stderr);
        assert_eq!(finished.summary["policy"]["answered"], finished.summary["ticks"], "{name}");
        println!("{name}: {}, {}", finished.summary["policy"]["round_trip"], late_ticks(finished));
    }
}

/// Waits until tick `tick` has begun; `false`: the run ended before.
fn reached(run: &Run, tick: usize) -> bool {
    let mut ended = false;
    tests::wait_until("the next swap", || {
        ended = run.folder.join("summary.json").exists();
        ended || acted(&run.folder).len() >= tick
    });
    !ended
}

type Recorded = Vec<([String; 3], String)>;

/// Version and horizons of every tick.
fn wait_for_record(run: &mut Run) -> Recorded {
    run.wait();
    let horizons = std::fs::read_to_string(run.folder.join("horizons.csv")).unwrap();
    acted(&run.folder).into_iter().zip(horizons.lines().skip(1).map(String::from)).collect()
}

fn check_versions(recorded: &Recorded, models: [(String, usize); 2]) {
    let mut switches = 0;
    let mut before = "";
    for (tick, ([source, _, digest], horizons)) in recorded.iter().enumerate() {
        assert_eq!(source, "policy", "tick {tick}");
        let steps = models.iter().find(|(known, _)| known == digest).map(|(_, steps)| steps.to_string());
        let steps = steps.unwrap_or_else(|| panic!("tick {tick}: {digest} was never good"));
        let all = horizons.split(',').skip(1).all(|horizon| horizon == steps);
        assert!(all, "tick {tick}: {digest} chooses {steps}, the robots used {horizons}");
        switches += usize::from(digest != before);
        before = digest;
    }
    assert!(switches >= 5, "only {switches} switches in {} ticks", recorded.len());
}

/// What the run says of ticks that began late.
fn late_ticks(finished: &Finished) -> String {
    let line = finished.stdout.lines().find(|line| line.starts_with("real time"));
    line.unwrap_or("no tick began late").to_string()
}
