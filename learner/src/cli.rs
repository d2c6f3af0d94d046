//! The command line: one subcommand per file of `commands/`.

use crate::commands::{bench, learn, settings};
use crate::train::command as train;
use clap::{Parser, Subcommand};

/// Learning from rollouts: soft actor-critic on recorded episodes.
#[derive(Debug, Parser)]
#[command(name = "learner", version, arg_required_else_help = true, max_term_width = 100, after_help = EXAMPLES)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  ./run.sh train --plan learner/plans/two_setpoint.toml --minutes 10 --out trainings/two
  ./run.sh learn --rollouts rollouts/two --out trained/two --updates 6000
  ./run.sh learn --resume trained/two --updates 12000 --out trained/two
  ./run.sh learner settings
Every command has its own --help.

Exit codes: 0 done or asked to stop; 1 failed; 2 wrong usage.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Train an actor: rollouts, learning and evaluation, round after round
    Train(train::Args),
    /// Learn an actor from recorded rollouts
    Learn(learn::Args),
    /// Print every setting with its default
    Settings,
    /// Measure updates per second
    Bench(bench::Args),
}

impl Cli {
    /// Does what was asked.
    pub fn run(&self) -> anyhow::Result<()> {
        match &self.command {
            Command::Train(args) => train::run(args),
            Command::Learn(args) => learn::run(args),
            Command::Settings => settings::run(),
            Command::Bench(args) => bench::run(args),
        }
    }
}
