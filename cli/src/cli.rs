//! The command line: one subcommand per file of `commands/`.

use crate::commands::{
    agent, bench, compare, evaluate, faults, figures, former, go, golden, params, replay, report, results, rollout,
    run, scenario, search, verify,
};
use crate::exit::{Ending, Failure, Outcome};
use crate::needs::needs;
use crate::stdout;
use clap::{Parser, Subcommand};
use evaluation::bench::partner;

/// A team of robots, one process each, that plans with variable horizons and on-demand collision avoidance.
#[derive(Debug, Parser)]
#[command(name = "vodca", bin_name = "./run.sh", version, arg_required_else_help = true, max_term_width = 100, after_help = EXAMPLES)]
pub struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXAMPLES: &str = "\
Examples:
  ./run.sh 14                                      fourteen robots change sides
  ./run.sh 4 --scenario four_gate --horizon random:3
  ./run.sh 8 --profile paper --horizon fixed:20 --set vodca.rows=each
  ./run.sh compare ex14_d --controllers paper:fixed:1..49 paper:random orca-best --set vodca.rows=each
  ./run.sh verify runs/20260131-120000-ex14_d-14
Every command has its own --help.

Exit codes: 0 arrived, or asked to stop; 1 failed; 2 wrong usage; 3 a robot's process was lost.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a team: one process per robot, recorded in a folder of its own (`./run.sh N` is short for it)
    Run(run::Args),
    /// Drive one robot of a run that is under way: one that was lost, or in a run `--by-hand`
    Agent(agent::Args),
    /// Send a robot of a run that is under way somewhere else
    Go(go::Args),
    /// What became `compare`
    #[command(hide = true)]
    Sweep(former::Sweep),
    /// Compare controllers over scenarios and seeds in this process
    Compare(compare::Args),
    /// Put a policy beside fixed, random and searched horizons
    Evaluate(evaluate::Args),
    /// Search the best constant horizon per robot
    Search(search::Args),
    /// Check the files of reference results in a folder
    Golden(golden::Args),
    /// Repeat a recorded run from its own folder and compare it byte for byte
    Replay(replay::Args),
    /// Check a recorded run from its CSV alone: separation, arrival, input bounds, model
    Verify(verify::Args),
    /// Play episode after episode and record what a learner needs
    Rollout(rollout::Args),
    /// Write recorded runs as one page for a browser: replay, charts, figures
    Report(report::Args),
    /// Kill robots' processes at random moments and count what that costs the others
    Faults(faults::Args),
    /// Run the paper's tasks anew and draw its figures as SVG
    Figures(figures::Args),
    /// List, check and generate scenarios
    Scenario(scenario::Args),
    /// List all parameters: value, unit, range, effect
    Params(params::Args),
    /// Write the tables of the documents anew from results/, or measure a part of it anew
    Results(results::Args),
    /// Measure latencies and times beside their floors and beside others
    Bench(bench::Args),
    /// What run.sh has to build for a command
    #[command(hide = true, disable_help_flag = true)]
    Needs {
        /// The command with its arguments
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Another process of a benchmark (started by `bench`, not by people)
    #[command(hide = true, name = partner::COMMAND)]
    Partner(partner::Args),
}

impl Cli {
    /// Does what was asked.
    pub fn run(self) -> Ending {
        match self.command {
            Command::Run(args) => run::run(args),
            Command::Agent(args) => agent::run(&args),
            Command::Go(args) => go::run(&args),
            Command::Sweep(args) => former::sweep(args),
            Command::Compare(args) => compare::run(args),
            Command::Evaluate(args) => evaluate::run(args),
            Command::Search(args) => search::run(args),
            Command::Golden(args) => golden::run(args),
            Command::Replay(args) => replay::run(args),
            Command::Verify(args) => verify::run(args),
            Command::Rollout(args) => rollout::run(args),
            Command::Report(args) => report::run(args),
            Command::Faults(args) => faults::run(&args),
            Command::Figures(args) => figures::run(args),
            Command::Scenario(args) => scenario::run(args),
            Command::Params(args) => params::run(args),
            Command::Results(args) => results::run(args),
            Command::Bench(args) => bench::run(args),
            Command::Needs { arguments } => {
                needs(&arguments).into_iter().try_for_each(|need| stdout::line(need.word()))?;
                Ok(Outcome::Done)
            }
            Command::Partner(args) => partner::run(args).map(|()| Outcome::Done).map_err(Failure::broken),
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
        for command in cli.get_subcommands_mut().filter(|command| !["help", "needs"].contains(&command.get_name())) {
            let help = command.render_long_help().to_string();
            assert!(help.contains("Example") && help.contains("./run.sh"), "{help}");
        }
    }
}
