//! `sweep`: one scenario with many horizons or seeds, in this process.

use crate::exit::{Ending, Failure, Outcome};
use crate::progress::Progress;
use crate::stdout;
use coordinator::record::folder::{new_file, write_new};
use coordinator::solver_check::SolverCheck;
use evaluation::in_process::{run_checked, run_whole};
use evaluation::parallel;
use evaluation::range::{Numbers, NumbersError};
use evaluation::text_table::TextTable;
use std::path::PathBuf;
use std::str::FromStr;
use vodca::horizon::{Horizon, HorizonError};
use vodca::horizon_source::{HorizonSource, HorizonSourceError, HorizonSpec};
use vodca::metrics::RunSummary;
use vodca::params::{Params, Profile};
use vodca::scenario::{Scenario, set_up};

/// Arguments of `sweep`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh sweep --scenario ex14_d --horizons 1..49 --profile paper --set vodca.rows=each
  ./run.sh sweep --scenario two_setpoint --horizons 5,10,20,49 --profile paper
  ./run.sh sweep --scenario four_gate --horizons random:0..19 --profile paper
  ./run.sh sweep --scenario rand8o3_s0 --horizons 20 --seeds 0..9")]
pub struct Args {
    /// Scenario: file, built-in name or family
    #[arg(long)]
    scenario: String,
    /// Fixed horizons (1..49 or 5,10,20), or random ones by seed (random:0..19); both ends included
    #[arg(long, default_value = "1..49")]
    horizons: Horizons,
    /// Seeds of the run (jitter), instead of the scenario's own: 0..9, both ends included
    #[arg(long)]
    seeds: Option<Numbers>,
    /// Parameter set: safe, paper, orca or orca-rh
    #[arg(long, default_value = "safe")]
    profile: Profile,
    /// Change a parameter (repeatable)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Last tick, instead of the scenario's
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    max_ticks: Option<u64>,
    /// Solve every QP a second time with Clarabel and tell the largest difference of an input
    #[arg(long)]
    check_solver: bool,
    /// The CSV to write, a new file; left out, a new file in runs/
    #[arg(long)]
    out: Option<PathBuf>,
}

/// `1..49`, `5,10,20` or `random:0..19`.
#[derive(Clone, Debug)]
struct Horizons(Vec<HorizonSpec>);

/// Not such a list. Each kind names its own forms.
#[derive(Debug, thiserror::Error)]
enum HorizonsError {
    /// Of the numbers.
    #[error(transparent)]
    Numbers(#[from] NumbersError),
    /// A horizon out of range.
    #[error(
        "--horizons {list}: {source}; write fixed horizons as 1..49 or 5,10,20 (both ends included), or seeds of random \
         ones as random:0..19"
    )]
    Range {
        /// As given.
        list: String,
        /// Which one, and what is allowed.
        source: HorizonError,
    },
    /// Another source.
    #[error(transparent)]
    Source(#[from] HorizonSourceError),
}

impl FromStr for Horizons {
    type Err = HorizonsError;

    fn from_str(text: &str) -> Result<Self, HorizonsError> {
        let (kind, list) = text.split_once(':').unwrap_or(("fixed", text));
        match kind {
            "fixed" | "random" => {
                let Numbers(numbers) = list.parse()?;
                let spec = |&number: &u64| match kind {
                    "random" => Ok(HorizonSpec::Random(Some(number))),
                    _ => Horizon::new(number).map(|horizon| HorizonSpec::Fixed(vec![horizon])),
                };
                let all: Result<_, _> = numbers.iter().map(spec).collect();
                Ok(Self(all.map_err(|source| HorizonsError::Range { list: list.into(), source })?))
            }
            _ => Ok(Self(vec![text.parse()?])),
        }
    }
}

struct Job {
    spec: HorizonSpec,
    source: HorizonSource,
    scenario: Scenario,
}

/// Runs the sweep, writes the table as CSV and prints it.
pub fn run(args: Args) -> Ending {
    let (scenario, params) = set_up(Some(&args.scenario), None, args.profile, &args.set).map_err(Failure::usage)?;
    params.warnings().iter().for_each(|warning| tracing::warn!("{warning}"));
    let jobs = jobs(&args, &scenario, &params).map_err(Failure::usage)?;
    let path = new_file(args.out.as_deref(), &format!("sweep-{}", scenario.name), "csv").map_err(Failure::usage)?;
    let progress = Progress::of_work(jobs.len());
    let drive = |job: &Job| match args.check_solver {
        true => run_checked(&job.scenario, &params, &job.source),
        false => (run_whole(&job.scenario, &params, &job.source, |_| {}), SolverCheck::default()),
    };
    let (results, checks): (Vec<_>, Vec<_>) = parallel::map(&jobs, drive, || progress.advance()).into_iter().unzip();
    progress.finish();
    let check = checks.into_iter().fold(SolverCheck::default(), SolverCheck::with);

    let mut table = TextTable::new(&[
        "horizon",
        "seed",
        "success",
        "ticks",
        "path",
        "ratio",
        "min_separation",
        "collisions",
        "activations",
        "infeasible",
    ]);
    for (job, result) in jobs.iter().zip(&results) {
        table.row(row(job, result));
    }
    // Whatever becomes of the terminal, the results are kept.
    write_new(&path, table.csv().as_bytes()).map_err(Failure::broken)?;
    stdout::text(table.aligned())?;
    stdout::line(verdict(&jobs, &results))?;
    stdout::line(path.display())?;
    if args.check_solver {
        stdout::line(check)?;
    }
    Ok(if check.passed() { Outcome::Done } else { Outcome::Failed })
}

