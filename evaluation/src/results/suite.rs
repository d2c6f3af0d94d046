//! Tables of the safe profile beside the others: the suite, its numbers to beat, disturbances and ablations.

use super::csv::Csv;
use super::medians::{ALL, Medians, Row};
use super::{FOLDER, NamedTable, ResultsError, number, read};
use crate::compare::Sample;
use crate::text_table::TextTable;
use std::path::Path;
use vodca::params::Params;
use vodca::scenario::Scenario;

/// Families of the short table.
const SHORT: [&str; 11] = [
    "two_setpoint",
    "four_gate",
    "ex14_a",
    "ex14_d",
    "antipodal16",
    "antipodal100",
    "rand16o0",
    "rand48o0",
    "rand16o3",
    "segregate4x4",
    ALL,
];
/// Who stands beside `safe`, and what the column is called.
const OTHERS: [(&str, &str); 4] =
    [("paper:fixed:20", "paper"), ("orca", "orca"), ("orca-best", "orca, best of 16"), ("orca-rh", "orca-rh")];
/// Rings whose numbers to beat were measured at fewer horizons.
const LARGE_RINGS: [&str; 2] = ["antipodal64", "antipodal100"];
const SAFE: &str = "safe:each:10,20,30,49,random";
const SAFE_LARGE: &str = "safe:each:20,random";

pub(super) fn tables(root: &Path) -> Result<Vec<NamedTable>, ResultsError> {
    let suite = |name: &str| Medians::load(&root.join(FOLDER).join("suite").join(format!("{name}.csv")));
    let quality = suite("quality")?;
    let families: Vec<&str> = quality.families().into_iter().chain([ALL]).collect();
    let mut tables = vec![
        ("summary".to_string(), beside(&quality, &SHORT, &["orca-best", "orca-rh"]).markdown()),
        ("suite".into(), beside(&quality, &families, &OTHERS.map(|(name, _)| name)).markdown()),
        ("targets".into(), targets(root, &quality, &suite("large_rings")?)?.markdown()),
    ];
    for name in ["tight", "walls"] {
        tables.push((name.into(), by_family(&suite(name)?).markdown()));
    }
    for name in ["robustness", "random", "ablations", "patience"] {
        tables.push((name.into(), totals(&suite(name)?).markdown()));
    }
    Ok(tables)
}

/// `safe` and `others`, a row per family.
fn beside(quality: &Medians, families: &[&str], others: &[&str]) -> TextTable {
    let columns: Vec<(&str, &str)> =
        [(SAFE, "safe")].into_iter().chain(OTHERS.into_iter().filter(|(name, _)| others.contains(name))).collect();
    let mut header = vec!["layouts".to_string()];
    header.extend(columns.iter().map(|(_, title)| format!("{title}: arrived, path, s, least m")));
    let mut table = TextTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for family in families {
        let cell =
            |(name, _): &(&str, &str)| quality.row(family, name).map_or("-".into(), |row| figures(row).join(", "));
        table.row([family.to_string()].into_iter().chain(columns.iter().map(cell)));
    }
    table
}

/// Arrivals, path over straight lines, seconds, least separation.
fn figures(row: &Row) -> [String; 4] {
    [
        format!("{}/{}", row.successes, row.runs),
        number(row.ratio().map(|ratio| ratio.median), 3),
        number(row.time().map(|time| time.median), 1),
        number(row.min_separation, 3),
    ]
}

/// A row per family, a column per controller, with the time of the slowest run.
fn by_family(medians: &Medians) -> TextTable {
    let controllers: Vec<&str> = medians.totals().map(|row| row.controller.as_str()).collect();
    let columns = controllers.iter().map(|name| format!("`{name}`: arrived, path, s, least m, slowest s"));
    let header: Vec<String> = std::iter::once("layouts".to_string()).chain(columns).collect();
    let mut table = TextTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for family in medians.families().into_iter().chain([ALL]) {
        let cell = |name: &&str| {
            medians.row(family, name).map_or("-".into(), |row| {
                let slowest = number(row.time().map(|time| time.most), 1);
                figures(row).into_iter().chain([slowest]).collect::<Vec<_>>().join(", ")
            })
        };
        table.row(std::iter::once(family.to_string()).chain(controllers.iter().map(cell)));
    }
    table
}

