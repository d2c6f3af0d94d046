//! The published results: what `results/` keeps of runs, and the tables that documents show of it.
//!
//! Runs are seeded and repeat to the last bit, so a row per run is not kept: [`Medians`] hold what the tables need.

mod csv;
mod document;
mod faults;
mod medians;
mod paper;
mod parts;
mod policies;
mod suite;
mod training;

pub use document::{DOCUMENTS, filled};
pub use medians::{Medians, Row, Spread};
pub use parts::{Part, parts};

use crate::bench::{self, StoredError};
use std::io;
use std::path::{Path, PathBuf};

/// The folder of results, below the root of the repository.
pub const FOLDER: &str = "results";

/// Results cannot be read or shown.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// A file.
    #[error("cannot read {}: {source}; call this in the folder of the repository, or name that with --root", path.display())]
    Unreadable {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The benchmark's files.
    #[error(transparent)]
    Latency(#[from] StoredError),
    /// A file that holds something else.
    #[error("{}: {reason}; write it anew with ./run.sh results --measure PART", path.display())]
    Malformed {
        /// Its path.
        path: PathBuf,
        /// What is wrong, and where.
        reason: String,
    },
    /// A document asks for a table that does not exist.
    #[error("{document}: there is no table `{name}`; the tables are: {known}")]
    NoTable {
        /// The document.
        document: String,
        /// What it asks for.
        name: String,
        /// What there is.
        known: String,
    },
    /// A mark without its end.
    #[error("{document}: the mark of table `{name}` has no `<!-- /table: {name} -->` after it")]
    OpenMark {
        /// The document.
        document: String,
        /// The table.
        name: String,
    },
}

/// The name by which documents ask for a table, and its Markdown.
pub type NamedTable = (String, String);

/// All tables that `root/results` gives.
///
/// # Errors
/// A file that is missing or holds something else.
pub fn tables(root: &Path) -> Result<Vec<NamedTable>, ResultsError> {
    let mut tables = suite::tables(root)?;
    tables.push(("policies".into(), policies::table(root)?.markdown()));
    tables.extend(paper::tables(root)?);
    tables.extend(training::tables(root)?);
    tables.push(faults::table(root)?);
    tables.push(("latency".into(), latency(root)?));
    Ok(tables)
}

/// The tables of the benchmark, each below what it shows.
fn latency(root: &Path) -> Result<String, ResultsError> {
    let folder = root.join(FOLDER).join("latency");
    if !folder.join("rows.csv").is_file() {
        return Ok("Nothing is measured yet: `./run.sh bench all --out results/latency`.\n".into());
    }
    let section = |section: bench::Section| format!("{}\n\n{}", section.caption, section.table);
    Ok(bench::sections(&folder)?.into_iter().map(section).collect::<Vec<_>>().join("\n"))
}

fn read(path: &Path) -> Result<String, ResultsError> {
    std::fs::read_to_string(path).map_err(|source| ResultsError::Unreadable { path: path.to_owned(), source })
}

/// `value` with `digits` behind the point; `-` where there is none.
fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".into(), |value| format!("{value:.digits$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_show_what_the_results_say() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let tables = tables(&root).unwrap();
        for document in DOCUMENTS {
            let text = read(&root.join(document)).unwrap();
            assert!(filled(document, &text, &tables).unwrap() == text, "write {document} anew: ./run.sh results");
        }
    }
}
