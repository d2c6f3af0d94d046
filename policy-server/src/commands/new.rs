//! `policy new`: a valid actor that was never trained.

use crate::actor::{Actor, Runtime};
use crate::eval::reference_set;
use crate::means::Means;
use crate::random_actor::random_actor;
use policy::folder::PolicyFolder;
use std::path::PathBuf;
use std::process::ExitCode;
use vodca::random::{self, Use};
use vodca::scenario::MAX_ROBOTS;

/// Observations of its reference set.
const CASES: u64 = 16;
/// How far another back-end may differ.
const TOLERANCE: f64 = 1e-4;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  ./run.sh policy new --random --robots 14 --seed 1 policies/random14")]
pub(crate) struct NewArgs {
    /// Policies folder; an existing one gets a new version
    folder: PathBuf,
    /// Weights drawn from the seed (the only kind there is; a trained one comes from the learner)
    #[arg(long, required = true)]
    random: bool,
    /// Number of robots
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=MAX_ROBOTS as u64))]
    robots: u64,
    /// Seed of the weights
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    means: Means,
}

pub(crate) fn run(args: &NewArgs) -> anyhow::Result<ExitCode> {
    let robots = args.robots as usize;
    let (model, contract) = random_actor(robots, args.seed);
    let runtime = Runtime::start(&args.means.back_end())?;
    let mut actor = Actor::load(&runtime, &model, &contract)?;
    let reference = reference_set(&mut actor, &observations(robots, args.seed), TOLERANCE)?;
    let folder = PolicyFolder::new(&args.folder);
    let version = folder.publish(&model, &contract, Some(&serde_json::to_string_pretty(&reference)?))?;
    println!("{} is the current policy of {} ({robots} robots)", version, folder.root().display());
    Ok(ExitCode::SUCCESS)
}

/// Seeded positions in a square of 80 m.
fn observations(robots: usize, seed: u64) -> Vec<Vec<f64>> {
    let case = |case| {
        let mut generator = random::stream(seed, Use::Policy, u64::MAX - 1, case);
        (0..2 * robots).map(|_| 80.0 * random::unit(&mut generator) - 40.0).collect()
    };
    (0..CASES).map(case).collect()
}
