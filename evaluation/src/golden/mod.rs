//! Reference cases from an independent implementation: single steps and closed loops.
//!
//! A folder may hold any number of files of the formats `vodca-golden-single-step-1`,
//! `vodca-golden-closed-loop-1` and `vodca-golden-safe-loop-1`; every `*.json` in it is checked.

pub mod closed_loop;
pub mod single_step;
pub mod switches;

use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Why golden files cannot be checked.
#[derive(Debug, thiserror::Error)]
pub enum GoldenError {
    /// The folder or a file cannot be read.
    #[error("cannot read {path}: {source}; name a folder of golden *.json files")]
    Unreadable {
        /// What was read.
        path: PathBuf,
        /// Why it failed.
        source: std::io::Error,
    },
    /// The folder has no golden files.
    #[error("{0} holds no *.json files; name a folder of golden files, for example tests/golden")]
    Empty(PathBuf),
    /// A file is not of a known format.
    #[error("{path}: {what}; known formats: {KNOWN}")]
    Format {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
}

const SINGLE_STEP: &str = "vodca-golden-single-step-1";
const CLOSED_LOOP: &str = "vodca-golden-closed-loop-1";
const SAFE_LOOP: &str = "vodca-golden-safe-loop-1";
const KNOWN: &str = "vodca-golden-single-step-1, vodca-golden-closed-loop-1, vodca-golden-safe-loop-1";

/// Where a case deviates from its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// First tick that deviates (0 in single steps).
    pub tick: usize,
    /// The robot.
    pub robot: usize,
    /// What deviates.
    pub what: &'static str,
    /// By how much.
    pub deviation: f64,
    /// How much is allowed.
    pub allowed: f64,
}

/// The verdict on one case.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// File and case name.
    pub case: String,
    /// `None`: within tolerance on all ticks.
    pub deviation: Option<Deviation>,
}

/// Checks every golden file in `folder`, files by name, cases in their order.
pub fn check_folder(folder: &Path) -> Result<Vec<Verdict>, GoldenError> {
    let unreadable = |source| GoldenError::Unreadable { path: folder.to_owned(), source };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|extension| extension == "json") {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(GoldenError::Empty(folder.to_owned()));
    }
    let mut verdicts = Vec::new();
    for file in &files {
        verdicts.extend(check_file(file)?);
    }
    Ok(verdicts)
}

/// Checks one golden file.
pub fn check_file(path: &Path) -> Result<Vec<Verdict>, GoldenError> {
    let wrong = |what: String| GoldenError::Format { path: path.to_owned(), what };
    let text =
        std::fs::read_to_string(path).map_err(|source| GoldenError::Unreadable { path: path.to_owned(), source })?;
    let document: Value = serde_json::from_str(&text).map_err(|error| wrong(format!("not JSON: {error}")))?;
    let tolerance = document["tolerance"].as_f64().ok_or_else(|| wrong("`tolerance` is missing".into()))?;
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let verdict = |name: &str, deviation| Verdict { case: format!("{file}:{name}"), deviation };
    match document["format"].as_str() {
        Some(SINGLE_STEP) => {
            let cases: Vec<single_step::Case> = cases(&document).map_err(wrong)?;
            cases.iter().map(|c| Ok(verdict(&c.name, c.check(tolerance).map_err(wrong)?))).collect()
        }
        Some(CLOSED_LOOP | SAFE_LOOP) => {
            let cases: Vec<closed_loop::Case> = cases(&document).map_err(wrong)?;
            cases.iter().map(|c| Ok(verdict(&c.name, c.check(tolerance).map_err(wrong)?))).collect()
        }
        other => Err(wrong(format!("format {other:?} is not known"))),
    }
}

fn cases<T: DeserializeOwned>(document: &Value) -> Result<Vec<T>, String> {
    let list = document["cases"].as_array().ok_or("`cases` is missing or no list")?;
    let parse = |(index, case): (usize, &Value)| {
        let name = case["name"].as_str().unwrap_or("unnamed");
        T::deserialize(case).map_err(|error| format!("case {index} ({name}): {error}"))
    };
    list.iter().enumerate().map(parse).collect()
}
