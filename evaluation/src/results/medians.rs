//! What is kept of many runs: a row per family of layouts and controller, and a row per controller over all of them.

use super::csv::{Csv, number};
use super::{ResultsError, read};
use crate::compare::Sample;
use crate::text_table::TextTable;
use std::path::Path;

/// The family of rows over all layouts.
pub(super) const ALL: &str = "all";
/// Figures of which the spread over successful runs is kept, where the runs have them.
const FIGURES: [&str; 4] = ["ratio", "ticks", "time_s", "path_m"];
/// More than any table shows, so that nothing is rounded twice.
const DIGITS: usize = 6;

/// Median, least and most of a figure over the runs that succeeded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The smallest.
    pub least: f64,
    /// The largest.
    pub most: f64,
}

/// Runs of one controller in one family of layouts.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Family of layouts, or `all`; of `evaluate` the largest move of starts, m.
    pub family: String,
    /// The controller; of `evaluate` where horizons came from.
    pub controller: String,
    /// How many runs.
    pub runs: usize,
    /// How many arrived without collision.
    pub successes: usize,
    /// Spread of each of [`FIGURES`]; `None` where no run succeeded, or runs do not have it.
    figures: [Option<Spread>; FIGURES.len()],
    /// Smallest separation over all runs, m.
    pub min_separation: Option<f64>,
    /// Runs in which a pair came nearer than `model.min_separation`; 0 where that was not counted.
    pub runs_below: usize,
}

impl Row {
    /// Path over straight lines, successful runs.
    pub fn ratio(&self) -> Option<Spread> {
        self.figures[0]
    }

    /// Ticks, successful runs.
    pub fn ticks(&self) -> Option<Spread> {
        self.figures[1]
    }

    /// Time of the last arrival, s, successful runs.
    pub fn time(&self) -> Option<Spread> {
        self.figures[2]
    }

    /// Path of all robots, m, successful runs.
    pub fn path(&self) -> Option<Spread> {
        self.figures[3]
    }
}

/// Rows of a file of results.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Medians(Vec<Row>);

/// One run, as a line of a CSV file tells it.
struct Run<'a> {
    family: &'a str,
    controller: &'a str,
    success: bool,
    figures: [Option<f64>; FIGURES.len()],
    min_separation: Option<f64>,
    below: bool,
}

impl Medians {
    /// Of the `runs.csv` of `compare` or the CSV file of `evaluate`.
    ///
    /// # Errors
    /// The text is neither; says where.
    pub fn of_runs(text: &str) -> Result<Self, String> {
        let csv = Csv::parse(text)?;
        let family = csv.column("family").map_or_else(|| csv.needed("jitter_start_m"), Ok)?;
        let controller = csv.column("controller").map_or_else(|| csv.needed("horizons"), Ok)?;
        let (success, separation) = (csv.needed("success")?, csv.needed("min_separation_m")?);
        let (below, figures) = (csv.column("pairs_below"), FIGURES.map(|name| csv.column(name)));
        let run = |line: &'_ Vec<String>| -> Result<_, String> {
            let mut values = [None; FIGURES.len()];
            for (value, column) in values.iter_mut().zip(figures) {
                *value = column.map_or(Ok(None), |column| number(&line[column]))?;
            }
            Ok((line[success] == "true", values, number(&line[separation])?, below.is_some_and(|at| line[at] != "0")))
        };
        let mut runs = Vec::new();
        for line in csv.lines() {
            let (success, figures, min_separation, below) = run(line)?;
            let (family, controller) = (line[family].as_str(), line[controller].as_str());
            runs.push(Run { family, controller, success, figures, min_separation, below });
        }
        Ok(Self(grouped(&runs)))
    }

    /// The rows stored at `path`.
    ///
    /// # Errors
    /// The file is missing or holds something else.
    pub fn load(path: &Path) -> Result<Self, ResultsError> {
        let malformed = |reason| ResultsError::Malformed { path: path.to_owned(), reason };
        Self::parse(&read(path)?).map_err(malformed)
    }

    fn parse(text: &str) -> Result<Self, String> {
        let csv = Csv::parse(text)?;
        let column = |name: &str| csv.needed(name);
        let [family, controller] = ["family", "controller"].map(column);
        let [runs, successes, below] = ["runs", "successes", "runs_below"].map(column);
        let (family, controller, separation) = (family?, controller?, column("min_separation_m")?);
        let (runs, successes, below) = (runs?, successes?, below?);
        let count = |cell: &str| cell.parse::<usize>().map_err(|_| format!("`{cell}` is not a number of runs"));
        let mut rows = Vec::new();
        for line in csv.lines() {
            let mut figures = [None; FIGURES.len()];
            for (figure, name) in figures.iter_mut().zip(FIGURES) {
                let cell = |suffix: &str| number(&line[csv.needed(&format!("{name}{suffix}"))?]);
                *figure = match (cell("")?, cell("_least")?, cell("_most")?) {
                    (Some(median), Some(least), Some(most)) => Some(Spread { median, least, most }),
                    _ => None,
                };
            }
            rows.push(Row {
                family: line[family].clone(),
                controller: line[controller].clone(),
                runs: count(&line[runs])?,
                successes: count(&line[successes])?,
                figures,
                min_separation: number(&line[separation])?,
                runs_below: count(&line[below])?,
            });
        }
        Ok(Self(rows))
    }

    /// The rows as the CSV text that [`Self::load`] reads.
    pub fn csv(&self) -> String {
        let mut header = vec!["family", "controller", "runs", "successes"];
        let names: Vec<String> =
            FIGURES.iter().flat_map(|name| ["", "_least", "_most"].map(|end| format!("{name}{end}"))).collect();
        header.extend(names.iter().map(String::as_str));
        header.extend(["min_separation_m", "runs_below"]);
        let mut table = TextTable::new(&header);
        for row in &self.0 {
            let text = |value: Option<f64>| value.map_or_else(String::new, shortest);
            let spread = |figure: &Option<Spread>| {
                let [median, least, most] = [|s: Spread| s.median, |s: Spread| s.least, |s: Spread| s.most];
                [text(figure.map(median)), text(figure.map(least)), text(figure.map(most))]
            };
            let counts = [row.runs, row.successes].map(|count| count.to_string());
            let ends = [text(row.min_separation), row.runs_below.to_string()];
            let cells = [row.family.clone(), row.controller.clone()].into_iter().chain(counts);
            table.row(cells.chain(row.figures.iter().flat_map(spread)).chain(ends));
        }
        table.csv()
    }

    /// All rows.
    pub fn rows(&self) -> &[Row] {
        &self.0
    }

    /// The row of a controller in a family.
    pub fn row(&self, family: &str, controller: &str) -> Option<&Row> {
        self.0.iter().find(|row| row.family == family && row.controller == controller)
    }

    /// The rows over all layouts; of a single family its own.
    pub fn totals(&self) -> impl Iterator<Item = &Row> {
        let single = self.0.iter().all(|row| row.family != ALL);
        self.0.iter().filter(move |row| single || row.family == ALL)
    }

    /// The families in their order, `ALL` excepted.
    pub fn families(&self) -> Vec<&str> {
        distinct(self.0.iter().map(|row| row.family.as_str()).filter(|family| *family != ALL))
    }
}

