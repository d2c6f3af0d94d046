//! Promise: a new version that appears in a watched folder acts from between two ticks on, without a command.

use crate::{acted, actor, assert_same_bytes_in_process, policy_server};
use policy::contract::Contract;
use policy::digest::sha256;
use policy::folder::{MANIFEST_FILE, MODEL_FILE, PolicyFolder};
use policy::run_folder;
use std::fs;
use std::path::Path;
use tests::{ENDLESS, Robots, Run, wait_until};

/// Publishes as a script would that knows nothing of our programs: a whole version is renamed into `folder`,
/// then CURRENT is.
fn rename_in(folder: &Path, version: &str, model: &[u8], contract: &Contract) {
    let beside = folder.join("coming");
    fs::create_dir(&beside).unwrap();
    fs::write(beside.join(MODEL_FILE), model).unwrap();
    fs::write(beside.join(MANIFEST_FILE), contract.to_json()).unwrap();
    fs::rename(&beside, folder.join(version)).unwrap();
    fs::write(folder.join("CURRENT.new"), format!("{version}\n")).unwrap();
    fs::rename(folder.join("CURRENT.new"), folder.join("CURRENT")).unwrap();
}

#[test]
fn a_version_renamed_into_a_watched_folder_takes_over_between_two_ticks() {
    let place = tempfile::tempdir().unwrap();
    let source = PolicyFolder::new(place.path().join("policy"));
    let models = [12, 31, 7].map(|steps| actor(4, steps));
    source.publish(&models[0].0, &models[0].1, None).unwrap();
    policy_server();
    let arguments = format!("4 --policy {} --policy-poll 1 --real-time {ENDLESS}", source.root().display());
    let mut run = Run::start(Robots::Real, &format!("{arguments} --set model.sample_time=0.02 --set horizon.jitter=0"));
    run.wait_until_driving();

    let digests = models.each_ref().map(|(model, _)| sha256(model));
    let acts =
        |run: &Run, number: usize| acted(&run.folder).last().is_some_and(|[_, _, acting]| *acting == digests[number]);
    // The folder that was named on the command line is watched, and so is the run's own.
    rename_in(source.root(), "v000002", &models[1].0, &models[1].1);
    wait_until("the second version acts", || acts(&run, 1));
    let own = run_folder(&run.folder);
    // CURRENT may name what is not there yet: nothing happens until it is.
    fs::write(own.join("CURRENT"), "v000009\n").unwrap();
    let ticks = acted(&run.folder).len();
    wait_until("some ticks", || acted(&run.folder).len() > ticks + 10);
    assert!(acts(&run, 1), "a version that is not there changes nothing");
    rename_in(&own, "v000009", &models[2].0, &models[2].1);
    wait_until("the third version acts", || acts(&run, 2));

    run.signal("INT");
    run.wait();
    let recorded = acted(&run.folder);
    assert!(recorded.iter().all(|[source, ..]| source == "policy"), "no tick was without an answer");
    let mut order: Vec<&String> = recorded.iter().map(|[_, _, acting]| acting).collect();
    order.dedup();
    assert_eq!(order, digests.each_ref());
    let horizons = fs::read_to_string(run.folder.join("horizons.csv")).unwrap();
    for (tick, ([_, _, acting], line)) in recorded.iter().zip(horizons.lines().skip(1)).enumerate() {
        let steps = ["12", "31", "7"][digests.iter().position(|digest| digest == acting).unwrap()];
        assert!(line.split(',').skip(1).all(|used| used == steps), "tick {tick}: {line}");
    }
    assert_same_bytes_in_process(&run.folder);
    assert_eq!(run.finish().status.code(), Some(0));
}
