//! No dependency is compiled twice: every program asks for the same features of it as all tests do.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// The dependencies of `selection` with their features, a line each.
fn dependencies(selection: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--prefix", "none", "--format", "{p} {f}"])
        .args(selection)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
        .output()
        .expect("cargo is there");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let own = |line: &str| line.contains(" (/"); // crates of this repository
    text.lines().map(|line| line.trim_end_matches(" (*)").to_string()).filter(|line| !own(line)).collect()
}

#[test]
fn every_program_is_built_from_the_dependencies_of_the_tests() {
    let all = dependencies(&["--workspace", "--edges", "normal,build,dev"]);
    assert!(all.len() > 100, "only {} dependencies were found: the scan is broken", all.len());
    for packages in [&["cli", "agent"][..], &["policy-server"], &["learner"]] {
        let mut selection = vec!["--edges", "normal,build"];
        packages.iter().for_each(|package| selection.extend(["--package", package]));
        let other: Vec<String> = dependencies(&selection).difference(&all).cloned().collect();
        assert!(
            other.is_empty(),
            "{packages:?} asks for other features than the tests; add what is missing to features/Cargo.toml:\n{}",
            other.join("\n")
        );
    }
}

/// Name and version of every package in a lock file.
fn locked(file: &str) -> BTreeSet<(String, String)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file);
    let text = std::fs::read_to_string(path).expect("a lock file");
    let value = |block: &str, key: &str| {
        let line = block.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(" = "));
        line.map_or_else(String::new, |value| value.trim_matches('"').to_string())
    };
    text.split("[[package]]").skip(1).map(|block| (value(block, "name"), value(block, "version"))).collect()
}

#[test]
fn the_python_package_has_the_versions_of_the_programs() {
    let next = "copy Cargo.lock to python/ and run `cargo metadata` there: it adds what only the package needs";
    let (all, package) = (locked("Cargo.lock"), locked("python/Cargo.lock"));
    let names: BTreeSet<&String> = all.iter().map(|(name, _)| name).collect();
    let other: Vec<_> = package.difference(&all).filter(|(name, _)| names.contains(name)).collect();
    assert!(package.len() > 100 && other.is_empty(), "{other:?} are not those of Cargo.lock; {next}");
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--depth", "0", "--manifest-path", "python/Cargo.toml"])
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
        .output()
        .expect("cargo is there");
    assert!(output.status.success(), "{}; {next}", String::from_utf8_lossy(&output.stderr));
}
