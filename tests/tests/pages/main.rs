//! What people look at, opened by the programs they open it with: pages in a browser, logs in Python.
//! Tests that need a program that is not there say so and pass; `.ci/run` installs what is missing.

mod browser;
mod python;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A file of this package.
fn own(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Runs the coordinator to its end.
fn coordinator(arguments: &[&str]) -> Output {
    Command::new(tests::program("vodca")).args(arguments).output().expect("the coordinator starts")
}

/// Standard output, or everything it said as a failure.
fn success(output: Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{}\n{}", text(&output.stdout), text(&output.stderr));
    text(&output.stdout)
}
