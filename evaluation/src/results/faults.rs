//! The table of kills: what the death of a process cost the others.

use super::csv::{self, Csv};
use super::{FOLDER, NamedTable, ResultsError, number, read};
use crate::text_table::TextTable;
use std::path::Path;

/// What the run after the kill is called in the file, and here.
const KINDS: [(&str, &str); 2] = [("false", "none"), ("true", "once")];

pub(super) fn table(root: &Path) -> Result<NamedTable, ResultsError> {
    let path = root.join(FOLDER).join("faults").join("kills.csv");
    let malformed = |reason: String| ResultsError::Malformed { path: path.clone(), reason };
    let table = Csv::parse(&read(&path)?).and_then(|kills| kinds(&kills)).map_err(malformed)?;
    Ok(("kills".into(), table.markdown()))
}

fn kinds(kills: &Csv) -> Result<TextTable, String> {
    let mut table = TextTable::new(&[
        "restart",
        "runs",
        "other deaths",
        "pairs below",
        "least m",
        "living robots late",
        "set-points closed by the body",
        "files left",
        "rejoin p50, most (ms)",
    ]);
    let restarted = kills.needed("respawn")?;
    for (kind, title) in KINDS {
        let lines: Vec<&Vec<String>> = kills.lines().iter().filter(|line| line[restarted] == kind).collect();
        let column = |name: &str| -> Result<Vec<f64>, String> {
            let at = kills.needed(name)?;
            let numbers = lines.iter().map(|line| csv::number(&line[at]));
            Ok(numbers.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
        };
        let sum = |name: &str| column(name).map(|numbers| number(Some(numbers.iter().sum()), 0));
        let mut rejoin = column("rejoin_ms")?;
        rejoin.sort_by(f64::total_cmp);
        let [middle, most] = [rejoin.get(rejoin.len() / 2), rejoin.last()].map(|time| number(time.copied(), 0));
        table.row([
            title.into(),
            lines.len().to_string(),
            sum("other_deaths")?,
            sum("pairs_below")?,
            number(column("min_separation")?.into_iter().reduce(f64::min), 6),
            sum("missing")?,
            sum("shut_off")?,
            sum("left")?,
            format!("{middle}, {most}"),
        ]);
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kills_are_counted_by_whether_the_robot_came_back() {
        let text = "respawn,other_deaths,pairs_below,min_separation,shut_off,missing,rejoin_ms,left\n\
            false,0,0,1.5,1,2,,0\ntrue,1,0,1.6,0,0,300,0\ntrue,0,0,1.7,0,0,200,3\n";
        let table = kinds(&Csv::parse(text).unwrap()).unwrap().markdown();
        let lines: Vec<&str> = table.lines().skip(2).collect();
        assert_eq!(
            lines,
            [
                "| none | 1 | 0 | 0 | 1.500000 | 2 | 1 | 0 | -, - |",
                "| once | 2 | 1 | 0 | 1.600000 | 0 | 0 | 3 | 300, 300 |"
            ]
        );
    }
}