fn totals(medians: &Medians) -> TextTable {
    let header = ["controller", "arrived", "path / straight", "time s", "least separation m", "runs with a pair below"];
    let mut table = TextTable::new(&header);
    for row in medians.totals() {
        let ends = [row.runs_below.to_string()];
        table.row([format!("`{}`", row.controller)].into_iter().chain(figures(row)).chain(ends));
    }
    table
}

fn targets(root: &Path, quality: &Medians, large: &Medians) -> Result<TextTable, ResultsError> {
    let path = root.join(FOLDER).join("suite/targets.csv");
    let malformed = |reason: String| ResultsError::Malformed { path: path.clone(), reason };
    let csv = Csv::parse(&read(&path)?).map_err(malformed)?;
    let column = |name: &str| csv.needed(name).map_err(malformed);
    let family = column("family")?;
    let goals =
        [[column("reference_ratio")?, column("orca_rh_ratio")?], [column("reference_s")?, column("orca_rh_s")?]];
    let header = [
        "layouts",
        "path: reference",
        "ORCA-RH",
        "safe",
        "time s: reference",
        "ORCA-RH",
        "safe",
        "nobody is faster than",
    ];
    let mut table = TextTable::new(&header);
    for line in csv.lines() {
        let name = line[family].as_str();
        let row = if LARGE_RINGS.contains(&name) { large.row(name, SAFE_LARGE) } else { quality.row(name, SAFE) };
        let row = row.ok_or_else(|| malformed(format!("there are no runs of `{name}`")))?;
        let mut cells = vec![name.to_string()];
        for (wanted, (found, digits)) in goals.iter().zip([(row.ratio(), 3), (row.time(), 1)]) {
            let goals = wanted.map(|column| line[column].as_str());
            let found = number(found.map(|spread| spread.median), digits);
            let value = |text: &str| text.parse::<f64>().ok();
            let least = goals.iter().filter_map(|goal| value(goal)).reduce(f64::min);
            let above = value(&found).zip(least).is_some_and(|(found, least)| found > least);
            cells.extend(goals.map(|goal| if goal.is_empty() { "-".into() } else { goal.to_string() }));
            cells.push(found + if above { " (above)" } else { "" });
        }
        cells.push(number(fastest(name).map_err(malformed)?, 1));
        table.row(cells);
    }
    Ok(table)
}

/// Seconds until the last robot of a layout is at its set-point if all of them walk straight at full speed: the median
/// over the layouts of `family`.
fn fastest(family: &str) -> Result<Option<f64>, String> {
    let params = Params::safe();
    let stride = params.model.sample_time * params.model.max_speed;
    let is_own = |name: &&str| name.rsplit_once("_s").map_or(*name, |(family, _)| family) == family || *name == family;
    let mut times = Vec::new();
    for name in vodca::scenario::names().filter(is_own) {
        let scenario = Scenario::resolve(Some(name), None).map_err(|error| error.to_string())?;
        let ticks = scenario.robots.iter().map(|robot| {
            let way = robot.set_point - robot.start;
            (way.amax() * (1.0 - params.episode.arrival_tolerance / way.norm()) / stride).floor() + 1.0
        });
        times.push(ticks.fold(0.0, f64::max) * params.model.sample_time);
    }
    Ok(Sample::of(times).middle())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_crosses_twenty_metres_in_less_than_their_time_at_full_speed() {
        assert_eq!(fastest("two_setpoint").unwrap().map(|time| (time * 10.0).round() / 10.0), Some(13.4));
        assert!(fastest("rand8o3").unwrap() > Some(13.0));
        assert_eq!(fastest("nothing").unwrap(), None);
    }
}
