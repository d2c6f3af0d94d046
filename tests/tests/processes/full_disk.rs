//! Promise: a run whose record takes nothing more ends with one clear error, leaves what it wrote readable, and
//! nothing else behind.

use std::process::Command;
use tests::{ENDLESS, assert_nothing_left, program, wait_until};

/// Largest file, blocks of 512 bytes: the exchange's shared files are smaller, the record grows beyond it.
const BLOCKS: u64 = 16_384;

#[test]
fn a_file_that_cannot_grow_ends_the_run_with_one_error_and_a_readable_record() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    // The limit stands for a full disk, which only root could make; the signal that comes with it does not.
    let script = format!("trap '' XFSZ; ulimit -f {BLOCKS}; exec \"$0\" run 14 {ENDLESS} --out \"$1\"");
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .arg(program("vodca"))
        .arg(&folder)
        .stdout(std::process::Stdio::null())
        .stderr(std::fs::File::create(place.path().join("stderr")).unwrap())
        .spawn()
        .unwrap();
    let mut status = None;
    wait_until("the record is full", || {
        status = child.try_wait().unwrap();
        status.is_some()
    });
    let said = std::fs::read_to_string(place.path().join("stderr")).unwrap();
    assert_eq!(status.unwrap().code(), Some(1), "{said}");
    assert_nothing_left(child.id(), &folder);
    let errors: Vec<&str> = said.lines().filter(|line| line.starts_with("error: ")).collect();
    assert!(errors.len() == 1 && errors[0].contains("cannot write") && errors[0].contains("stays readable"), "{said}");
    let trajectory = std::fs::read_to_string(folder.join("trajectory.csv")).unwrap();
    assert!(trajectory.ends_with('\n') && trajectory.len() as u64 <= 512 * BLOCKS);
    let columns = trajectory.lines().next().unwrap().split(',').count();
    assert!(trajectory.lines().all(|line| line.split(',').count() == columns), "whole rows only");
    assert!(!folder.join("summary.json").exists(), "a run that was cut has none");
    let report = Command::new(program("vodca")).arg("report").arg(&folder).output().unwrap();
    assert!(report.status.success(), "{report:?}");
}
