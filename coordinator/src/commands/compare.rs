//! `compare`: controllers over scenarios and seeds, in this process.

use super::range::Numbers;
use crate::compare::{Contender, Plan, by_family, by_run};
use crate::exit::{Ending, Failure, Outcome};
use crate::parallel;
use crate::progress::Progress;
use crate::record::folder::{new_file, write_new};
use shared::scenario::suite;
use std::path::PathBuf;

/// Arguments of `compare`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh compare suite:quick
  ./run.sh compare ex14_d ring:16 --controllers safe:fixed:20 safe:random paper:fixed:20 orca orca-rh --seeds 20
  ./run.sh compare suite:all --controllers safe:fixed:10 safe:fixed:20 safe:random --seeds 3 --spread 0
Suites: suite:all (every built-in scenario), suite:quick. Ratio and time are medians over the runs that succeeded.")]
pub struct Args {
    /// Scenarios: files, built-in names, families or suites
    #[arg(value_name = "SCENARIO|SUITE", default_value = "suite:quick")]
    scenarios: Vec<String>,
    /// PROFILE:HORIZON (safe:fixed:20, safe:random, paper:fixed:20), orca, orca:TAU, orca-rh
    #[arg(long, num_args = 1.., value_name = "NAME",
          default_values = ["safe:fixed:20", "safe:random", "paper:fixed:20", "orca", "orca-rh"])]
    controllers: Vec<Contender>,
    /// Runs of each scenario and controller: a number of seeds from 0
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=100_000), conflicts_with = "seed_list")]
    seeds: u64,
    /// The seeds themselves: 0..9 (both ends included) or 3,7
    #[arg(long, value_name = "LIST")]
    seed_list: Option<Numbers>,
    /// Every start moves by a seeded draw of up to so many metres per axis
    #[arg(long, default_value_t = 0.05)]
    spread: f64,
    /// Change a parameter for all controllers (repeatable)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Last tick, instead of the scenarios'
    #[arg(long)]
    max_ticks: Option<u64>,
    /// The CSV to write, one line per run; left out, a new file in runs/
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Runs the comparison, prints its table and writes every run as CSV.
pub fn run(args: Args) -> Ending {
    let mut scenarios = Vec::new();
    for spec in &args.scenarios {
        scenarios.extend(suite::expand(spec).map_err(Failure::usage)?);
    }
    let plan = Plan {
        scenarios,
        contenders: args.controllers,
        seeds: args.seed_list.map_or_else(|| (0..args.seeds).collect(), |list| list.0),
        spread: args.spread,
        sets: args.set,
        max_ticks: args.max_ticks,
    };
    let jobs = plan.jobs().map_err(Failure::usage)?;
    let path = new_file(args.out.as_deref(), "compare", "csv").map_err(Failure::broken)?;
    let progress = Progress::of_work(jobs.len());
    let runs = parallel::map(&jobs, |job| job.run(), || progress.advance());
    progress.finish();
    print!("{}", by_family(&plan.contenders, &jobs, &runs).aligned());
    write_new(&path, by_run(&plan.contenders, &jobs, &runs).csv().as_bytes()).map_err(Failure::broken)?;
    println!("{} runs, each a line of {}", runs.len(), path.display());
    Ok(Outcome::Done)
}
