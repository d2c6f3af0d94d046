//! The tables of a benchmark, read back from the folder it wrote.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// How the header of `rows.csv` begins, in every version.
const ROWS: &str = "part,what,n,count,p50_us,";

/// The folder of a benchmark cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum StoredError {
    /// The file.
    #[error("cannot read {}: {source}; give the folder that an earlier `bench` wrote", path.display())]
    Unreadable {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Not such a file.
    #[error("{} has no rows of a benchmark; it should start with part,what,n,count,p50_us", path.display())]
    Malformed {
        /// Its path.
        path: PathBuf,
    },
}

/// A table whose cells are found by the names of their columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct StoredTable {
    columns: BTreeMap<String, usize>,
    lines: Vec<Vec<String>>,
}

/// A line of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    columns: &'a BTreeMap<String, usize>,
    cells: &'a [String],
}

impl StoredTable {
    /// `rows.csv` in `folder`.
    pub(super) fn rows(folder: &Path) -> Result<Self, StoredError> {
        let path = folder.join("rows.csv");
        let text =
            std::fs::read_to_string(&path).map_err(|source| StoredError::Unreadable { path: path.clone(), source })?;
        if text.starts_with(ROWS) { Ok(Self::parse(&text)) } else { Err(StoredError::Malformed { path }) }
    }

    /// A table of `folder` that need not be there; then it is empty.
    pub(super) fn perhaps(folder: &Path, name: &str) -> Result<Self, StoredError> {
        let path = folder.join(name);
        match std::fs::read_to_string(&path) {
            Ok(text) => Ok(Self::parse(&text)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Self::default()),
            Err(source) => Err(StoredError::Unreadable { path, source }),
        }
    }

    fn parse(text: &str) -> Self {
        let mut lines = text.lines().map(cells);
        let columns = lines.next().unwrap_or_default().into_iter().zip(0..).collect();
        Self { columns, lines: lines.collect() }
    }

    /// Its lines, in order.
    pub(super) fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        self.lines.iter().map(|cells| Line { columns: &self.columns, cells })
    }
}

impl<'a> Line<'a> {
    /// The cell in that column; `None` when it is empty or there is no such column.
    pub(super) fn cell(self, column: &str) -> Option<&'a str> {
        let cell = self.cells.get(*self.columns.get(column)?)?;
        (!cell.is_empty()).then_some(cell.as_str())
    }

    /// The number in that column.
    pub(super) fn number(self, column: &str) -> Option<f64> {
        self.cell(column)?.parse().ok()
    }
}

/// The cells of a line; commas between quotes belong to a cell.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for character in line.chars() {
        match character {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            other => {
                if let Some(cell) = cells.last_mut() {
                    cell.push(other);
                }
            }
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_found_by_column_and_empty_ones_are_none() {
        let table = StoredTable::parse("part,what,p99_us\nhop,\"a, busy\",\nhop,b,2.5\n");
        let lines: Vec<Line<'_>> = table.lines().collect();
        assert_eq!((lines[0].cell("what"), lines[0].number("p99_us")), (Some("a, busy"), None));
        assert_eq!((lines[1].number("p99_us"), lines[1].cell("ratio")), (Some(2.5), None));
    }

    #[test]
    fn only_the_rows_must_be_there() {
        let place = tempfile::tempdir().unwrap();
        assert!(StoredTable::rows(place.path()).unwrap_err().to_string().contains("rows.csv"));
        assert_eq!(StoredTable::perhaps(place.path(), "peers.csv").unwrap().lines().count(), 0);
        std::fs::write(place.path().join("rows.csv"), "scenario,success\n").unwrap();
        assert!(StoredTable::rows(place.path()).unwrap_err().to_string().contains("no rows"));
    }
}
