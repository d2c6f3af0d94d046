//! The fence around behaviour: seeded runs whose every byte is known by its digest. A change that moves no robot
//! differently leaves all of them alone.

use crate::{Finished, Robots, Run, root};
use policy::digest::sha256;
use serde::Deserialize;

/// The cases, below the repository's root.
const FILE: &str = "tests/golden/trajectories.toml";

/// What one run must do.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    /// After `./run.sh run`.
    arguments: String,
    /// The exit code.
    exit: i32,
    /// The digest of `trajectory.csv`.
    sha256: String,
}

#[derive(Deserialize)]
struct Cases {
    run: Vec<Case>,
}

impl Case {
    fn has_policy(&self) -> bool {
        self.arguments.split_whitespace().any(|word| word == "--policy")
    }

    /// Drives it; what it did instead, if it did something else.
    fn difference(&self) -> Option<String> {
        let Finished { status, stderr, trajectory, .. } = Run::start(Robots::Real, &self.arguments).finish();
        let (exit, digest) = (status.code().unwrap_or(-1), sha256(trajectory.as_bytes()));
        (exit != self.exit || digest != self.sha256).then(|| {
            let lines = trajectory.lines().count();
            format!(
                "[[run]]\narguments = {:?}\nexit = {exit}\nsha256 = \"{digest}\"\n# {lines} lines; was exit = {}, sha256 = \"{}\"\n{stderr}",
                self.arguments, self.exit, self.sha256
            )
        })
    }
}

/// Drives every case with a policy, or every one without.
///
/// # Panics
/// When a run differs; the message holds the entries as they would have to be.
pub fn hold(policies: bool) {
    let text = std::fs::read_to_string(root().join(FILE)).expect("the cases are there");
    let cases: Cases = toml::from_str(&text).expect("the cases are TOML");
    let chosen: Vec<&Case> = cases.run.iter().filter(|case| case.has_policy() == policies).collect();
    assert!(!chosen.is_empty(), "{FILE} has no such case");
    let differences: Vec<String> = chosen.iter().filter_map(|case| case.difference()).collect();
    assert!(
        differences.is_empty(),
        "{} of {} runs differ from {FILE}. If that is meant, these are their entries:\n\n{}",
        differences.len(),
        chosen.len(),
        differences.join("\n")
    );
}
