//! What a command needs beside the program and the robots: `run.sh` builds it before the command runs.

use crate::cli::{Cli, Command};
use clap::Parser;
use evaluation::bench::Part;
use evaluation::compare::HorizonPart;

/// Something that is built only for the commands that need it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// The policy server, the heaviest build of all.
    PolicyServer,
    /// The views of Foxglove, a feature of the program.
    Foxglove,
}

impl Need {
    /// The word that `run.sh` reads.
    pub fn word(self) -> &'static str {
        match self {
            Self::PolicyServer => "policy-server",
            Self::Foxglove => "foxglove",
        }
    }
}

/// What the command with these `arguments` (as typed behind `./run.sh`) needs. Nothing where they make no
/// command: the command itself says so better.
pub fn needs(arguments: &[String]) -> Vec<Need> {
    let words = std::iter::once("./run.sh").chain(arguments.iter().map(String::as_str));
    Cli::try_parse_from(words).map_or(Vec::new(), |cli| of(&cli.command))
}

fn of(command: &Command) -> Vec<Need> {
    let asked = |needed: bool, need: Need| needed.then_some(need);
    match command {
        Command::Run(args) => {
            let [policy, foxglove] = [args.policy.is_some(), args.foxglove.is_some()];
            [asked(policy, Need::PolicyServer), asked(foxglove, Need::Foxglove)].into_iter().flatten().collect()
        }
        Command::Rollout(args) => asked(args.policy.is_some(), Need::PolicyServer).into_iter().collect(),
        Command::Bench(args) => {
            let server = matches!(args.part, Part::Policy | Part::All);
            asked(server, Need::PolicyServer).into_iter().collect()
        }
        Command::Compare(args) => {
            let horizons = || args.controllers.iter().flat_map(|specs| &specs.0).flat_map(|spec| &spec.horizons);
            let server = horizons().any(|part| matches!(part, HorizonPart::Policy(_)));
            asked(server, Need::PolicyServer).into_iter().collect()
        }
        Command::Results(args) => asked(!args.measure.is_empty(), Need::PolicyServer).into_iter().collect(),
        Command::Evaluate(_) | Command::Figures(_) => vec![Need::PolicyServer],
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> String {
        let arguments: Vec<String> = line.split_whitespace().map(String::from).collect();
        needs(&arguments).iter().map(|need| need.word()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn a_command_needs_what_its_arguments_name() {
        for (line, expected) in [
            ("run 14", ""),
            ("run 14 --policy policies/exchange_14", "policy-server"),
            ("run 14 --policy=x --foxglove", "policy-server foxglove"),
            ("rollout --scenario ex14_d --out x", ""),
            ("compare ex14_d --controllers safe:random orca", ""),
            ("compare ex14_d --controllers paper:policy:two", "policy-server"),
            ("evaluate --policy x --scenario ex14_d", "policy-server"),
            ("figures", "policy-server"),
            ("bench exchange", ""),
            ("bench", "policy-server"),
            ("verify runs/x", ""),
        ] {
            assert_eq!(words(line), expected, "{line}");
        }
    }

    #[test]
    fn words_inside_an_argument_and_mistakes_need_nothing_more() {
        let out = ["run", "14", "--out", "a --policy b"].map(String::from);
        assert_eq!(needs(&out), []);
        assert_eq!((words("run"), words("nonsense --policy x"), words("run 14 --help")), Default::default());
    }
}
