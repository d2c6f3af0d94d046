//! `evaluate`: a policy beside everything simpler.

use super::length::metres;
use super::parameter_args::ParameterArgs;
use super::search;
use crate::exit::{Ending, Failure, Outcome};
use crate::progress::Progress;
use crate::stdout;
use coordinator::record::folder::write_new;
use evaluation::compare::{ControllerSpec, Entry, Experiment, HorizonPart, Run, Sample, expand, run_all};
use evaluation::search::{POPULATION, constants};
use evaluation::text_table::TextTable;
use shared::runtime_dir;
use shared::stop::StopFlag;
use std::path::PathBuf;
use vodca::horizon::{Horizon, MAX_HORIZON};
use vodca::horizon_source::HorizonSpec;
use vodca::scenario::set_up;

/// The paper's grid of fixed horizons.
const GRID: [usize; 10] = [5, 10, 15, 20, 25, 30, 35, 40, 45, 49];
/// Random sequences beside it.
const SEQUENCES: u64 = 60;
/// How runs are called in the CSV.
const POLICY: &str = "policy";
const CONSTANTS: &str = "constants";
const RANDOM: &str = "random";

/// Arguments of `evaluate`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh evaluate --policy exchange_14 --scenario ex14_d --profile paper --set vodca.rows=each
  ./run.sh evaluate --policy boxes_8 --scenario box:8:3:1000..1019 --profile safe --seeds 1
