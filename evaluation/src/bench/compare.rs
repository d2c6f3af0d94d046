//! An earlier run beside this one.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// p50 of the rows of an earlier run, us.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Earlier(BTreeMap<String, f64>);

/// An earlier run cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// The file.
    #[error("cannot read {}: {source}; give the folder that an earlier `bench` wrote", path.display())]
    Unreadable {
        /// Its path.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Not such a file.
    #[error("{} has no rows of a benchmark; it should start with part,what,n,count,p50_us", path.display())]
    Malformed {
        /// Its path.
        path: PathBuf,
    },
}

impl Earlier {
    /// Reads `rows.csv` in `folder`.
    pub fn read(folder: &Path) -> Result<Self, CompareError> {
        let path = folder.join("rows.csv");
        let text =
            std::fs::read_to_string(&path).map_err(|source| CompareError::Unreadable { path: path.clone(), source })?;
        let mut lines = text.lines();
        if !lines.next().is_some_and(|header| header.starts_with("part,what,n,count,p50_us,")) {
            return Err(CompareError::Malformed { path });
        }
        let rows = lines.filter_map(|line| {
            let cells = cells(line);
            let p50 = cells.get(4)?.parse().ok().filter(|p50| *p50 > 0.0)?;
            Some((key(cells.first()?, cells.get(1)?, cells.get(2)?), p50))
        });
        Ok(Self(rows.collect()))
    }

    /// Whether there is nothing to compare with.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// p50 of that row, us.
    pub fn p50(&self, part: &str, name: &str, size: Option<usize>) -> Option<f64> {
        self.0.get(&key(part, name, &size.map_or(String::new(), |size| size.to_string()))).copied()
    }
}

fn key(part: &str, name: &str, size: &str) -> String {
    format!("{part}\n{name}\n{size}")
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
    use super::super::row::{Results, Row};
    use super::*;
    use coordinator::latency::Latency;

    #[test]
    fn a_run_that_was_written_is_found_row_by_row() {
        let place = tempfile::tempdir().unwrap();
        let mut latency = Latency::new();
        latency.record_ns(5_000);
        let mut results = Results::default();
        results.row(Row::new("hop", "a, busy", None, latency.clone()));
        results.row(Row::new("exchange", "peer", Some(14), latency));
        std::fs::write(place.path().join("rows.csv"), results.rows_table(None).csv()).unwrap();
        let earlier = Earlier::read(place.path()).unwrap();
        assert_eq!(earlier.p50("hop", "a, busy", None), Some(5.0));
        assert_eq!(earlier.p50("exchange", "peer", Some(14)), Some(5.0));
        assert_eq!(earlier.p50("exchange", "peer", Some(15)), None);
        let table = results.compared_table("hop", &earlier).csv();
        assert!(table.lines().nth(1).unwrap().ends_with(",1.00"), "{table}");
    }

    #[test]
    fn what_is_no_earlier_run_is_refused() {
        let place = tempfile::tempdir().unwrap();
        assert!(Earlier::read(place.path()).unwrap_err().to_string().contains("rows.csv"));
        std::fs::write(place.path().join("rows.csv"), "scenario,success\n").unwrap();
        assert!(Earlier::read(place.path()).unwrap_err().to_string().contains("no rows"));
    }
}
