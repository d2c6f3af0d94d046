//! An earlier run beside this one.

use super::stored::{StoredError, StoredTable};
use std::collections::BTreeMap;
use std::path::Path;

/// p50 of the rows of an earlier run, us, by part, name and size.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Earlier(BTreeMap<(String, String, String), f64>);

impl Earlier {
    /// Reads `rows.csv` in `folder`.
    pub fn read(folder: &Path) -> Result<Self, StoredError> {
        let table = StoredTable::rows(folder)?;
        let rows = table.lines().filter_map(|line| {
            let p50 = line.number("p50_us").filter(|p50| *p50 > 0.0)?;
            Some((key(line.cell("part")?, line.cell("what")?, line.cell("n").unwrap_or_default()), p50))
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

fn key(part: &str, name: &str, size: &str) -> (String, String, String) {
    (part.into(), name.into(), size.into())
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
        std::fs::write(place.path().join("rows.csv"), results.rows_table().csv()).unwrap();
        let earlier = Earlier::read(place.path()).unwrap();
        assert_eq!(earlier.p50("hop", "a, busy", None), Some(5.0));
        assert_eq!(earlier.p50("exchange", "peer", Some(14)), Some(5.0));
        assert_eq!(earlier.p50("exchange", "peer", Some(15)), None);
        let table = results.part_table("hop", &earlier).csv();
        assert!(table.lines().nth(1).unwrap().ends_with(",1.00"), "{table}");
    }

    #[test]
    fn runs_of_earlier_versions_can_be_read() {
        let place = tempfile::tempdir().unwrap();
        let text = "part,what,n,count,p50_us,p90_us,p99_us,p999_us,max_us,floor_us,ratio\nhop,futex,,40,31.5,,,,,,\n";
        std::fs::write(place.path().join("rows.csv"), text).unwrap();
        assert_eq!(Earlier::read(place.path()).unwrap().p50("hop", "futex", None), Some(31.5));
    }
}
