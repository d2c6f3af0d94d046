//! `scenario`: lists, checks, draws and generates scenarios.

use crate::exit::{Ending, Failure, Outcome};
use crate::{stdout, whole_file};
use clap::Subcommand;
use std::path::PathBuf;
use std::sync::Arc;
use vodca::metrics::RunMetrics;
use vodca::params::{Params, Profile};
use vodca::scenario::{Scenario, names, set_up};
use world::draw::{RobotMark, svg};
use world::route::{Roadmap, Route};

/// Arguments of `scenario`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh scenario list
  ./run.sh scenario check my_layout.toml
  ./run.sh scenario show my_layout.toml -o my_layout.svg
  ./run.sh scenario show warehouse:20:1 -o warehouse.svg
  ./run.sh scenario generate box:16:3:7 --out my_box.toml
Families: ring:N, box:N:OBSTACLES:SEED, exchange:N:SEED, segregate:GROUPSxSIZE:SEED; tight places: park:N:SEED,
tight_ring:N:SEED, permute:N:SEED, mixed:N:SEED; walls: door:N:WIDTH:SEED, pocket:N:SEED, corridor:N:SEED, forest:N:SEED,
rooms:N:SEED, warehouse:N:SEED. What a file holds, obstacles and maps: scenarios/README.md.")]
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
    /// Draw a scenario as SVG before anyone runs it: what stands, starts (filled), set-points (rings), shortest ways
    #[command(after_help = "Example:\n  ./run.sh scenario show my_layout.toml -o my_layout.svg\n\
        A robot without a way has a dashed line; why, is said at the end, and the exit code is 2.")]
    Show {
        /// File, built-in name or family
        scenario: String,
        /// The picture to write, over what is there; standard output when left out
        #[arg(short, long, value_name = "FILE.svg")]
        out: Option<PathBuf>,
        /// Parameter set whose separation decides about ways: safe, paper, orca or orca-rh
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
        Action::List => {
            for name in names() {
                stdout::line(name)?;
            }
        }
        Action::Check { scenario, profile, set } => {
            let (scenario, params) = set_up(Some(&scenario), None, profile, &set).map_err(Failure::usage)?;
            stdout::line(describe(&scenario, &params))?;
        }
        Action::Show { scenario, out, profile, set } => show(&scenario, out, profile, &set)?,
        Action::Generate { scenario, out } => generate(&scenario, out)?,
    }
    Ok(Outcome::Done)
}

fn describe(scenario: &Scenario, params: &Params) -> String {
    // Before the first tick the metrics know the distances at the start.
    let least = RunMetrics::new(scenario, params).min_separation();
    let wanted = params.model.min_separation;
    let nearest = match least {
        least if least.is_infinite() => "nothing to meet".into(),
        least if least < wanted - 1e-9 => {
            format!("{least:.3} m apart at the start, nearer than {wanted} m (allow_close_start)")
        }
        least => format!("at least {least:.3} m apart at the start"),
    };
    format!(
        "{}: {} robots, {} obstacles, straight lines {:.1} m, at most {} ticks, {nearest}: usable",
        scenario.name,
        scenario.robots.len(),
        scenario.obstacle_count(),
        scenario.straight_line(),
        scenario.max_ticks
    )
}

/// Why a generated scenario could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}; choose {next}", path.display())]
struct WriteError {
    path: PathBuf,
    source: std::io::Error,
    next: &'static str,
}

/// Draws whatever can be read; what is wrong with it comes after.
fn show(spec: &str, out: Option<PathBuf>, profile: Profile, set: &[String]) -> Result<(), Failure> {
    let scenario = Scenario::resolve(Some(spec), None).map_err(Failure::usage)?;
    let params = Params::resolve(profile, &scenario.name, &scenario.params, set).map_err(Failure::usage)?;
    let text = picture(&scenario, params.model.min_separation);
    match out {
        None => stdout::text(text)?,
        Some(path) => whole_file::write(&path, &text)
            .map_err(|source| Failure::broken(WriteError { path, source, next: "another file with -o" }))?,
    }
    set_up(Some(spec), None, profile, set).map(|_| ()).map_err(Failure::usage)
}

/// The scenario with everybody's shortest way as if it were alone.
fn picture(scenario: &Scenario, min_separation: f64) -> String {
    let obstacles = scenario.standing(min_separation).all().clone();
    let mut maps: Vec<Arc<Roadmap>> = Vec::new();
    let robots: Vec<RobotMark> = (scenario.robots.iter())
        .map(|robot| {
            let radius = robot.radius.unwrap_or(min_separation / 2.0);
            let known = maps.iter().find(|map| map.clearance() == radius).cloned();
            let map = known.unwrap_or_else(|| {
                let map = Arc::new(Roadmap::new(obstacles.clone(), radius));
                maps.push(map.clone());
                map
            });
            let way = Route::new(map, robot.set_point).map(|route| route.walk(robot.start, None).collect());
            let way = way.unwrap_or_default();
            RobotMark { name: robot.name.clone(), start: robot.start, set_point: robot.set_point, radius, way }
        })
        .collect();
    svg(&scenario.name, &obstacles, &robots)
}

fn generate(spec: &str, out: Option<PathBuf>) -> Result<(), Failure> {
    let text = Scenario::resolve(Some(spec), None).and_then(|scenario| scenario.to_toml()).map_err(Failure::usage)?;
    let Some(path) = out else {
        stdout::text(text)?;
        return Ok(());
    };
    // Never over a file that somebody may have edited.
    let written =
        std::fs::File::create_new(&path).and_then(|mut file| std::io::Write::write_all(&mut file, text.as_bytes()));
    written.map_err(|source| Failure::broken(WriteError { path, source, next: "another file with --out" }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use coordinator::record::samples;

    #[test]
    fn the_description_tells_the_actual_distance_at_the_start() {
        let (mut scenario, params) = (samples::scenario(2), Params::safe());
        scenario.obstacles.clear();
        assert!(describe(&scenario, &params).contains("at least 10.000 m apart"), "{}", describe(&scenario, &params));
        scenario.robots[1].start.x = 1.2;
        assert!(describe(&scenario, &params).contains(" 1.200 m apart at the start, nearer than 1.5 m"));
        scenario.robots.truncate(1);
        assert!(describe(&scenario, &params).contains("nothing to meet"));
    }

    #[test]
    fn a_picture_shows_what_stands_and_a_way_for_everybody() {
        let scenario = Scenario::resolve(Some("warehouse:20:1"), None).unwrap();
        let text = picture(&scenario, 1.5);
        assert_eq!(text.matches("<circle").count(), 40);
        // Nineteen regions, twenty ways, none of them dashed, and the scale.
        assert_eq!((text.matches("<path").count(), text.matches("dasharray").count()), (40, 0));
    }

    #[test]
    fn a_scenario_that_cannot_be_used_is_wrong_usage() {
        let action = Action::Check { scenario: "nowhere".into(), profile: Profile::Safe, set: vec![] };
        assert!(matches!(run(Args { action }), Err(Failure::Usage(_))));
    }
}
