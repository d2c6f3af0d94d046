//! `bench policy` measures a policy through its server. What the times are is not asked here.

use std::process::Command;

#[test]
fn inference_and_the_way_from_observation_to_horizons_are_measured() {
    super::policy_server();
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("bench");
    let output = Command::new(tests::program("vodca"))
        .args(["bench", "policy", "--quick", "--robots", "2,3", "--out"])
        .arg(&out)
        .output()
        .expect("the coordinator starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let rows = std::fs::read_to_string(out.join("rows.csv")).unwrap();
    for robots in [2, 3] {
        for what in ["inference, embedded", "observation to horizons, embedded"] {
            assert!(rows.contains(&format!("policy,\"{what}\",{robots},")), "{what}, {robots} robots\n{rows}");
        }
    }
    let figures = std::fs::read_to_string(out.join("figures.csv")).unwrap();
    for what in ["start of the back-end", "loading", "first inference"] {
        assert!(figures.contains(what), "{what}\n{figures}");
    }
}

#[test]
fn a_library_that_is_none_is_named() {
    super::policy_server();
    let home = tempfile::tempdir().unwrap();
    let output = Command::new(tests::program("vodca"))
        .args(["bench", "policy", "--quick", "--onnxruntime", "/nowhere/libonnxruntime.so", "--out"])
        .arg(home.path().join("bench"))
        .output()
        .expect("the coordinator starts");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(message.contains("could not be measured") && message.contains("/nowhere/libonnxruntime.so"), "{message}");
}
