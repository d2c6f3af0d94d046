//! A layout of robots, set-points and obstacles: from a file, by name, or generated.
//!
//! The file format is documented in `scenarios/README.md`.

mod builtin;
mod error;
mod file;
mod generate;
mod jitter;
mod lines;
mod setup;
pub mod suite;
mod validate;

pub use builtin::names;
pub use error::{Problem, ScenarioError};
pub use setup::{SetupError, set_up};
/// An obstacle that is no disc of the paper: cut into convex pieces.
pub use world::shape::Obstacle as Shaped;

use crate::Position;
use crate::geometry::Disc;
use crate::obstacles::Obstacles;
use crate::suggest;
use std::path::Path;

/// Most robots of a run: what the exchange was measured with, doubled.
pub const MAX_ROBOTS: usize = 200;

/// Coordinates and radii beyond this many metres are mistakes.
pub const MAX_COORDINATE: f64 = 1e6;

/// Largest speed of a robot of its own, m/s: as for `model.max_speed`.
pub const MAX_SPEED: f64 = 100.0;

/// Episode length K of the paper, used where a scenario does not say.
pub const DEFAULT_MAX_TICKS: u64 = 350;

/// One robot of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Name shown in tables.
    pub name: String,
    /// x_i at tick 0, m.
    pub start: Position,
    /// x_i^d, m.
    pub set_point: Position,
    /// Radius of the disc, m; `None`: half of min_separation.
    pub radius: Option<f64>,
    /// Bound on the input per axis, m/s; `None`: `model.max_speed`.
    pub max_speed: Option<f64>,
}

/// A static obstacle (disc).
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Name shown in errors.
    pub name: String,
    /// Centre o_l, m.
    pub position: Position,
    /// Radius of the disc, m; `None`: half of min_separation.
    pub radius: Option<f64>,
}

/// A layout of robots, set-points and obstacles.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Its name: the file's stem or the built-in name.
    pub name: String,
    /// The robots, in the order of their numbers.
    pub robots: Vec<Robot>,
    /// The obstacles that are discs.
    pub obstacles: Vec<Obstacle>,
    /// All others: polygons, walls and the regions of a map. Obstacles are numbered discs first, then these.
    pub shapes: Vec<Shaped>,
    /// K: a run that has not arrived by then has failed.
    pub max_ticks: u64,
    /// Seed of everything random in this scenario (jitter, noise) unless `--seed` says otherwise.
    pub seed: u64,
    /// Whether robots may start nearer than min_separation on purpose.
    pub allow_close_start: bool,
    /// Overlay of parameters.
    pub params: toml::Table,
}

impl Robot {
    /// Radius beyond min_separation / 2, m: what every separation of this robot is reduced by.
    pub fn extra_radius(&self, min_separation: f64) -> f64 {
        extra_radius(self.radius, min_separation)
    }
}

impl Obstacle {
    /// Radius beyond min_separation / 2, m.
    pub fn extra_radius(&self, min_separation: f64) -> f64 {
        extra_radius(self.radius, min_separation)
    }
}

/// Exactly 0 where no radius is given, so that the common case keeps its bits.
fn extra_radius(radius: Option<f64>, min_separation: f64) -> f64 {
    radius.map_or(0.0, |radius| radius - min_separation / 2.0)
}

/// Whether what the user wrote means a file rather than a name.
fn is_file(spec: &str) -> bool {
    spec.contains('/') || spec.ends_with(".toml")
}

impl Scenario {
    /// Radius of `robot` beyond min_separation / 2, m; 0 unless the scenario gives a radius.
    pub fn extra_radius(&self, robot: usize, min_separation: f64) -> f64 {
        self.robots[robot].extra_radius(min_separation)
    }

    /// The bound on the input of `robot` per axis, m/s, where it is `usual` for all that have none of their own.
    pub fn max_speed(&self, robot: usize, usual: f64) -> f64 {
        self.robots[robot].max_speed.unwrap_or(usual)
    }

    /// The largest bound of any robot, m/s per axis.
    pub fn fastest(&self, usual: f64) -> f64 {
        (0..self.robots.len()).map(|robot| self.max_speed(robot, usual)).fold(0.0, f64::max)
    }

    /// How many obstacles there are.
    pub fn obstacle_count(&self) -> usize {
        self.obstacles.len() + self.shapes.len()
    }

    /// The name of an obstacle by its number.
    pub fn obstacle_name(&self, number: usize) -> &str {
        match self.obstacles.get(number) {
            Some(disc) => &disc.name,
            None => self.shapes[number - self.obstacles.len()].name(),
        }
    }

    /// Everything that stands: discs and shapes.
    pub fn standing(&self, min_separation: f64) -> Obstacles {
        Obstacles::new(&self.discs(min_separation), &self.shapes, min_separation)
    }