/// Without zeros that say nothing.
fn shortest(value: f64) -> String {
    let text = format!("{value:.DIGITS$}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found = Vec::new();
    for name in names {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}

fn grouped(runs: &[Run<'_>]) -> Vec<Row> {
    let families = distinct(runs.iter().map(|run| run.family));
    let controllers = distinct(runs.iter().map(|run| run.controller));
    let total = (families.len() > 1).then_some(ALL);
    let mut rows = Vec::new();
    for family in families.iter().copied().chain(total) {
        for &controller in &controllers {
            let own = |run: &&Run<'_>| run.controller == controller && (family == ALL || run.family == family);
            let own: Vec<&Run<'_>> = runs.iter().filter(own).collect();
            if !own.is_empty() {
                rows.push(row(family, controller, &own));
            }
        }
    }
    rows
}

fn row(family: &str, controller: &str, runs: &[&Run<'_>]) -> Row {
    let good = || runs.iter().filter(|run| run.success);
    let spread = |index: usize| {
        let sample = Sample::of(good().filter_map(|run| run.figures[index]));
        let most = good().filter_map(|run| run.figures[index]).reduce(f64::max)?;
        Some(Spread { median: sample.middle()?, least: sample.least()?, most })
    };
    Row {
        family: family.into(),
        controller: controller.into(),
        runs: runs.len(),
        successes: good().count(),
        figures: std::array::from_fn(spread),
        min_separation: runs.iter().filter_map(|run| run.min_separation).reduce(f64::min),
        runs_below: runs.iter().filter(|run| run.below).count(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUNS: &str = "family,controller,success,ticks,time_s,path_m,ratio,min_separation_m,pairs_below\n\
        ring,safe,true,10,2,20,1.0,1.5,0\nring,safe,true,12,2.4,24,1.2,1.4,3\nbox,safe,false,350,,90,4.5,0.5,1\n";

    #[test]
    fn figures_are_of_runs_that_succeeded_and_separations_of_all() {
        let medians = Medians::of_runs(RUNS).unwrap();
        let ring = medians.row("ring", "safe").unwrap();
        assert_eq!((ring.runs, ring.successes, ring.runs_below, ring.min_separation), (2, 2, 1, Some(1.4)));
        assert_eq!(ring.ratio(), Some(Spread { median: 1.1, least: 1.0, most: 1.2 }));
        let all = medians.row(ALL, "safe").unwrap();
        assert_eq!((all.runs, all.successes, all.min_separation), (3, 2, Some(0.5)));
        assert_eq!(medians.row("box", "safe").unwrap().ratio(), None);
    }

    #[test]
    fn what_is_stored_is_read_back() {
        let medians = Medians::of_runs(RUNS).unwrap();
        assert_eq!(Medians::parse(&medians.csv()), Ok(medians));
    }

    #[test]
    fn another_file_is_answered_with_the_column_it_lacks() {
        assert_eq!(Medians::of_runs("a,b\n1,2\n"), Err("there is no column `jitter_start_m`".into()));
    }
}
