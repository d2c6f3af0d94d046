//! Which command makes which file of `results/`: `results/parts.toml`.

use super::{FOLDER, ResultsError, read};
use serde::Deserialize;
use std::path::Path;

/// A file of results and how it is made.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Its name: the file below `results`, without `.csv`.
    pub name: String,
    /// What it shows.
    pub shows: String,
    /// Words of the command, `compare` or `evaluate` first, without `--out`.
    pub command: Vec<String>,
}

/// All parts, in the order of the file.
///
/// # Errors
/// The file is missing or holds something else.
pub fn parts(root: &Path) -> Result<Vec<Part>, ResultsError> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct File {
        part: Vec<Part>,
    }
    let path = root.join(FOLDER).join("parts.toml");
    let malformed = |error: toml::de::Error| ResultsError::Malformed { path: path.clone(), reason: error.to_string() };
    Ok(toml::from_str::<File>(&read(&path)?).map_err(malformed)?.part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_has_its_file() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for Part { name, .. } in parts(&root).unwrap() {
            assert!(root.join(FOLDER).join(format!("{name}.csv")).is_file(), "./run.sh results --measure {name}");
        }
    }
}
