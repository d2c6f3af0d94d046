//! `train`: the command.

use super::config::TrainingConfig;
use super::state::State;
use super::{Budget, Progress, Trainer};
use anyhow::Context;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use shared::stop::StopFlag;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Arguments of `train`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh train --plan learner/plans/two_setpoint.toml --minutes 10 --out trainings/two
  ./run.sh train --scenario four_gate --profile paper --updates 6000 --out trainings/gate
  ./run.sh train --scenario box:8:3:any --profile safe --minutes 30 --out trainings/boxes
  ./run.sh train --resume trainings/two --minutes 10
  tensorboard --logdir trainings
The best actor so far is always in DIR/best: ./run.sh 2 --profile paper --policy DIR/best")]
pub struct Args {
    /// TrainingConfig to begin with; the other options change it
    #[arg(long, value_name = "FILE", conflicts_with = "resume")]
    plan: Option<PathBuf>,
    /// Scenario: file, built-in name or family; with `any` as its seed every episode has a layout of its own
    #[arg(long, value_name = "FILE|NAME|FAMILY", conflicts_with = "resume", required_unless_present_any = ["plan", "resume"])]
    scenario: Option<String>,
    /// Parameter set of the robots: paper or safe
    #[arg(long, value_name = "NAME", conflicts_with = "resume")]
    profile: Option<String>,
    /// Change a parameter of the robots (repeatable)
    #[arg(long, value_name = "KEY=VALUE", conflicts_with = "resume")]
    set: Vec<String>,
    /// Change the plan or a setting of the learner (repeatable): round_episodes=4, reward.variance=0, batch=128
    #[arg(long, value_name = "KEY=VALUE", conflicts_with = "resume")]
    learn: Vec<String>,
    /// Seed of everything random
    #[arg(long, conflicts_with = "resume")]
    seed: Option<u64>,
    /// Stop after so many training episodes
    #[arg(long, value_name = "N")]
    episodes: Option<u64>,
    /// Stop after so many updates
    #[arg(long, value_name = "N")]
    updates: Option<u64>,
    /// Stop after so many minutes
    #[arg(long, value_name = "M", value_parser = minutes)]
    minutes: Option<f64>,
    /// Folder of the training, new or empty
    #[arg(long, value_name = "DIR", required_unless_present = "resume")]
    out: Option<PathBuf>,
    /// Go on with the training in this folder, exactly where its newest checkpoint stands
    #[arg(long, value_name = "DIR", conflicts_with = "out")]
    resume: Option<PathBuf>,
}

fn minutes(text: &str) -> Result<f64, String> {
    let minutes = text.parse().ok().filter(|minutes: &f64| *minutes > 0.0 && *minutes <= 1e5);
    minutes.ok_or_else(|| format!("`{text}` is no time; write minutes above 0, like 30 or 0.5"))
}

/// Trains.
pub fn run(args: &Args) -> anyhow::Result<()> {
    let stop = StopFlag::install()?;
    let mut trainer = match (&args.resume, &args.out) {
        (Some(folder), _) => Trainer::resume(folder)?,
        (None, Some(out)) => match Trainer::begin(plan(args)?, out, &stop)? {
            Some(trainer) => trainer,
            None => return Ok(()), // asked to stop during the warm-up: nothing has been learnt
        },
        (None, None) => anyhow::bail!("give a folder with --out, or one to --resume"),
    };
    let folder = args.resume.clone().or(args.out.clone()).unwrap_or_default();
    let budget = Budget {
        episodes: args.episodes,
        updates: args.updates,
        time: args.minutes.map(|minutes| Duration::from_secs_f64(60.0 * minutes)),
    };
    if budget.episodes.is_none() && budget.updates.is_none() && budget.time.is_none() {
        eprintln!("no --episodes, --updates or --minutes: training goes on until Ctrl-C, which leaves a checkpoint");
    }
    let bar = bar(&budget);
    let trained = trainer.train(&budget, &stop, &mut |progress| show(&bar, &budget, progress));
    bar.finish_and_clear();
    trained.with_context(|| format!("training in {} (checkpoints there stay usable)", folder.display()))?;
    println!("{}", summary(trainer.state(), trainer.learner().updates(), &folder));
    Ok(())
}

fn plan(args: &Args) -> anyhow::Result<TrainingConfig> {
    let mut plan = match &args.plan {
        Some(file) => TrainingConfig::read(file)?,
        None => TrainingConfig::default(),
    };
    if let Some(scenario) = &args.scenario {
        plan.scenario.clone_from(scenario);
    }
    if let Some(profile) = &args.profile {
        plan.profile.clone_from(profile);
    }
    plan.set.extend(args.set.iter().cloned());
    plan.seed = args.seed.unwrap_or(plan.seed);
    for assignment in &args.learn {
        plan = plan.with(assignment)?;
    }
    Ok(plan)
}

/// On a terminal only.
fn bar(budget: &Budget) -> ProgressBar {
    let visible = std::io::stderr().is_terminal();
    let target = if visible { ProgressDrawTarget::stderr_with_hz(4) } else { ProgressDrawTarget::hidden() };
    let length = budget.updates.or(budget.episodes).or(budget.time.map(|time| time.as_secs()));
    let bar = ProgressBar::with_draw_target(length, target);
    let template = if length.is_some() { "{bar:20} {elapsed} (left {eta})  {msg}" } else { "{elapsed}  {msg}" };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

fn show(bar: &ProgressBar, budget: &Budget, progress: &Progress<'_>) {
    let Progress { state, updates, point } = progress;
    bar.set_position(if budget.updates.is_some() {
        *updates
    } else if budget.episodes.is_some() {
        state.episodes
    } else {
        bar.elapsed().as_secs()
    });
    let path = |path: Option<f64>| path.map_or("-".into(), |path| format!("{path:.1} m"));
    let best = state.best.map_or("-".into(), |best| {
        format!("{}/{} {}", best.score.successes, best.score.episodes, path(best.score.path))
    });
    bar.set_message(format!(
        "episode {} update {updates}  return {:.0}  success {:.0} %  path {}  best {best}  {:.0} ticks/s {:.0} updates/s",
        state.episodes,
        point.total,
        100.0 * point.success,
        path(point.path),
        point.ticks_per_second,
        point.updates_per_second,
    ));
}

fn summary(state: &State, updates: u64, folder: &Path) -> String {
    let line = |name: &str, value: String| format!("{name:<16}{value}\n");
    let best = state.best.map_or("none yet".into(), |best| {
        let path = best.score.path.map_or("-".into(), |path| format!("{path:.2} m"));
        format!(
            "{} of {} episodes, path {path}, at most {} ticks; after {} updates",
            best.score.successes, best.score.episodes, best.score.ticks, best.updates
        )
    });
    line("played", format!("{} episodes, {} ticks", state.episodes, state.ticks))
        + &line("updates", updates.to_string())
        + &line("best", best)
        + &line("its policy", folder.join("best").display().to_string())
        + format!("{:<16}{}", "curves", folder.join("train.csv").display()).as_str()
}
