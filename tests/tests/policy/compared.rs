//! Promise: a policy in a comparison gives what it gives in a run, on any number of cores, and leaves nothing.

use crate::{actor, policy_server};
use policy::folder::PolicyFolder;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use tests::{Robots, Run, assert_nothing_left, program, wait_until};

/// An actor in a folder of its own.
fn published(place: &Path, robots: usize, steps: usize) -> PathBuf {
    policy_server();
    let folder = place.join(format!("policies/for{robots}"));
    let (model, contract) = actor(robots, steps);
    PolicyFolder::new(&folder).publish(&model, &contract, None).unwrap();
    folder
}

fn compare(place: &Path, out: &str, cores: &str, arguments: &str) -> Child {
    Command::new(program("vodca"))
        .current_dir(place)
        .env("RAYON_NUM_THREADS", cores)
        .arg("compare")
        .args(arguments.split_whitespace())
        .args(["--out", out])
        .stdout(File::create(place.join(format!("{out}.stdout"))).unwrap())
        .stderr(Stdio::inherit())
        .spawn()
        .unwrap()
}

/// The lines of `runs.csv` without the two times at their end.
fn runs(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("runs.csv")).unwrap();
    text.lines().skip(1).map(|line| line.rsplitn(3, ',').last().unwrap().to_string()).collect()
}

#[test]
fn a_policy_gives_in_a_comparison_what_it_gives_in_a_run() {
    let place = tempfile::tempdir().unwrap();
    let policy = published(place.path(), 4, 12);
    let path = policy.display();
    let ran = Run::start(Robots::Real, &format!("4 --policy {path} --profile safe --max-ticks 200")).finish();
    // By its path and by its name, with other contenders, on one core and on three.
    let arguments = format!(
        "four_gate --controllers safe:policy:{path} policy:for4 fixed:5,10,...,25 --seed-list 0,1 --max-ticks 200"
    );
    for (out, cores) in [("one", "1"), ("three", "3")] {
        let mut child = compare(place.path(), out, cores, &arguments);
        assert_eq!(child.wait().unwrap().code(), Some(0));
        assert_nothing_left(child.id(), &place.path().join(out));
    }
    let compared = runs(&place.path().join("one"));
    assert_eq!(compared, runs(&place.path().join("three")));
    assert_eq!(compared.len(), 2 * (2 + 5));
    let fields: Vec<&str> = compared[0].split(',').collect();
    assert_eq!(fields[5], ran.summary["seed"].as_u64().unwrap_or(0).to_string());
    assert_eq!(fields[10], ran.summary["path_cost"].to_string(), "the path of the run of processes");
    assert_eq!(fields[15], ran.summary["activations"].to_string());
}

#[test]
fn an_interrupted_comparison_keeps_what_it_has_and_ends_its_servers() {
    let place = tempfile::tempdir().unwrap();
    let path = published(place.path(), 14, 30);
    let arguments = format!("ex14_d --controllers safe:policy:{} --seeds 100000", path.display());
    let mut child = compare(place.path(), "cut", "2", &arguments);
    let mut servers = 0;
    wait_until("servers of its own", || {
        servers = tests::shared_files(child.id()).iter().filter(|path| path.starts_with("/tmp")).count();
        servers >= 1
    });
    std::thread::sleep(std::time::Duration::from_secs(3)); // some runs are done by then, or none: both must end well
    tests::signal(child.id(), "INT");
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_nothing_left(child.id(), &place.path().join("cut"));
    let done = runs(&place.path().join("cut")).len();
    let said = fs::read_to_string(place.path().join("cut.stdout")).unwrap();
    let line = format!("asked to stop: {} of 100000 runs were not done", 100_000 - done);
    assert!(said.contains(&line), "{said}");
    assert!(place.path().join("cut/report.html").exists() && place.path().join("cut/summary.json").exists());
}
