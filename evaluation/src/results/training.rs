//! Tables of learning: the curves of the policies that ship, and the speed of an update.

use super::csv::{self, Csv};
use super::{FOLDER, NamedTable, ResultsError, number, read};
use crate::compare::Sample;
use crate::text_table::TextTable;
use std::path::Path;

/// The trainings whose curves are kept.
const NAMES: [&str; 4] = ["two_setpoint", "four_gate", "exchange_14", "ring_8"];

pub(super) fn tables(root: &Path) -> Result<[NamedTable; 2], ResultsError> {
    let folder = root.join(FOLDER).join("training");
    Ok([("training".into(), curves(&folder)?.markdown()), ("updates".into(), updates(&folder)?.markdown())])
}

fn curves(folder: &Path) -> Result<TextTable, ResultsError> {
    let header = ["training", "rounds", "updates", "minutes", "first evaluation", "best evaluation", "in round"];
    let mut table = TextTable::new(&header);
    for name in NAMES {
        let path = folder.join(format!("{name}.csv"));
        let malformed = |reason: String| ResultsError::Malformed { path: path.clone(), reason };
        let curve = Csv::parse(&read(&path)?).map_err(malformed)?;
        let numbers = |name: &str| column(&curve, name).map_err(malformed);
        let (success, way) = (numbers("evaluation/success")?, numbers("evaluation/path")?);
        let best_success = success.iter().flatten().copied().fold(0.0, f64::max);
        let evaluated: Vec<(usize, f64)> =
            way.iter().enumerate().filter_map(|(round, way)| Some((round, (*way)?))).collect();
        let best = evaluated.iter().filter(|(round, _)| success[*round] == Some(best_success));
        let best = best.min_by(|a, b| a.1.total_cmp(&b.1));
        let seconds: f64 = numbers("speed/round_seconds")?.iter().flatten().sum();
        let metres = |way: Option<f64>| number(way, 1) + " m";
        table.row([
            format!("`{name}`"),
            curve.lines().len().to_string(),
            number(numbers("updates")?.last().copied().flatten(), 0),
            number(Some(seconds / 60.0), 1),
            metres(evaluated.first().map(|(_, way)| *way)),
            metres(best.map(|(_, way)| *way)),
            best.map_or("-".into(), |(round, _)| round.to_string()),
        ]);
    }
    Ok(table)
}

fn updates(folder: &Path) -> Result<TextTable, ResultsError> {
    let path = folder.join("updates.csv");
    let malformed = |reason: String| ResultsError::Malformed { path: path.clone(), reason };
    let file = Csv::parse(&read(&path)?).map_err(malformed)?;
    let (program, rate) =
        (file.needed("program").map_err(malformed)?, column(&file, "updates_per_cpu_second").map_err(malformed)?);
    let mut table = TextTable::new(&["learner", "updates per CPU second, median", "range"]);
    for (name, title) in [("vodca", "ours"), ("pytorch", "PyTorch, CleanRL's form")] {
        let own = file.lines().iter().zip(&rate).filter(|(line, _)| line[program] == name);
        let own: Vec<f64> = own.filter_map(|(_, rate)| *rate).collect();
        let sample = Sample::of(own.iter().copied());
        let most = own.iter().copied().reduce(f64::max);
        table.row([
            title.into(),
            number(sample.middle(), 1),
            format!("{}..{}", number(sample.least(), 1), number(most, 1)),
        ]);
    }
    Ok(table)
}

fn column(file: &Csv, name: &str) -> Result<Vec<Option<f64>>, String> {
    let at = file.needed(name)?;
    file.lines().iter().map(|line| csv::number(&line[at])).collect()
}
