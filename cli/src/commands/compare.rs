//! `compare`: controllers over scenarios and seeds, in this process.

use super::length::metres;
use super::report::PAGE;
use crate::exit::{Ending, Failure, Outcome};
use crate::progress::Progress;
use crate::stdout;
use coordinator::record::folder::{RecordError, RunFolder, new_file, write_new};
use evaluation::compare::{
    Comparison, ControllerSpecs, Counted, Experiment, Run, Sample, Tried, by_family, by_run, by_variant, expand,
    keep_best, run_all,
};
use evaluation::page;
use evaluation::range::Numbers;
use shared::runtime_dir;
use shared::stop::StopFlag;
use std::path::PathBuf;
use vodca::metrics::RunSummary;

/// Arguments of `compare`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh compare suite:quick
  ./run.sh compare ex14_d ring:16 --controllers safe:fixed:20 safe:random paper:fixed:20 orca-best orca-rh --seeds 20
  ./run.sh compare suite:all --controllers safe:each:10,20,30,49,random --seeds 5
  ./run.sh compare suite:quick --controllers safe 'safe[vodca.turn=0,aim.angle=0]'
  ./run.sh compare ex14_d --controllers paper:fixed:5,10,...,49 paper:random paper:policy:ex14 orca --start-jitter 0.2
  ./run.sh compare ex14_d --controllers paper:fixed:1..49 paper:random:0..59 --set vodca.rows=each --csv ex14_d.csv
  ./run.sh compare random-boxes:10000 --controllers safe:random
Scenarios: files, built-in names, families (box:16:3:0..9 is ten of them), suite:all (every built-in one), suite:quick,
random-boxes:COUNT (8 to 32 robots, each run with its own seed). Files and names that differ by a number at the end
only (mine_1.toml, mine_2.toml) are layouts of one family.
Controllers: PROFILE[KEY=VALUE,...]:HORIZON, or HORIZON alone for the safe profile; orca, orca:TAU, orca-rh, orca-best.
HORIZON: fixed:20; fixed:5,10,...,49 is a row for each; random; random:0..19 is a row for each sequence;
each:10,20,30,49,random is a run with each, all in one row; policy:NAME asks a policy at every tick (NAME: an ONNX file,
a policies folder or the name of one in policies/).
orca-best: ORCA with 16 settings (time horizon 1, 2, 5, 10 s x push 0.05, 0.3 m/s x aim 0, 0.35 rad) in every layout, of
which the best counts there: most successes, then shortest time, then shortest path.
What has nothing random in it runs once, whatever the seeds are; --start-jitter makes a seed mean other starts.
Ratio, ticks and time are medians over the runs that succeeded (interval: seeded bootstrap); separations count every run.
The folder holds runs.csv (a line per run that counts), variants.csv (what orca-best chose from), table.md, summary.json
and report.html (charts for a browser).")]
pub struct Args {
    /// What to run: names, files, families, suites, random-boxes:COUNT
    #[arg(value_name = "SCENARIO|SUITE", default_value = "suite:quick")]
    scenarios: Vec<String>,
    /// PROFILE[KEY=VALUE,...]:HORIZON (safe:fixed:20, safe:random, paper:policy:NAME), orca, orca:TAU, orca-rh, orca-best
    #[arg(long, num_args = 1.., value_name = "SPEC",
          default_values = ["safe:fixed:20", "safe:random", "paper:fixed:20", "orca", "orca-rh"])]
    pub(crate) controllers: Vec<ControllerSpecs>,
    /// Number of seeds, from 0, of whatever is random
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=100_000), conflicts_with = "seed_list")]
    seeds: u64,
    /// The seeds themselves: 0..9 (both ends included) or 3,7
    #[arg(long, value_name = "LIST")]
    seed_list: Option<Numbers>,
    /// Every start moves by a seeded draw of up to so many metres per axis
    #[arg(long, value_name = "METRES", default_value = "0", value_parser = metres)]
    start_jitter: f64,
    /// Change a parameter for all controllers (repeatable)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Last tick, instead of the scenarios'
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    max_ticks: Option<u64>,
    /// Solve every QP a second time with Clarabel and tell the largest difference of an input (exit code 1: they differ)
    #[arg(long)]
    check_solver: bool,
    /// The folder to write, new or empty; left out, a new one in runs/
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write no folder but the runs alone, as a new CSV
    #[arg(long, value_name = "FILE", conflicts_with = "out")]
    csv: Option<PathBuf>,
}

/// Where the results go.
enum RuntimeDir {
    /// Everything.
    Folder(RunFolder),
    /// The runs alone.
    Csv(PathBuf),
}