fn jobs(args: &Args, scenario: &Scenario, params: &Params) -> Result<Vec<Job>, HorizonSourceError> {
    let seeds = args.seeds.as_ref().map_or(vec![scenario.seed], |seeds| seeds.0.clone());
    let mut jobs = Vec::new();
    for spec in &args.horizons.0 {
        for &seed in &seeds {
            let mut scenario = Scenario { seed, ..scenario.clone() };
            scenario.max_ticks = args.max_ticks.unwrap_or(scenario.max_ticks);
            let source = HorizonSource::new(spec, scenario.robots.len(), seed, params.horizon.jitter)?;
            jobs.push(Job { spec: spec.clone(), source, scenario });
        }
    }
    Ok(jobs)
}

fn row(job: &Job, run: &RunSummary) -> [String; 10] {
    [
        job.spec.to_string(),
        job.scenario.seed.to_string(),
        if run.success { "yes" } else { "no" }.into(),
        run.ticks.to_string(),
        format!("{:.2}", run.path_cost),
        run.path_ratio.map_or("-".into(), |ratio| format!("{ratio:.4}")),
        run.min_separation.map_or("-".into(), |least| format!("{least:.6}")),
        run.collisions.to_string(),
        run.activations.to_string(),
        run.infeasible.to_string(),
    ]
}

/// How many succeeded, and the shortest and the median path among them.
fn verdict(jobs: &[Job], results: &[RunSummary]) -> String {
    let mut good: Vec<(f64, &Job)> =
        results.iter().zip(jobs).filter(|(run, _)| run.success).map(|(run, job)| (run.path_cost, job)).collect();
    good.sort_by(|a, b| a.0.total_cmp(&b.0));
    match good.as_slice() {
        [] => format!("0 of {} succeeded", jobs.len()),
        [(best, job), ..] => format!(
            "{} of {} succeeded; shortest path {best:.2} m with {} (seed {}); median path {:.2} m",
            good.len(),
            jobs.len(),
            job.spec,
            job.scenario.seed,
            good[good.len() / 2].0
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn horizons_are_lists_of_fixed_or_random_ones() {
        let specs = |text: &str| {
            text.parse::<Horizons>().map(|horizons| horizons.0.iter().map(HorizonSpec::to_string).collect::<Vec<_>>())
        };
        assert_eq!(specs("5,10").unwrap(), ["fixed:5", "fixed:10"]);
        assert_eq!(specs("random:0..2").unwrap(), ["random:0", "random:1", "random:2"]);
        let message = specs("0..3").unwrap_err().to_string();
        assert!(message.starts_with("--horizons 0..3: horizon 0 is outside 1..=49; write fixed"), "{message}");
        for text in ["twenty", "5,x", "random:5,x"] {
            let message = specs(text).unwrap_err().to_string();
            assert!(message.contains("1..49") && !message.contains("script"), "one list of forms: {message}");
        }
    }

    #[test]
    fn one_row_per_horizon_and_seed() {
        let place = tempfile::tempdir().unwrap();
        let out = place.path().join("sweep.csv");
        let args = Args {
            scenario: "ring:2".into(),
            horizons: "10,20".parse().unwrap(),
            seeds: Some("0..2".parse().unwrap()),
            profile: Profile::Safe,
            set: vec![],
            max_ticks: Some(3),
            check_solver: true,
            out: Some(out.clone()),
        };
        assert_eq!(run(args).unwrap(), Outcome::Done);
        let text = std::fs::read_to_string(out).unwrap();
        assert_eq!(text.lines().count(), 1 + 2 * 3);
        assert!(text.lines().nth(1).unwrap().starts_with("fixed:10,0,no,3,"), "{text}");
    }

    #[test]
    fn a_file_that_exists_is_refused_before_any_work() {
        let place = tempfile::tempdir().unwrap();
        let out = place.path().join("old.csv");
        std::fs::write(&out, "kept").unwrap();
        let args = Args {
            scenario: "ring:2".into(),
            horizons: "10".parse().unwrap(),
            seeds: None,
            profile: Profile::Safe,
            set: vec![],
            max_ticks: Some(1),
            check_solver: false,
            out: Some(out.clone()),
        };
        let Err(Failure::Usage(error)) = run(args) else { panic!("it is wrong usage") };
        assert!(error.to_string().contains("never written over"), "{error}");
        assert_eq!(std::fs::read(out).unwrap(), b"kept");
    }
}