Two tables: the layout exactly as it is, and --seeds starts moved by up to --start-jitter. Medians with 95 % intervals
(seeded bootstrap) over the runs that succeeded. `vs best of grid` compares medians of path with the best fixed horizon
of the paper's grid 5, 10, ..., 45, 49.")]
pub struct Args {
    /// Policy: an ONNX file, a policies folder, or the name of one in policies/
    #[arg(long, value_name = "NAME")]
    policy: String,
    /// Scenario: file, built-in name, family or a range of layouts (box:8:3:0..19)
    #[arg(long, value_name = "FILE|NAME")]
    scenario: String,
    #[command(flatten)]
    parameters: ParameterArgs,
    /// Number of seeds, from --first-seed
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    seeds: u64,
    /// First seed: training used others
    #[arg(long, default_value_t = 1_000)]
    first_seed: u64,
    /// Every start moves by a seeded draw of up to so many metres per axis
    #[arg(long, value_name = "METRES", default_value = "0.1", value_parser = metres)]
    start_jitter: f64,
    /// Generations of the search for the best constant horizon per robot; 0: no search
    #[arg(long, value_name = "N", default_value_t = 40)]
    generations: u16,
    /// Every run as CSV, a new file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// One thing that chooses horizons, and how it did.
struct Row {
    name: String,
    what: String,
    runs: usize,
    successes: usize,
    path: Sample,
    ticks: Sample,
}

impl Row {
    /// Better than `other` in the same column of the table: more successes, then a shorter median path.
    fn beats(&self, other: &Row) -> bool {
        let path = |row: &Row| row.path.middle().unwrap_or(f64::INFINITY);
        self.successes > other.successes || self.successes == other.successes && path(self) < path(other)
    }
}

/// Evaluates and prints.
pub fn run(args: Args) -> Ending {
    let stop = StopFlag::install().map_err(Failure::broken)?;
    let entries = expand(&args.scenario).map_err(Failure::usage)?;
    runtime_dir::sweep_leftovers(); // of evaluations that were killed
    let constants = match args.generations {
        0 => None,
        _ => best_constants(&args, &entries, &stop)?,
    };
    let mut csv = String::new();
    for (title, jitter) in [("exactly as it is", 0.0), ("starts moved", args.start_jitter)] {
        if jitter == 0.0 && title != "exactly as it is" || stop.is_set() {
            continue;
        }
        let experiment = experiment(&args, &entries, constants.as_ref(), jitter);
        let jobs = experiment.jobs().map_err(Failure::usage)?;
        let progress = Progress::of_work(jobs.len());
        let runs = run_all(&jobs, &stop, || progress.advance());
        progress.finish();
        if let Some(failure) = runs.failure {
            return Err(Failure::broken(failure));
        }
        let Some(done) = runs.done.into_iter().collect::<Option<Vec<Run>>>() else {
            stdout::line("asked to stop: this table was not finished")?;
            break;
        };
        let moved = if jitter > 0.0 { format!(" by up to {jitter} m, {} seeds", args.seeds) } else { String::new() };
        stdout::line(format_args!("{} {}, {title}{moved}", args.scenario, args.parameters.profile))?;
        stdout::text(table(&rows(&experiment, &done, constants.as_ref())).aligned())?;
        stdout::line("")?;
        csv += &csv_of(jitter, &experiment, &done, csv.is_empty());
    }
    if let Some(out) = &args.out {
        write_new(out, csv.as_bytes()).map_err(Failure::usage)?;
        stdout::line(format_args!("{:<16}{}", "every run", out.display()))?;
    }
    Ok(Outcome::Done)
}

/// The best constant horizons of the first layout.
fn best_constants(args: &Args, entries: &[Entry], stop: &StopFlag) -> Result<Option<HorizonSpec>, Failure> {
    let Some(Entry { spec, .. }) = entries.first() else { return Ok(None) };
    let (scenario, params) =
        set_up(Some(spec), None, args.parameters.profile, &args.parameters.set).map_err(Failure::usage)?;
    let generations = usize::from(args.generations);
    let progress = Progress::of_work(generations * POPULATION);
    let found = constants(&scenario, &params, generations, 0, stop, || progress.advance()).map_err(Failure::usage)?;
    progress.finish();
    Ok(found.map(|found| search::spec(&found)))
}

/// What is evaluated, in the order of the runs: the policy, horizons 1 to 49, the constants, random ones.
fn experiment(args: &Args, entries: &[Entry], constants: Option<&HorizonSpec>, jitter: f64) -> Experiment {
    let table =
        |name: &str, spec: HorizonSpec| ControllerSpec::new(name, args.parameters.profile, HorizonPart::Table(spec));
    let mut controllers =
        vec![ControllerSpec::new(POLICY, args.parameters.profile, HorizonPart::Policy(args.policy.clone()))];
    for steps in 1..=MAX_HORIZON {
        let horizon = Horizon::saturating(steps as i64);
        controllers.push(table(&format!("fixed:{steps}"), HorizonSpec::Fixed(vec![horizon])));
    }
    controllers.extend(constants.map(|spec| table(CONSTANTS, spec.clone())));
    controllers.push(table(RANDOM, HorizonSpec::Random(None)));
    let last = args.first_seed + if jitter > 0.0 { args.seeds } else { args.seeds.max(SEQUENCES) };
    Experiment {
        entries: entries.to_vec(),
        controllers,
        seeds: (args.first_seed..last).collect(),
        start_jitter: jitter,
        sets: args.parameters.set.clone(),
        max_ticks: None,
        check_solver: false,
    }
}

/// The rows of the table, the best of several under what they are the best of.
fn rows(experiment: &Experiment, runs: &[Run], constants: Option<&HorizonSpec>) -> Vec<Row> {
    let row = |name: &str, controller: usize| {
        let own: Vec<&Run> = runs.iter().filter(|run| run.job.controller == controller).collect();
        let good: Vec<&Run> = own.iter().copied().filter(|run| run.summary.success).collect();
        Row {
            name: name.into(),
            what: experiment.controllers[controller].to_string(),
            runs: own.len(),
            successes: good.len(),
            path: Sample::of(good.iter().map(|run| run.summary.path_cost)),
            ticks: Sample::of(good.iter().map(|run| run.summary.ticks as f64)),
        }
    };
    let best = |name: &str, steps: &mut dyn Iterator<Item = usize>| {
        steps.map(|steps| row(name, steps)).reduce(|best, next| if next.beats(&best) { next } else { best })
    };
    let mut rows = vec![row("policy", 0)];
    rows.extend(best("best fixed of the paper's grid", &mut GRID.into_iter()));
    rows.extend(best("best fixed of all 49", &mut (1..=MAX_HORIZON)));
    let random = row("random, all sequences", experiment.controllers.len() - 1);
    let shortest = random.path.least();
    rows.push(random);
    if let Some(path) = shortest {
        let (path, ticks) = (Sample::of([path]), Sample::of([]));
        rows.push(Row { name: "random, the best one".into(), what: RANDOM.into(), runs: 1, successes: 1, path, ticks });
    }
    if let Some(spec) = constants {
        rows.push(Row { what: spec.to_string(), ..row("constant per robot, searched", MAX_HORIZON + 1) });
    }
    rows
}

fn table(rows: &[Row]) -> TextTable {
    let mut table = TextTable::new(&["horizons", "arrived", "path m", "95 %", "ticks", "vs best of grid", "which"]);
    let reference = rows.get(1).and_then(|row| row.path.middle());
    for row in rows {
        let median = row.path.median();
        let versus = match (reference, median) {
            (Some(reference), Some(own)) => format!("{:+.2} %", 100.0 * (own.median / reference - 1.0)),
            _ => "-".into(),
        };
        table.row([
            row.name.clone(),
            format!("{}/{}", row.successes, row.runs),
            median.map_or("-".into(), |path| format!("{:.2}", path.median)),
            median.map_or("-".into(), |path| format!("{:.2}..{:.2}", path.low, path.high)),
            row.ticks.middle().map_or("-".into(), |ticks| format!("{ticks:.0}")),
            versus,
            row.what.clone(),
        ]);
    }
    table
}

fn csv_of(jitter: f64, experiment: &Experiment, runs: &[Run], header: bool) -> String {
    let mut text = String::new();
    if header {
        text += "jitter_start_m,scenario,horizons,seed,success,ticks,path_m,min_separation_m\n";
    }
    for Run { job, summary, .. } in runs {
        let controller = &experiment.controllers[job.controller];
        let least = summary.min_separation.map_or(String::new(), |metres| metres.to_string());
        text += &format!(
            "{jitter},{},{controller},{},{},{},{},{least}\n",
            job.scenario.name, job.scenario.seed, summary.success, summary.ticks, summary.path_cost
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(successes: usize, paths: &[f64]) -> Row {
        let path = Sample::of(paths.iter().copied());
        Row { name: String::new(), what: String::new(), runs: 3, successes, path, ticks: Sample::of([]) }
    }

    #[test]
    fn a_row_beats_another_by_arrivals_and_then_by_its_path() {
        assert!(row(3, &[50.0]).beats(&row(2, &[40.0])) && !row(2, &[40.0]).beats(&row(3, &[50.0])));
        assert!(row(3, &[40.0]).beats(&row(3, &[50.0])) && !row(3, &[40.0]).beats(&row(3, &[40.0])));
        assert!(row(1, &[40.0]).beats(&row(0, &[])) && !row(0, &[]).beats(&row(0, &[])));
    }

    #[test]
    fn the_table_compares_with_the_best_of_the_grid() {
        let text = table(&[row(3, &[45.0, 40.0, 50.0]), row(3, &[50.0])]).aligned();
        assert!(text.contains("-10.00 %") && text.contains("+0.00 %"), "{text}");
    }
}