    /// The corners of the smallest upright rectangle round everything that stands and every start and set-point, m.
    pub fn bounds(&self, min_separation: f64) -> [Position; 2] {
        let half = Position::repeat(min_separation / 2.0);
        let ends = self.robots.iter().flat_map(|robot| [robot.start, robot.set_point]);
        let none = [Position::repeat(f64::INFINITY), Position::repeat(f64::NEG_INFINITY)];
        let discs = self.obstacles.iter().map(|disc| (disc.position, disc.radius.map_or(half, Position::repeat)));
        let rings = self.shapes.iter().flat_map(|shape| {
            let radius = Position::repeat(shape.radius());
            shape.rings().iter().flatten().map(move |corner| (*corner, radius))
        });
        ends.map(|end| (end, half))
            .chain(discs)
            .chain(rings)
            .fold(none, |[low, high], (at, reach)| [low.inf(&(at - reach)), high.sup(&(at + reach))])
    }

    /// The discs as they are owed separations.
    pub fn discs(&self, min_separation: f64) -> Vec<Disc> {
        self.obstacles
            .iter()
            .map(|obstacle| Disc { centre: obstacle.position, extra: obstacle.extra_radius(min_separation) })
            .collect()
    }

    /// Sum of the straight lines from start to set-point, m.
    pub fn straight_line(&self) -> f64 {
        self.robots.iter().map(|robot| (robot.set_point - robot.start).norm()).sum()
    }

    /// Finds a scenario: a file (`spec` holds a `/` or ends in `.toml`), a built-in name, or a generator:
    /// `ring:N`, `box:N:OBSTACLES:SEED`, `exchange:N:SEED`, `segregate:GROUPSxSIZE:SEED`. Without a
    /// `spec`, one that suits `robots`. The result is checked except for distances, which depend on
    /// parameters: see [`Scenario::validate_distances`] and [`set_up`].
    ///
    /// # Errors
    /// Nothing by that name, an unreadable or invalid file, or not `robots` robots in it.
    pub fn resolve(spec: Option<&str>, robots: Option<usize>) -> Result<Self, ScenarioError> {
        let fallback = robots.map(Self::default_for);
        let spec = spec.or(fallback.as_deref()).ok_or(ScenarioError::NothingChosen)?;
        let scenario = if is_file(spec) {
            Self::load(Path::new(spec))?
        } else if let Some(text) = builtin::text(spec) {
            Self::from_toml(text, spec, &format!("scenarios/{spec}.toml"))?
        } else if let Some(generated) = generate::from_spec(spec, robots) {
            generated?
        } else {
            let near = suggest::nearest(spec, names().chain(generate::FORMS.iter().copied()), 5);
            return Err(ScenarioError::Unknown { spec: spec.into(), near: near.join(", ") });
        };
        match robots {
            Some(wanted) if wanted != scenario.robots.len() => {
                Err(ScenarioError::WrongCount { scenario: scenario.name, has: scenario.robots.len(), wanted })
            }
            _ => Ok(scenario),
        }
    }

    /// The name of the scenario that a run of `robots` robots uses when none is chosen.
    pub fn default_for(robots: usize) -> String {
        match robots {
            2 => "two_setpoint".into(),
            4 => "four_gate".into(),
            14 => "ex14_d".into(),
            n => format!("ring:{n}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(spec: Option<&str>, robots: Option<usize>) -> String {
        Scenario::resolve(spec, robots).unwrap_err().to_string()
    }

    #[test]
    fn a_number_of_robots_alone_picks_a_sensible_scenario() {
        for (robots, name) in [(1, "ring:1"), (2, "two_setpoint"), (4, "four_gate"), (14, "ex14_d"), (50, "ring:50")] {
            let scenario = Scenario::resolve(None, Some(robots)).unwrap();
            assert_eq!((scenario.name.as_str(), scenario.robots.len()), (name, robots));
        }
    }

    #[test]
    fn a_scenario_with_another_number_of_robots_is_refused() {
        assert_eq!(
            message(Some("ex14_d"), Some(4)),
            "scenario ex14_d has 14 robots, not 4; leave the number out or choose another scenario"
        );
    }

    #[test]
    fn unknown_names_are_answered_with_near_ones() {
        let message = message(Some("ex14d"), None);
        assert!(message.starts_with("there is no scenario `ex14d`; near names: ex14_"), "{message}");
        assert!(message.contains("ring:N"), "{message}");
        let missing = super::tests::message(Some("./nowhere.toml"), None);
        assert!(missing.starts_with("cannot read scenario file ./nowhere.toml"), "{missing}");
        assert!(super::tests::message(None, None).contains("give a number of robots"));
    }

    #[test]
    fn only_given_radii_change_what_is_kept() {
        let mut scenario = Scenario::resolve(Some("four_gate"), None).unwrap();
        assert_eq!(scenario.extra_radius(0, 1.5), 0.0);
        scenario.robots[0].radius = Some(1.0);
        assert_eq!(scenario.extra_radius(0, 1.5), 0.25);
        assert_eq!(scenario.discs(1.5)[1].extra, 0.0);
    }
}
