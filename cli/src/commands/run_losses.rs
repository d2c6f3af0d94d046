//! The arguments of `run` about robots that are lost or late, and faults on purpose.

use crate::exit::Failure;
use coordinator::run::{LOST_AFTER, OnLoss, Options, TICK_DEADLINE};
use shared::chaos::Chaos;
use std::time::Duration;

/// What a run does when a robot's process ends or falls silent.
#[derive(Debug, clap::Args)]
pub(super) struct LossArgs {
    /// What happens when a robot's process ends while the team drives
    #[arg(long, value_enum, default_value_t = Reaction::Continue)]
    on_loss: Reaction,
    /// How often the process of a lost robot is started anew
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1000))]
    respawn: u32,
    /// How long a tick waits for a robot before it goes on without it, s
    #[arg(long, value_name = "SECONDS", default_value_t = TICK_DEADLINE.as_secs_f64(), value_parser = seconds)]
    tick_deadline: f64,
    /// How long a late robot may be silent before it is taken for dead and ended, s
    #[arg(long, value_name = "SECONDS", default_value_t = LOST_AFTER.as_secs_f64(), value_parser = seconds)]
    lost_after: f64,
    /// Faults on purpose: kill:0.001,stop:0.01x5,delay:0.01,drop:0.02,duplicate:0.1,seed:7, or kill:3@41 for robot 3 at tick 41
    #[arg(long, value_name = "SPEC")]
    chaos: Option<Chaos>,
}

/// `--on-loss`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Reaction {
    /// The others drive on; the body that is left stands in their way
    Continue,
    /// The run ends
    Stop,
}

fn seconds(text: &str) -> Result<f64, String> {
    let known = text.parse().ok().filter(|seconds: &f64| (0.01..=3600.0).contains(seconds));
    known.ok_or_else(|| format!("`{text}` is no time; write seconds in 0.01..=3600"))
}

impl LossArgs {
    /// Puts them into the options of a run.
    pub(super) fn apply(&self, options: &mut Options) -> Result<(), Failure> {
        options.on_loss = match self.on_loss {
            Reaction::Continue => OnLoss::Continue { respawn: self.respawn },
            Reaction::Stop if self.respawn > 0 => {
                return Err(Failure::usage("--respawn needs a run that goes on: leave --on-loss stop out"));
            }
            Reaction::Stop => OnLoss::Stop,
        };
        options.tick_deadline = Duration::from_secs_f64(self.tick_deadline);
        options.lost_after = Duration::from_secs_f64(self.lost_after);
        options.chaos = self.chaos.clone().unwrap_or_default();
        Ok(())
    }

    /// The faults on purpose in words, if there are any.
    pub(super) fn chaos(&self) -> Option<String> {
        self.chaos.as_ref().map(Chaos::to_string)
    }
}
