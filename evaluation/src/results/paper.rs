//! The paper's claims beside what the same rules give here.

use super::csv::Csv;
use super::medians::{Medians, Row, Spread};
use super::policies::GRID;
use super::{FOLDER, NamedTable, ResultsError, read};
use crate::text_table::TextTable;
use std::path::Path;

/// Horizons of a line of `results/paper/reference.csv`, written `5`, `10..49` or `random`.
fn is_of(row: &Row, horizons: &str) -> bool {
    let own = row.controller.rsplit("fixed:").next().unwrap_or_default();
    let number = |text: &str| text.parse::<u8>().ok();
    match (number(own), horizons.split_once("..")) {
        (Some(own), Some((from, to))) => number(from) <= Some(own) && Some(own) <= number(to),
        (Some(own), None) => number(horizons) == Some(own),
        (None, _) => row.controller.ends_with(horizons),
    }
}

pub(super) fn tables(root: &Path) -> Result<[NamedTable; 2], ResultsError> {
    let folder = root.join(FOLDER).join("paper");
    Ok([("paper".into(), claims(&folder)?.markdown()), ("symmetry".into(), symmetry(&folder)?.markdown())])
}

fn claims(folder: &Path) -> Result<TextTable, ResultsError> {
    let path = folder.join("reference.csv");
    let malformed = |reason: String| ResultsError::Malformed { path: path.clone(), reason };
    let csv = Csv::parse(&read(&path)?).map_err(malformed)?;
    let column = |name: &str| csv.needed(name).map_err(malformed);
    let (task, horizons, reference) = (column("task")?, column("horizons")?, column("reference")?);
    let mut table = TextTable::new(&["task", "horizons", "reference", "here"]);
    for line in csv.lines() {
        let medians = Medians::load(&folder.join(format!("{}.csv", line[task])))?;
        let rows: Vec<&Row> = medians.rows().iter().filter(|row| is_of(row, &line[horizons])).collect();
        table.row([line[task].clone(), line[horizons].clone(), line[reference].clone(), here(&rows)]);
    }
    Ok(table)
}

/// What became of all `rows` together: how many runs completed, their path and ticks, the best fixed horizon.
fn here(rows: &[&Row]) -> String {
    let runs: usize = rows.iter().map(|row| row.runs).sum();
    let complete = format!("{} of {runs} complete", rows.iter().map(|row| row.successes).sum::<usize>());
    let range = |figure: fn(&Row) -> Option<Spread>| {
        let all: Vec<Spread> = rows.iter().filter_map(|row| figure(row)).collect();
        let least = all.iter().map(|spread| spread.least).reduce(f64::min)?;
        Some((least, all.iter().map(|spread| spread.most).reduce(f64::max)?))
    };
    let (Some((short, long)), Some((quick, slow))) = (range(Row::path), range(Row::ticks)) else { return complete };
    let path = |row: &&&Row| row.path().map_or(f64::INFINITY, |path| path.median);
    let more = match rows {
        [row] if row.runs > 1 => row.path().map(|path| format!("; median {:.1} m", path.median)),
        [_] => None,
        _ => rows
            .iter()
            .min_by(|a, b| path(a).total_cmp(&path(b)))
            .and_then(|row| row.controller.rsplit(':').next())
            .map(|best| format!("; best FH{best}")),
    };
    let path = between([format!("{short:.1}"), format!("{long:.1}")]);
    let ticks = between([format!("{quick:.0}"), format!("{slow:.0}")]);
    format!("{complete}, {path} m, {ticks} ticks{}", more.unwrap_or_default())
}

fn between([from, to]: [String; 2]) -> String {
    if from == to { from } else { format!("{from}..{to}") }
}

/// Fourteen robots with 1e-9 m of measuring noise: what each fixed horizon gives over seeds.
fn symmetry(folder: &Path) -> Result<TextTable, ResultsError> {
    let medians = Medians::load(&folder.join("ex14_d_noise.csv"))?;
    let mut table = TextTable::new(&["fixed horizon", "complete", "path, median m", "path, range m"]);
    for steps in GRID {
        for row in medians.rows().iter().filter(|row| is_of(row, &steps.to_string())) {
            let path = |text: fn(Spread) -> String| row.path().map_or("-".into(), text);
            table.row([
                steps.to_string(),
                format!("{}/{}", row.successes, row.runs),
                path(|path| format!("{:.0}", path.median)),
                path(|path| format!("{:.0}..{:.0}", path.least, path.most)),
            ]);
        }
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn horizons_of_a_line_are_told_apart() {
        let text = "family,controller,success,ticks,time_s,path_m,ratio,min_separation_m,pairs_below\n\
            t,paper:fixed:5,true,10,2,20,1,1,0\nt,paper:fixed:15,false,350,,20,1,1,0\nt,paper:fixed:20,true,11,2,19,1,1,0\n\
            t,paper:random,true,12,2,18,1,1,0\nt,paper:random,true,14,2,22,1,1,0\n";
        let medians = Medians::of_runs(text).unwrap();
        let text = |horizons| here(&medians.rows().iter().filter(|row| is_of(row, horizons)).collect::<Vec<_>>());
        assert_eq!(text("5"), "1 of 1 complete, 20.0 m, 10 ticks");
        assert_eq!(text("5..49"), "2 of 3 complete, 19.0..20.0 m, 10..11 ticks; best FH20");
        assert_eq!(text("random"), "2 of 2 complete, 18.0..22.0 m, 12..14 ticks; median 20.0 m");
        assert_eq!(text("15"), "0 of 1 complete");
    }
}
