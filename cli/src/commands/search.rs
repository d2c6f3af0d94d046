//! `search`: the best constant horizon per robot.

use super::parameter_args::ParameterArgs;
use crate::exit::{Ending, Failure, Outcome};
use crate::progress::Progress;
use crate::stdout;
use evaluation::search::{Found, POPULATION, constants};
use shared::stop::StopFlag;
use vodca::horizon_source::HorizonSpec;
use vodca::scenario::set_up;

/// Arguments of `search`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh search --scenario ex14_d --profile paper --set vodca.rows=each
  ./run.sh search --scenario two_setpoint --profile paper --generations 10
Prints the horizons as a SPEC for --horizon. Exit code 1: nothing that was tried arrived without a collision.")]
pub struct Args {
    /// Scenario: file, built-in name or family
    #[arg(long, value_name = "FILE|NAME")]
    scenario: String,
    #[command(flatten)]
    parameters: ParameterArgs,
    /// Generations of 48 runs
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    generations: u16,
    /// Seed of the draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

/// Searches and prints what was found.
pub fn run(args: Args) -> Ending {
    let stop = StopFlag::install().map_err(Failure::broken)?;
    let (scenario, params) =
        set_up(Some(&args.scenario), None, args.parameters.profile, &args.parameters.set).map_err(Failure::usage)?;
    let generations = usize::from(args.generations);
    let progress = Progress::of_work(generations * POPULATION);
    let found = constants(&scenario, &params, generations, args.seed, &stop, || progress.advance());
    progress.finish();
    let Some(found) = found.map_err(Failure::usage)? else { return Ok(Outcome::Done) };
    let line = |name: &str, value: String| stdout::line(format_args!("{name:<16}{value}"));
    line("horizons", spec(&found).to_string())?;
    line("success", if found.summary.success { "yes" } else { "no" }.into())?;
    line("path", format!("{:.2} m", found.summary.path_cost))?;
    line("ticks", found.summary.ticks.to_string())?;
    line("runs", found.runs.to_string())?;
    Ok(if found.summary.success { Outcome::Done } else { Outcome::Failed })
}

/// As a source of horizons.
pub(super) fn spec(found: &Found) -> HorizonSpec {
    HorizonSpec::Fixed(found.horizons.clone())
}
