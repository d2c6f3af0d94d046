//! Promise: what PyTorch exports loads, and answers as PyTorch does to 1e-5, on the embedded back-end
//! and, where the library is present, on ONNX Runtime.
//!
//! `tests/export_reference_actors.py` wrote the actors; it says with what.
#![allow(clippy::unwrap_used)] // a panic is how a test fails

mod common;

use common::prober;
use policy_server::actor::BackEnd;
use policy_server::check::Prober;
use std::path::{Path, PathBuf};
use std::process::Command;

fn actors() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/actors");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut actors: Vec<PathBuf> = files.filter(|file| file.extension().is_some_and(|kind| kind == "onnx")).collect();
    actors.sort();
    actors
}

fn all_answer_as_pytorch_does(prober: &Prober) {
    let actors = actors();
    assert!(actors.len() >= 10, "{actors:?}");
    for actor in actors {
        let (candidate, report) = prober.check(&actor, Some(3)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(report.reference_cases, 8, "{}", actor.display());
        assert_eq!(candidate.reference.unwrap().tolerance, 1e-5);
    }
}

#[test]
fn exports_of_both_exporters_answer_as_pytorch_does_on_the_embedded_back_end() {
    all_answer_as_pytorch_does(&prober());
}

#[test]
fn and_on_onnx_runtime_where_its_library_is_present() {
    let Some(library) = onnx_runtime() else {
        println!("no ONNX Runtime here (pip install onnxruntime): only the embedded back-end was tried");
        return;
    };
    all_answer_as_pytorch_does(&Prober { back_end: BackEnd::Library(library), ..prober() });
}

#[test]
fn without_its_sidecar_an_export_is_inferred_and_what_is_assumed_is_said() {
    let place = tempfile::tempdir().unwrap();
    for actor in actors() {
        let bare = place.path().join(actor.file_name().unwrap());
        std::fs::copy(&actor, &bare).unwrap();
        let (candidate, _) = prober().check(&bare, Some(3)).unwrap_or_else(|error| panic!("{error}"));
        let samples = !actor.to_string_lossy().contains("mean_only");
        assert_eq!(candidate.contract.outputs.log_std.is_some(), samples, "{}", actor.display());
        assert!(candidate.notes.iter().any(|note| note.contains("scale 1")), "{:?}", candidate.notes);
    }
}

#[test]
fn a_library_that_is_none_is_one_clear_error() {
    let prober = Prober { back_end: BackEnd::Library("/bin/sh".into()), ..prober() };
    let error = prober.check(&actors()[0], None).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("cannot use the ONNX Runtime library /bin/sh"), "{error}");
    assert!(error.contains("1.24 or later"), "{error}");
}

/// The library inside the Python package, if there is one.
fn onnx_runtime() -> Option<PathBuf> {
    let script = "import onnxruntime, os; print(os.path.join(os.path.dirname(onnxruntime.__file__), 'capi'))";
    let output = Command::new("python3").args(["-c", script]).output().ok().filter(|output| output.status.success())?;
    let folder = String::from_utf8(output.stdout).ok()?;
    let files = std::fs::read_dir(folder.trim()).ok()?.filter_map(|entry| Some(entry.ok()?.path()));
    files
        .filter(|file| file.file_name().is_some_and(|name| name.to_string_lossy().starts_with("libonnxruntime.so")))
        .max()
}
