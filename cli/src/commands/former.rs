//! Command lines of earlier versions, said in today's words and then done.

use crate::cli::Cli;
use crate::exit::{Ending, Failure};
use clap::Parser;
use std::io::Write as _;
use vodca::params::Profile;
use vodca::scenario::Scenario;

/// Arguments of `sweep`, which is `compare` with a column of horizons.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: ./run.sh compare ex14_d --controllers paper:fixed:1..49 --csv ex14_d.csv")]
pub struct Sweep {
    #[arg(long)]
    scenario: String,
    #[arg(long, default_value = "1..49")]
    horizons: String,
    #[arg(long)]
    seeds: Option<String>,
    #[arg(long, default_value = "safe")]
    profile: Profile,
    #[arg(long)]
    set: Vec<String>,
    #[arg(long)]
    max_ticks: Option<String>,
    #[arg(long)]
    check_solver: bool,
    #[arg(long)]
    out: Option<String>,
}

/// Says what to type from now on, and does it.
pub fn sweep(args: Sweep) -> Ending {
    let words = args.as_compare().map_err(Failure::usage)?;
    let line: Vec<String> = words.iter().map(|word| quoted(word)).collect();
    let _ = writeln!(std::io::stderr(), "sweep is compare now: ./run.sh {}", line.join(" ")); // a hint, no result
    let cli = Cli::try_parse_from(std::iter::once("./run.sh".to_string()).chain(words)).map_err(Failure::usage)?;
    cli.run()
}

impl Sweep {
    /// The same as words of `compare`.
    fn as_compare(&self) -> Result<Vec<String>, vodca::scenario::ScenarioError> {
        let profile = self.profile;
        let controller = match (profile, self.horizons.split_once(':')) {
            (Profile::Orca | Profile::OrcaRh, _) => profile.to_string(),
            (_, None) => format!("{profile}:fixed:{}", self.horizons),
            (_, Some(_)) => format!("{profile}:{}", self.horizons),
        };
        let seeds = match &self.seeds {
            Some(seeds) => seeds.clone(),
            None => Scenario::resolve(Some(&self.scenario), None)?.seed.to_string(),
        };
        let mut words: Vec<String> = vec!["compare".into(), self.scenario.clone(), "--controllers".into(), controller];
        let mut option = |name: &str, value: &String| words.extend([name.into(), value.clone()]);
        option("--seed-list", &seeds);
        self.set.iter().for_each(|set| option("--set", set));
        self.max_ticks.iter().for_each(|ticks| option("--max-ticks", ticks));
        self.out.iter().for_each(|out| option("--csv", out));
        words.extend(self.check_solver.then(|| "--check-solver".into()));
        Ok(words)
    }
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-:,=/+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        sweep: Sweep,
    }

    fn translated(line: &str) -> String {
        let words = std::iter::once("sweep").chain(line.split_whitespace());
        Line::try_parse_from(words).unwrap().sweep.as_compare().unwrap().join(" ")
    }

    #[test]
    fn every_form_of_a_sweep_is_a_comparison() {
        assert_eq!(
            translated(
                "--profile paper --scenario ex14_d --horizons 1..49 --seeds 0..19 --set vodca.rows=each --out F.csv"
            ),
            "compare ex14_d --controllers paper:fixed:1..49 --seed-list 0..19 --set vodca.rows=each --csv F.csv"
        );
        assert_eq!(
            translated("--scenario rand8o3_s0 --horizons random:0..9 --check-solver --max-ticks 5"),
            "compare rand8o3_s0 --controllers safe:random:0..9 --seed-list 0 --max-ticks 5 --check-solver"
        );
        assert_eq!(
            translated("--scenario box:8:0:7 --profile orca --seeds 3"),
            "compare box:8:0:7 --controllers orca --seed-list 3"
        );
    }

    #[test]
    fn a_sweep_leaves_its_csv() {
        let place = tempfile::tempdir().unwrap();
        let out = place.path().join("F");
        let line = format!("--profile paper --scenario ring:2 --horizons 10,20 --max-ticks 3 --out {}", out.display());
        let words = std::iter::once("sweep").chain(line.split_whitespace());
        sweep(Line::try_parse_from(words).unwrap().sweep).unwrap();
        assert_eq!(std::fs::read_to_string(out).unwrap().lines().count(), 1 + 2);
    }

    #[test]
    fn words_are_quoted_for_a_shell_where_they_need_it() {
        assert_eq!(
            (quoted("a=0.1,b"), quoted("a b"), quoted("it's")),
            ("a=0.1,b".into(), "'a b'".into(), r"'it'\''s'".into())
        );
    }
}