/// Runs the comparison, prints its table and writes every run as CSV.
pub fn run(args: Args) -> Ending {
    let mut entries = Vec::new();
    for spec in &args.scenarios {
        entries.extend(expand(spec).map_err(Failure::usage)?);
    }
    let experiment = Experiment {
        entries,
        controllers: args.controllers.into_iter().flat_map(|ControllerSpecs(all)| all).collect(),
        seeds: args.seed_list.map_or_else(|| (0..args.seeds).collect(), |list| list.0),
        start_jitter: args.start_jitter,
        sets: args.set,
        max_ticks: args.max_ticks,
        check_solver: args.check_solver,
    };
    let jobs = experiment.jobs().map_err(Failure::usage)?;
    let stop = StopFlag::install().map_err(Failure::broken)?;
    runtime_dir::sweep_leftovers(); // of comparisons with policies that were killed
    let place = match &args.csv {
        Some(file) => RuntimeDir::Csv(new_file(Some(file), "compare", "csv").map_err(Failure::usage)?),
        None => RuntimeDir::Folder(RunFolder::named(args.out.as_deref(), "compare").map_err(Failure::usage)?),
    };
    let progress = Progress::of_work(jobs.len());
    let results = run_all(&jobs, &stop, || progress.advance());
    progress.finish();
    let undone = results.done.iter().filter(|run| run.is_none()).count();
    let Counted { runs, tried } = keep_best(&experiment, &jobs, results.done);
    let comparison = Comparison::new(&experiment, &runs, &tried);
    // Whatever becomes of the terminal, the results are kept.
    write(&place, &experiment, &comparison, &runs, &tried).map_err(Failure::broken)?;
    stdout::text(by_family(&comparison).aligned())?;
    for line in verdicts(&experiment, &runs) {
        stdout::line(line)?;
    }
    stdout::line(match &place {
        RuntimeDir::Folder(folder) => format!(
            "{} runs, each a line of {}; charts: {}",
            runs.len(),
            folder.file(RUNS).display(),
            folder.file(PAGE).display()
        ),
        RuntimeDir::Csv(file) => format!("{} runs, each a line of {}", runs.len(), file.display()),
    })?;
    if undone > 0 {
        let why = if results.failure.is_some() { "a policy failed" } else { "asked to stop" };
        stdout::line(format_args!(
            "{why}: {undone} of {} runs were not done, and nothing here counts them",
            jobs.len()
        ))?;
    }
    if let Some(check) = comparison.solver_check {
        stdout::line(check)?;
    }
    match results.failure {
        Some(error) => Err(Failure::broken(error)),
        None if comparison.solver_check.is_none_or(|check| check.passed()) => Ok(Outcome::Done),
        None => Ok(Outcome::Failed),
    }
}

/// A line per run.
const RUNS: &str = "runs.csv";

fn write(
    place: &RuntimeDir,
    experiment: &Experiment,
    comparison: &Comparison,
    runs: &[Run],
    tried: &[Tried],
) -> Result<(), RecordError> {
    let lines = by_run(experiment, runs).csv();
    let folder = match place {
        RuntimeDir::Csv(file) => return write_new(file, lines.as_bytes()),
        RuntimeDir::Folder(folder) => folder,
    };
    folder.write(RUNS, lines.as_bytes())?;
    if !tried.is_empty() {
        folder.write("variants.csv", by_variant(experiment, tried).csv().as_bytes())?;
    }
    folder.write("table.md", by_family(comparison).markdown().as_bytes())?;
    write_summary(folder, comparison)?;
    folder.write(PAGE, page::compare(comparison, experiment, runs).as_bytes())
}

fn write_summary(folder: &RunFolder, comparison: &Comparison) -> Result<(), RecordError> {
    let name = "summary.json";
    let text = serde_json::to_string_pretty(comparison).map_err(|error| RecordError::Encode {
        path: folder.file(name),
        what: "the figures of the comparison",
        reason: error.to_string(),
    })?;
    folder.write(name, text.as_bytes())
}

/// For each SPEC of a controller, which may stand for several rows: how many runs succeeded and kept their distance,
/// which did not arrive, and, where there is one layout and the paths can be held against each other, the shortest path.
fn verdicts(experiment: &Experiment, runs: &[Run]) -> Vec<String> {
    const NAMED: usize = 3;
    let name = |run: &&Run| {
        let scenario = &run.job.scenario;
        format!("{} (horizon {}, seed {})", scenario.name, run.job.horizon, scenario.seed)
    };
    let given = |run: &Run| &experiment.controllers[run.job.controller].given;
    let mut specs: Vec<&String> = Vec::new();
    for controller in &experiment.controllers {
        if !specs.contains(&&controller.given) {
            specs.push(&controller.given);
        }
    }
    let verdict = |spec: &String| {
        let all: Vec<&Run> = runs.iter().filter(|run| given(run) == spec).collect();
        let count = |of: fn(&RunSummary) -> bool| all.iter().filter(|run| of(&run.summary)).count();
        let late: Vec<&Run> = all.iter().filter(|run| run.summary.completion_time.is_none()).copied().collect();
        let mut text = format!(
            "{spec}: {} of {} succeeded, {} collided, {} below min_separation",
            count(|run| run.success),
            all.len(),
            count(|run| run.collisions > 0),
            count(|run| run.pairs_below_min_separation > 0),
        );
        if experiment.entries.len() == 1 && all.len() > 1 {
            text += &paths(&all);
        }
        if !late.is_empty() {
            let named: Vec<String> = late.iter().take(NAMED).map(name).collect();
            let more = if late.len() > NAMED { format!(" and {} more", late.len() - NAMED) } else { String::new() };
            text += &format!("; not arrived: {}{more}", named.join(", "));
        }
        text
    };
    specs.into_iter().map(verdict).collect()
}

