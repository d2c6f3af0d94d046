//! The log reads back with the Python packages that Foxglove publishes, as its viewers read it.

use crate::{coordinator, own, success};
use std::process::Command;

#[test]
fn the_log_reads_back_in_python() {
    let has = Command::new("python3").args(["-c", "import mcap, mcap_protobuf, lz4"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: python3 -m pip install mcap mcap-protobuf-support lz4");
        return;
    }
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    success(coordinator(&["run", "14", "--out", run.to_str().unwrap()]));
    let summary = std::fs::read_to_string(run.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let output = Command::new("python3")
        .arg(own("python/read_mcap.py"))
        .arg(run.join("run.mcap"))
        .args(["14", &summary["ticks"].to_string()])
        .output()
        .unwrap();
    assert_eq!(success(output).trim(), "the log reads back");
}
