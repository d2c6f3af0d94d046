//! `learner learn`: the offline part of training, from recorded rollouts to an exported actor.

use crate::export::export;
use crate::progress::Progress;
use crate::reward_weights::RewardWeights;
use crate::rollouts::{self, survey};
use crate::sac::{Learner, Losses};
use crate::settings::Settings;
use crate::tensorboard::Curves;
use anyhow::Context;
use policy::contract::{self, Contract};
use policy::folder::PolicyFolder;
use shared::stop::StopFlag;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Name of the checkpoint in the folder of a training.
pub(crate) const CHECKPOINT: &str = "checkpoint.safetensors";
/// Name of the contract beside it.
const CONTRACT: &str = "contract.json";
/// Updates that one point of the curves is the mean of.
const POINT: u64 = 100;
/// States of the reference set.
const STATES: u64 = 64;

#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  ./run.sh learn --rollouts rollouts/two --out trained/two --updates 6000
  ./run.sh learn --rollouts rollouts/* --out trained/all --set batch=512 --set discount=0.98
  ./run.sh learn --resume trained/two --updates 12000 --out trained/two
  ./run.sh 2 --policy trained/two/policy
  tensorboard --logdir trained/two/curves

Ctrl-C leaves a checkpoint; --resume goes on from it as if nothing had happened.")]
pub(crate) struct Args {
    /// Folders of shards that `./run.sh rollout` wrote
    #[arg(long, value_name = "DIR", num_args = 1.., required_unless_present = "resume")]
    rollouts: Vec<PathBuf>,
    /// Folder for checkpoint, curves and policy
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Updates to reach in all, those before --resume included
    #[arg(long, default_value_t = 10_000)]
    updates: u64,
    /// Folder of an earlier training to go on from; its rows are in its checkpoint
    #[arg(long, value_name = "DIR", conflicts_with_all = ["rollouts", "set", "seed"])]
    resume: Option<PathBuf>,
    /// A setting, as printed by `./run.sh learner settings`
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Seed of first weights, batches and action noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Updates between two checkpoints
    #[arg(long, default_value_t = 5000, value_parser = clap::value_parser!(u64).range(1..))]
    checkpoint_every: u64,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let stop = StopFlag::install().context("cannot catch signals")?;
    let (mut learner, contract) = match &args.resume {
        Some(folder) => resumed(folder)?,
        None => begun(args)?,
    };
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    let beside = args.out.join(CONTRACT);
    std::fs::write(&beside, contract.to_json()).with_context(|| format!("cannot write {}", beside.display()))?;
    let checkpoint = args.out.join(CHECKPOINT);
    let stopped = update(&mut learner, args, &checkpoint, &stop)?;
    learner.save(&checkpoint)?;
    if stopped {
        println!("stopped after {} updates; go on with", learner.updates());
        println!("  ./run.sh learn --resume {0} --updates {1} --out {0}", args.out.display(), args.updates);
        return Ok(());
    }
    let folder = PolicyFolder::new(args.out.join("policy"));
    let version = export(learner.actor(), &contract, &states(&learner, &contract), &folder)?;
    println!("{version} of {} after {} updates", folder.root().display(), learner.updates());
    Ok(())
}

/// A new learner with all rollouts in its memory.
fn begun(args: &Args) -> anyhow::Result<(Learner, Contract)> {
    let settings = args.set.iter().try_fold(Settings::default(), |settings, assignment| settings.with(assignment))?;
    let survey = survey(&args.rollouts)?;
    let mut contract = survey.contract();
    let about = &survey.about;
    contract.trained_from = Some(format!("{} rows of {} ({}), offline", survey.rows, about.scenario, about.profile));
    let robots = about.robots;
    let mut learner = Learner::new(2 * robots, robots, settings, args.seed);
    let successes = rollouts::remember(&mut learner, &contract, &RewardWeights::default(), &survey.shards)?;
    let (rows, forgotten) = (survey.rows, survey.rows.saturating_sub(learner.replay().len() as u64));
    println!("{rows} rows of {robots} robots, {successes} successful episodes, {forgotten} rows beyond replay_rows");
    Ok((learner, contract))
}

/// The learner and contract of an earlier training.
fn resumed(folder: &Path) -> anyhow::Result<(Learner, Contract)> {
    let learner = Learner::load(&folder.join(CHECKPOINT))?;
    let path = folder.join(CONTRACT);
    let bytes = std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let contract = contract::from_json(&bytes, &path.display().to_string())?;
    println!("{} updates and {} rows so far", learner.updates(), learner.replay().len());
    Ok((learner, contract))
}

/// Updates until the number is reached or somebody asks to stop; says whether that happened.
fn update(learner: &mut Learner, args: &Args, checkpoint: &Path, stop: &StopFlag) -> anyhow::Result<bool> {
    let mut curves = Curves::create(&args.out.join("curves"))?;
    let progress = Progress::new(args.updates, learner.updates());
    let (mut losses, mut clock) = (Vec::with_capacity(POINT as usize), Instant::now());
    while learner.updates() < args.updates {
        if stop.is_set() {
            progress.finish();
            return Ok(true);
        }
        losses.push(learner.update());
        let done = learner.updates();
        if done.is_multiple_of(POINT) || done == args.updates {
            let speed = losses.len() as f64 / clock.elapsed().as_secs_f64();
            let mean = Losses::mean(&losses);
            progress.show(done, speed, mean.critic);
            curves.scalars(done, &[&mean.scalars()[..], &[("updates_per_second", speed)]].concat())?;
            losses.clear();
            clock = Instant::now();
        }
        if done.is_multiple_of(args.checkpoint_every) {
            learner.save(checkpoint)?;
            clock = Instant::now(); // Writing is not updating.
        }
    }
    progress.finish();
    Ok(false)
}

/// States for the reference set, in m, spread over what is remembered.
fn states(learner: &Learner, contract: &Contract) -> Vec<Vec<f64>> {
    let contract::Observation { offset, scale, .. } = &contract.observation;
    let metres = |(at, scaled): (usize, &f32)| f64::from(*scaled) / scale[at % 2] + offset[at % 2];
    let rows = learner.replay().observations();
    let stride = (rows.len() as u64).div_ceil(STATES).max(1) as usize;
    rows.step_by(stride).map(|row| row.iter().enumerate().map(metres).collect()).collect()
}
