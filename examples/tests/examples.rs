//! Every example does what it says, and is short enough to read.
#![allow(clippy::unwrap_used)] // a panic is how a test fails

use std::path::Path;
use std::process::Command;
use tests::{Robots, Run, wait_until};

fn run(program: &str, arguments: &[&str]) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let output = Command::new(program).args(arguments).current_dir(root).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn one_tick_of_one_robot_gives_its_input_and_its_plan() {
    let text = run(env!("CARGO_BIN_EXE_one_tick"), &[]);
    assert!(text.contains("plan    20 steps") && text.contains("by ClosedForm with 0 collision rows"), "{text}");
}

#[test]
fn a_team_in_one_process_arrives_and_keeps_its_separation() {
    let text = run(env!("CARGO_BIN_EXE_team_in_one_process"), &[]);
    assert!(text.contains("arrived     all after") && text.contains("separation  1.5"), "{text}");
}

#[test]
fn the_others_arrive_around_a_controller_of_ones_own() {
    let text = run(env!("CARGO_BIN_EXE_own_controller"), &[]);
    assert_eq!(text.matches("0.00 m from its set-point").count(), 4, "{text}");
}

#[test]
fn horizons_of_ones_own_drive_a_team() {
    let text = run(env!("CARGO_BIN_EXE_own_horizons"), &[]);
    assert!(text.starts_with("Ok(Over) after"), "{text}");
}

#[test]
fn a_policy_drives_a_team_in_this_process() {
    let text = run(env!("CARGO_BIN_EXE_drive_with_policy"), &["policies/two_setpoint"]);
    assert!(text.starts_with("Ok(Over) after 87 ticks, 44.48 m"), "{text}");
}

#[test]
fn environments_are_played_on_all_cores() {
    let text = run(env!("CARGO_BIN_EXE_environments"), &["two_setpoint", "4", "100"]);
    assert!(text.starts_with("episodes ended   4\n"), "{text}");
}

#[test]
fn a_body_of_ones_own_drives_in_a_run_of_processes() {
    let by_hand = Run::start(Robots::Real, "2 --by-hand");
    let commands = |run: &Run| -> Vec<Vec<String>> {
        let printed = run.printed();
        let lines = printed.lines().filter(|line| line.contains(" --robot "));
        lines.map(|line| line.split_whitespace().skip(1).map(String::from).collect()).collect()
    };
    wait_until("the commands are printed", || commands(&by_hand).len() == 2);
    let programs = [Path::new(env!("CARGO_BIN_EXE_own_body")).to_owned(), tests::program("agent")];
    let start = |(program, arguments): (&std::path::PathBuf, Vec<String>)| {
        Command::new(program).args(arguments).spawn().unwrap()
    };
    let mut robots: Vec<_> = programs.iter().zip(commands(&by_hand)).map(start).collect();
    let finished = by_hand.finish();
    assert_eq!(finished.status.code(), Some(0), "{finished:?}");
    assert!(robots.iter_mut().all(|robot| robot.wait().unwrap().success()));
    // Odometry that never errs is the simulated body.
    assert!(finished.trajectory == Run::start(Robots::Real, "2").finish().trajectory);
}

#[test]
fn every_example_has_fewer_than_sixty_lines() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut examples = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "rs") {
            let lines = std::fs::read_to_string(&path).unwrap().lines().count();
            assert!(lines < 60, "{} has {lines} lines", path.display());
            examples += 1;
        }
    }
    assert_eq!(examples, 7);
}
