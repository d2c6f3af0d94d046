//! The command line: one subcommand per file of `commands/`.

use crate::check::probe;
use crate::commands::{bench, check, contract, control, eval, new, publish};
use crate::serve;
use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Policies: check, publish and try ONNX actors, and swap them while the robots drive.
#[derive(Debug, Parser)]
#[command(name = "policy", bin_name = "./run.sh policy", version, arg_required_else_help = true, max_term_width = 100, after_help = EXAMPLES)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  ./run.sh policy new --random --robots 14 policies/random14
  ./run.sh policy check policies/random14
  ./run.sh policy swap runs/20260131-120000-ex14_d-14 better.onnx
Every command has its own --help.

Exit codes: 0 done; 1 refused or failed; 2 wrong usage.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Climb the whole ladder with a model: may it act?
    Check(check::CheckArgs),
    /// Print the contract of a model, to be completed and written beside it
    Contract(contract::ContractArgs),
    /// Write a valid actor that was never trained, to try things with
    New(new::NewArgs),
    /// Publish a model into a policies folder as its newest version
    Publish(publish::PublishArgs),
    /// Ask a policy about a list of observations
    Eval(eval::EvalArgs),
    /// Measure loading and inference with an actor that was never trained
    Bench(bench::BenchArgs),
    /// Serve a run (the coordinator does that; by hand after a crash)
    Serve(serve::ServeArgs),
    /// What the policy server of a run does
    Status(control::StatusArgs),
    /// Let another model act in a run, from between two ticks on
    Swap(control::SwapArgs),
    /// Let the model act again that acted before
    Rollback(control::RollbackArgs),
    /// Try one model in this process (started by the others, not by people)
    #[command(hide = true, name = probe::TRIAL_COMMAND)]
    Trial,
}

impl Cli {
    /// Does what was asked.
    pub fn run(self) -> anyhow::Result<ExitCode> {
        match self.command {
            Command::Check(args) => check::run(&args),
            Command::Contract(args) => contract::run(&args),
            Command::New(args) => new::run(&args),
            Command::Publish(args) => publish::run(&args),
            Command::Eval(args) => eval::run(&args),
            Command::Bench(args) => bench::run(&args),
            Command::Serve(args) => serve::run(&args).map(|()| ExitCode::SUCCESS),
            Command::Status(args) => control::status(&args),
            Command::Swap(args) => control::swap(&args),
            Command::Rollback(args) => control::rollback(&args),
            Command::Trial => probe::run_trial_process().map(|()| ExitCode::SUCCESS),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent_and_every_command_shows_an_example() {
        let mut cli = Cli::command();
        cli.build();
        cli.clone().debug_assert();
        for command in cli.get_subcommands_mut().filter(|command| !command.is_hide_set()) {
            if command.get_name() != "help" {
                let help = command.render_long_help().to_string();
                assert!(help.contains("Example") && help.contains("./run.sh policy"), "{help}");
            }
        }
    }
}
