//! `compare`: controllers over scenarios and seeds, in this process.

use super::length::metres;
use super::report::PAGE;
use crate::exit::{Ending, Failure, Outcome};
use crate::progress::Progress;
use crate::stdout;
use coordinator::record::folder::{RecordError, RunFolder};
use evaluation::compare::{
    Comparison, Contender, Contenders, Job, Plan, Run, Runs, by_family, by_run, expand, run_all,
};
use evaluation::page;
use evaluation::range::Numbers;
use shared::place;
use shared::stop::StopFlag;
use std::path::PathBuf;

/// Arguments of `compare`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh compare suite:quick
  ./run.sh compare ex14_d ring:16 --controllers safe:fixed:20 safe:random paper:fixed:20 orca orca-rh --seeds 20
  ./run.sh compare suite:all --controllers safe:each:10,20,30,49,random --seeds 5
  ./run.sh compare suite:quick --controllers safe 'safe[vodca.turn=0,aim.angle=0]'
  ./run.sh compare ex14_d --controllers paper:fixed:5,10,...,49 paper:random paper:policy:ex14 orca --start-jitter 0.2
  ./run.sh compare random-boxes:10000 --controllers safe:random
Scenarios: files, built-in names, families (box:16:3:0..9 is ten of them), suite:all (every built-in one), suite:quick,
random-boxes:COUNT (8 to 32 robots, each run with its own seed).
Controllers: PROFILE[KEY=VALUE,...]:HORIZON, or HORIZON alone for the safe profile; orca, orca:TAU, orca-rh.
HORIZON: fixed:20; fixed:5,10,...,49 is a row for each; each:10,20,30,49,random is a run with each, all in one row; random;
policy:NAME asks a policy at every tick (NAME: an ONNX file, a policies folder or the name of one in policies/).
What has nothing random in it runs once, whatever --seeds says; --start-jitter makes a seed mean other starts.
Ratio, ticks and time are medians over the runs that succeeded (interval: seeded bootstrap); separations count every run.
The folder holds runs.csv (a line per run), table.md, summary.json and report.html (charts for a browser).")]
pub struct Args {
    /// What to run: names, files, families, suites, random-boxes:COUNT
    #[arg(value_name = "SCENARIO|SUITE", default_value = "suite:quick")]
    scenarios: Vec<String>,
    /// PROFILE[KEY=VALUE,...]:HORIZON (safe:fixed:20, safe:random, paper:policy:NAME), orca, orca:TAU, orca-rh
    #[arg(long, num_args = 1.., value_name = "SPEC",
          default_values = ["safe:fixed:20", "safe:random", "paper:fixed:20", "orca", "orca-rh"])]
    controllers: Vec<Contenders>,
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
    /// The folder to write, new or empty; left out, a new one in runs/
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Runs the comparison, prints its table and writes every run as CSV.
pub fn run(args: Args) -> Ending {
    let mut entries = Vec::new();
    for spec in &args.scenarios {
        entries.extend(expand(spec).map_err(Failure::usage)?);
    }
    let plan = Plan {
        entries,
        contenders: args.controllers.into_iter().flat_map(|Contenders(all)| all).collect(),
        seeds: args.seed_list.map_or_else(|| (0..args.seeds).collect(), |list| list.0),
        start_jitter: args.start_jitter,
        sets: args.set,
        max_ticks: args.max_ticks,
    };
    let jobs = plan.jobs().map_err(Failure::usage)?;
    let stop = StopFlag::install().map_err(Failure::broken)?;
    place::sweep_leftovers(); // of comparisons with policies that were killed
    let folder = RunFolder::named(args.out.as_deref(), "compare").map_err(Failure::usage)?;
    let progress = Progress::of_work(jobs.len());
    let Runs { done, failure } = run_all(&jobs, &stop, || progress.advance());
    progress.finish();
    let planned = jobs.len();
    let (jobs, runs): (Vec<Job>, Vec<Run>) =
        jobs.into_iter().zip(done).filter_map(|(job, run)| Some((job, run?))).unzip();
    let comparison = Comparison::new(&plan, &jobs, &runs);
    let table = by_family(&comparison);
    // Whatever becomes of the terminal, the results are kept.
    folder.write("runs.csv", by_run(&plan, &jobs, &runs).csv().as_bytes()).map_err(Failure::broken)?;
    folder.write("table.md", table.markdown().as_bytes()).map_err(Failure::broken)?;
    write_summary(&folder, &comparison).map_err(Failure::broken)?;
    let page = page::compare(&comparison, &plan, &jobs, &runs);
    folder.write(PAGE, page.as_bytes()).map_err(Failure::broken)?;
    stdout::text(table.aligned())?;
    for line in verdicts(&plan, &jobs, &runs) {
        stdout::line(line)?;
    }
    stdout::line(format_args!(
        "{} runs, each a line of {}; charts: {}",
        runs.len(),
        folder.file("runs.csv").display(),
        folder.file(PAGE).display()
    ))?;
    if runs.len() < planned {
        let why = if failure.is_some() { "a policy failed" } else { "asked to stop" };
        stdout::line(format_args!(
            "{why}: {} of {planned} runs were not done, and nothing here counts them",
            planned - runs.len()
        ))?;
    }
    failure.map_or(Ok(Outcome::Done), |error| Err(Failure::broken(error)))
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

/// How many arrived and kept their distance with each controller, and which runs did not arrive.
fn verdicts(plan: &Plan, jobs: &[Job], runs: &[Run]) -> Vec<String> {
    const NAMED: usize = 3;
    let verdict = |(index, contender): (usize, &Contender)| {
        let all: Vec<(&Job, &Run)> = jobs.iter().zip(runs).filter(|(job, _)| job.contender == index).collect();
        let below = all.iter().filter(|(_, run)| run.summary.pairs_below_min_separation > 0).count();
        let late: Vec<&Job> =
            all.iter().filter(|(_, run)| run.summary.completion_time.is_none()).map(|(job, _)| *job).collect();
        let name = |job: &&Job| format!("{} (horizon {}, seed {})", job.scenario.name, job.horizon, job.scenario.seed);
        let named: Vec<String> = late.iter().take(NAMED).map(name).collect();
        let more = if late.len() > NAMED { format!(" and {} more", late.len() - NAMED) } else { String::new() };
        let which = if late.is_empty() { String::new() } else { format!("; not arrived: {}{more}", named.join(", ")) };
        format!("{contender}: {} of {} arrived, {below} below min_separation{which}", all.len() - late.len(), all.len())
    };
    plan.contenders.iter().enumerate().map(verdict).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
            out: Some(out.clone()),
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
}