/// The shortest and the median path of the runs that succeeded, when any did.
fn paths(runs: &[&Run]) -> String {
    let good = || runs.iter().filter(|run| run.summary.success);
    let shortest = good().min_by(|a, b| a.summary.path_cost.total_cmp(&b.summary.path_cost));
    let median = Sample::of(good().map(|run| run.summary.path_cost)).middle();
    shortest.zip(median).map_or(String::new(), |(best, median)| {
        let (job, path) = (best.job, best.summary.path_cost);
        format!(
            "; path at best {path:.2} m (horizon {}, seed {}), median {median:.2} m",
            job.horizon, job.scenario.seed
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_comparison_leaves_its_runs_its_table_and_its_figures() {
        let place = tempfile::tempdir().unwrap();
        let out = place.path().join("compared");
        let args = Args {
            scenarios: vec!["two_setpoint".into(), "four_gate".into()],
            controllers: vec!["safe:fixed:20".parse().unwrap(), "safe:random".parse().unwrap()],
            seeds: 2,
            seed_list: None,
            start_jitter: 0.0,
            set: vec!["horizon.jitter=0".into()],
            max_ticks: None,
            check_solver: false,
            out: Some(out.clone()),
            csv: None,
        };
        assert_eq!(run(args).unwrap(), Outcome::Done);
        let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
        let csv = read("runs.csv");
        assert_eq!(csv.lines().count(), 1 + 2 * (1 + 2));
        assert!(csv.lines().skip(1).all(|line| line.contains(",true,true,")), "{csv}");
        assert_eq!(read("table.md").lines().count(), 2 + 2 * 2 + 2);
        let json: serde_json::Value = serde_json::from_str(&read("summary.json")).unwrap();
        assert_eq!((json["version"].as_u64(), json["totals"][1]["successes"].as_u64()), (Some(1), Some(4)));
        let ratio = &json["rows"][0]["ratio"];
        assert!(ratio["median"].as_f64().unwrap() < 1.05 && ratio["low"] == ratio["high"], "{ratio}");
    }

    /// Fixed horizons of a pair that goes apart, for three ticks.
    fn few_ticks(csv: &Path, check_solver: bool) -> Args {
        Args {
            scenarios: vec!["ring:2".into()],
            controllers: vec!["safe:fixed:10,20".parse().unwrap()],
            seeds: 5,
            seed_list: Some("0..2".parse().unwrap()),
            start_jitter: 0.0,
            set: vec![],
            max_ticks: Some(3),
            check_solver,
            out: None,
            csv: Some(csv.into()),
        }
    }

    #[test]
    fn the_runs_alone_are_a_line_per_horizon_and_seed_in_one_file() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("runs of a pair.csv");
        assert_eq!(run(few_ticks(&file, true)).unwrap(), Outcome::Done);
        let text = std::fs::read_to_string(&file).unwrap();
        assert_eq!(text.lines().count(), 1 + 2 * 3);
        assert!(text.lines().nth(1).unwrap().starts_with("ring:2,ring:2,2,safe:fixed:10,fixed:10,0,false,"), "{text}");
        assert_eq!(std::fs::read_dir(place.path()).unwrap().count(), 1, "no folder");
    }

    #[test]
    fn a_file_that_exists_is_refused_before_any_work() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("old.csv");
        std::fs::write(&file, "kept").unwrap();
        let Err(Failure::Usage(error)) = run(few_ticks(&file, false)) else { panic!("it is wrong usage") };
        assert!(error.to_string().contains("never written over"), "{error}");
        assert_eq!(std::fs::read(file).unwrap(), b"kept");
    }

    #[test]
    fn the_best_orca_leaves_what_it_chose_from() {
        let place = tempfile::tempdir().unwrap();
        let out = place.path().join("compared");
        let args = Args {
            scenarios: vec!["two_setpoint".into()],
            controllers: vec!["orca-best".parse().unwrap()],
            seeds: 2,
            seed_list: None,
            max_ticks: None,
            out: Some(out.clone()),
            csv: None,
            ..few_ticks(place.path(), false)
        };
        assert_eq!(run(args).unwrap(), Outcome::Done);
        let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
        assert_eq!((read("runs.csv").lines().count(), read("variants.csv").lines().count()), (1 + 2, 1 + 16));
        assert!(read("table.md").contains("| variant |") && read("table.md").contains("| best of 16: time_horizon="));
    }
}
