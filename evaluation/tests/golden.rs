//! Every golden file of the repository, in process.

use std::path::Path;

#[test]
fn every_golden_case_is_within_its_tolerance() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/golden");
    let verdicts = evaluation::golden::check_folder(&folder).unwrap();
    let bad: Vec<_> = verdicts.iter().filter(|verdict| verdict.deviation.is_some()).collect();
    assert!(verdicts.len() >= 101, "{} cases found", verdicts.len());
    assert!(bad.is_empty(), "{} of {} deviate:\n{bad:#?}", bad.len(), verdicts.len());
}

#[test]
fn a_changed_number_in_a_golden_file_is_found() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/golden");
    for (file, from, to) in [
        ("single_step.json", "-1.2", "-1.2001"),
        ("closed_loop.json", "\"bias\":0.35", "\"bias\":0.36"),
        ("safe_closed_loop.json", "\"theta\":0.35", "\"theta\":0.36"),
    ] {
        let text = std::fs::read_to_string(folder.join(file)).unwrap().replace(": ", ":");
        assert!(text.contains(from), "{file} holds no {from}");
        let changed = tempfile::tempdir().unwrap();
        std::fs::write(changed.path().join(file), text.replace(from, to)).unwrap();
        let verdicts = evaluation::golden::check_folder(changed.path()).unwrap();
        assert!(verdicts.iter().any(|verdict| verdict.deviation.is_some()), "{file} passes with {to}");
    }
}
