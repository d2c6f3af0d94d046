//! The table of kills: what the death of a process cost the others.

use super::csv::{self, Csv};
use super::{FOLDER, NamedTable, ResultsError, read};
use crate::faults::{Cost, sums};
use std::path::Path;

pub(super) fn table(root: &Path) -> Result<NamedTable, ResultsError> {
    let path = root.join(FOLDER).join("faults").join("kills.csv");
    let malformed = |reason: String| ResultsError::Malformed { path: path.clone(), reason };
    let costs = Csv::parse(&read(&path)?).and_then(|kills| costs(&kills)).map_err(malformed)?;
    Ok(("kills".into(), sums(&costs).markdown()))
}

/// The kills of a file that `faults` wrote.
fn costs(kills: &Csv) -> Result<Vec<Cost>, String> {
    let columns =
        ["respawn", "other_deaths", "pairs_below", "min_separation", "missing", "shut_off", "left", "rejoin_ms"];
    let at = columns.iter().map(|name| kills.needed(name)).collect::<Result<Vec<_>, _>>()?;
    let cost = |line: &Vec<String>| -> Result<Cost, String> {
        let number = |column: usize| csv::number(&line[at[column]]);
        let count = |column: usize| number(column).map(|count| count.unwrap_or_default() as u64);
        Ok(Cost {
            respawn: line[at[0]] == "true",
            other_deaths: count(1)?,
            pairs_below: count(2)?,
            min_separation: number(3)?,
            missing: count(4)?,
            shut_off: count(5)?,
            left: count(6)?,
            rejoin_ms: number(7)?,
        })
    };
    kills.lines().iter().map(cost).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kills_are_counted_by_whether_the_robot_came_back() {
        let text = "respawn,other_deaths,pairs_below,min_separation,shut_off,missing,rejoin_ms,left\n\
            false,0,0,1.5,1,2,,0\ntrue,1,0,1.6,0,0,300,0\ntrue,0,0,1.7,0,0,200,3\n";
        let table = sums(&costs(&Csv::parse(text).unwrap()).unwrap()).markdown();
        let lines: Vec<&str> = table.lines().skip(2).collect();
        let expected = [
            "| none | 1 | 0 | 0 | 1.500000 | 2 | 1 | 0 | -, - |",
            "| once | 2 | 1 | 0 | 1.600000 | 0 | 0 | 3 | 300, 300 |",
        ];
        assert_eq!(lines, expected);
    }
}
