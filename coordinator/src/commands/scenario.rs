//! `scenario`: lists, checks and generates scenarios.

use crate::exit::{Ending, Failure, Outcome};
use clap::Subcommand;
use shared::params::Profile;
use shared::scenario::{Scenario, names, set_up};
use std::path::PathBuf;

/// Arguments of `scenario`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh scenario list
  ./run.sh scenario check my_layout.toml
  ./run.sh scenario generate box:16:3:7 --out my_box.toml
Families: ring:N, box:N:OBSTACLES:SEED, exchange:N:SEED, segregate:GROUPSxSIZE:SEED.")]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Print the names of the built-in scenarios
    List,
    /// Check a scenario file (or a name) and say what is in it
    Check {
        /// File, built-in name or family
        scenario: String,
        /// Parameter set to check distances with: safe, paper, orca or orca-rh
        #[arg(long, default_value = "safe")]
        profile: Profile,
        /// Change a parameter (repeatable)
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
    },
    /// Write a scenario of a family, or a copy of a built-in one, as a file to edit
    Generate {
        /// Family or built-in name
        scenario: String,
        /// The file to write; standard output when left out
        #[arg(long)]
        out: Option<PathBuf>,
    },
}

/// Does what was asked.
pub fn run(args: Args) -> Ending {
    match args.action {
        Action::List => names().for_each(|name| println!("{name}")),
        Action::Check { scenario, profile, set } => {
            let (scenario, params) = set_up(Some(&scenario), None, profile, &set).map_err(Failure::broken)?;
            println!("{}", describe(&scenario, params.model.min_separation));
        }
        Action::Generate { scenario, out } => generate(&scenario, out)?,
    }
    Ok(Outcome::Done)
}

fn describe(scenario: &Scenario, min_separation: f64) -> String {
    format!(
        "{}: {} robots, {} obstacles, straight lines {:.1} m, at most {} ticks, nothing nearer than {min_separation} m: usable",
        scenario.name,
        scenario.robots.len(),
        scenario.obstacles.len(),
        scenario.straight_line(),
        scenario.max_ticks
    )
}

/// Why a generated scenario could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}; choose another file with --out", path.display())]
struct WriteError {
    path: PathBuf,
    source: std::io::Error,
}

fn generate(spec: &str, out: Option<PathBuf>) -> Result<(), Failure> {
    let text = Scenario::resolve(Some(spec), None).and_then(|scenario| scenario.to_toml()).map_err(Failure::usage)?;
    let Some(path) = out else {
        print!("{text}");
        return Ok(());
    };
    // Never over a file that somebody may have edited.
    let written =
        std::fs::File::create_new(&path).and_then(|mut file| std::io::Write::write_all(&mut file, text.as_bytes()));
    written.map_err(|source| Failure::broken(WriteError { path, source }))
}
