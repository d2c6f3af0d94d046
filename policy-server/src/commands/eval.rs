//! `policy eval`: observation vectors in, JSON out.

use crate::actor::{Actor, Runtime};
use crate::check::look;
use crate::eval::evaluate;
use crate::means::Means;
use crate::sample::Choice;
use anyhow::Context;
use policy::folder::resolve;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  ./run.sh policy eval policies/random2 observations.json\n\
    with observations.json = [[0, 0, 10, 0], [1, 0, 9, 0]]: x and y of each robot in metres, one list per \
    observation.\nThe answer is a list of {mean, log_std, action, horizon}.")]
pub(crate) struct EvalArgs {
    /// ONNX file or policies folder
    file: PathBuf,
    /// JSON: a list of observation vectors [x0, y0, x1, y1, ...], m
    observations: PathBuf,
    /// Sample actions instead of taking the mean; observation i counts as tick i
    #[arg(long)]
    stochastic: bool,
    /// Seed of the samples
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    means: Means,
}

pub(crate) fn run(args: &EvalArgs) -> anyhow::Result<ExitCode> {
    let place = args.observations.display();
    let json = std::fs::read(&args.observations).with_context(|| format!("cannot read {place}"))?;
    let observations: Vec<Vec<f64>> = serde_json::from_slice(&json)
        .with_context(|| format!("{place}: a list of lists of numbers is wanted, [[x0, y0, x1, y1, ...], ...]"))?;
    let prober = args.means.prober()?;
    let candidate = look(&resolve(&args.file)?, None, &prober.limits)?;
    prober.try_out(&candidate)?;
    let choice = if args.stochastic {
        anyhow::ensure!(
            candidate.contract.outputs.log_std.is_some(),
            "{} has no log_std, so it cannot be sampled; leave --stochastic out",
            candidate.file.display()
        );
        Choice::Sample { seed: args.seed }
    } else {
        Choice::Mean
    };
    let runtime = Runtime::start(&prober.back_end)?;
    let mut actor = Actor::load(&runtime, &candidate.bytes, &candidate.contract)?;
    println!("{}", serde_json::to_string_pretty(&evaluate(&mut actor, &observations, choice)?)?);
    Ok(ExitCode::SUCCESS)
}
