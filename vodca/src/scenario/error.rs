//! Why a scenario cannot be used.

use super::{MAX_COORDINATE, MAX_ROBOTS, MAX_SPEED, lines};
use std::path::PathBuf;
use world::check::PlaceProblem;
use world::file::LayoutError;
use world::route::Unreachable;

/// Why no scenario was found or why it cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ScenarioError {
    /// Neither a scenario nor a number of robots.
    #[error("no scenario chosen; give a number of robots or a scenario, for example ex14_d")]
    NothingChosen,
    /// The file cannot be read.
    #[error("cannot read scenario file {}: {source}; check the path, or use a built-in name without `/`", .file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The copy of a scenario cannot be written.
    #[error("scenario {scenario} has no TOML form: {message}")]
    Unwritable {
        /// Its name.
        scenario: String,
        /// The TOML writer's reason.
        message: String,
    },
    /// Not TOML, or fields that are missing, unknown or of the wrong type.
    #[error("{file}: {message}")]
    Malformed {
        /// The file.
        file: String,
        /// Line, caret and accepted names, from the TOML reader.
        message: String,
    },
    /// A format version we do not read.
    #[error("{file}: version = {version} is not known; this program reads version = 1 (scenarios/README.md)")]
    Version {
        /// The file.
        file: String,
        /// As written.
        version: String,
    },
    /// An obstacle or a map that cannot be used.
    #[error("{place}: {source}")]
    Standing {
        /// The file and the line.
        place: String,
        /// What is wrong with what.
        source: Box<LayoutError>,
    },
    /// No file, built-in or generator by that name.
    #[error(
        "there is no scenario `{spec}`; near names: {}; generated ones: ring:N, box:N:OBSTACLES:SEED, exchange:N:SEED, \
         segregate:GROUPSxSIZE:SEED, park:N:SEED, tight_ring:N:SEED, permute:N:SEED, mixed:N:SEED, door:N:WIDTH:SEED, \
         pocket:N:SEED, corridor:N:SEED, forest:N:SEED, rooms:N:SEED, warehouse:N:SEED; a file needs a `/` or `.toml` in its name",
        if .near.is_empty() { "none" } else { .near }
    )]
    Unknown {
        /// As written.
        spec: String,
        /// Near names.
        near: String,
    },
    /// A generator's arguments cannot be used.
    #[error("scenario `{spec}`: {reason}; the form is {form}")]
    Generator {
        /// As written.
        spec: String,
        /// What is wrong.
        reason: String,
        /// The generator's form.
        form: &'static str,
    },
    /// Not the number of robots that was asked for.
    #[error("scenario {scenario} has {has} robots, not {wanted}; leave the number out or choose another scenario")]
    WrongCount {
        /// Its name.
        scenario: String,
        /// Robots in it.
        has: usize,
        /// Robots asked for.
        wanted: usize,
    },
    /// A layout that cannot be run.
    #[error("scenario {scenario}: {problem}")]
    Invalid {
        /// Its file as it was given; its name where it comes from none.
        scenario: String,
        /// What is wrong and what to do.
        problem: Problem,
    },
}

impl ScenarioError {
    /// The same error, with `place` (a file) in place of the name of a scenario that cannot be run.
    pub(super) fn at(self, place: &str) -> Self {
        match self {
            Self::Invalid { problem, .. } => Self::Invalid { scenario: place.into(), problem },
            other => other,
        }
    }

    /// The same error with the file in which it is, and with the line of the robot or obstacle that it is about;
    /// `text` is what the file holds.
    pub(super) fn in_file(self, file: &str, text: &str) -> Self {
        let who = if let Self::Invalid { problem, .. } = &self { problem.who() } else { None };
        let place = lines::place(file, text, who);
        self.at(&place)
    }
}

/// What is wrong with a layout and what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// Nobody to run.
    #[error("it has no robots; add at least one [[robot]] with start and set_point")]
    NoRobots,
    /// Over [`MAX_ROBOTS`].
    #[error("{0} robots are too many; at most {MAX_ROBOTS} are supported")]
    TooManyRobots(usize),
    /// An integer outside its range.
    #[error("{key} = {value} is not allowed; allowed: {low}..={high}")]
    Integer {
        /// The key in the file.
        key: &'static str,
        /// Its value.
        value: u64,
        /// Smallest allowed.
        low: u64,
        /// Largest allowed.
        high: u64,
    },
    /// NaN, infinity or a number beyond [`MAX_COORDINATE`].
    #[error(
        "{what} of {who} is [{x}, {y}] m; coordinates must be finite numbers in -{MAX_COORDINATE}..={MAX_COORDINATE} m"
    )]
    Coordinate {
        /// Robot or obstacle.
        who: String,
        /// start, set_point or position.
        what: &'static str,
        /// x, m.
        x: f64,
        /// y, m.
        y: f64,
    },
    /// A radius that is not a positive number.
    #[error(
        "radius of {who} is {radius} m; allowed: above 0, at most {MAX_COORDINATE} m \
         (leave it out for half of model.min_separation)"
    )]
    Radius {
        /// Robot or obstacle.
        who: String,
        /// As written, m.
        radius: f64,
    },
    /// A speed that is not a positive number.
    #[error(
        "max_speed of {who} is {speed} m/s; allowed: above 0, at most {MAX_SPEED} m/s (leave it out for model.max_speed)"
    )]
    Speed {
        /// Robot.
        who: String,
        /// As written, m/s.
        speed: f64,
    },
    /// A start or a set-point inside a shape, or nearer to it than the robot is large.
    #[error(transparent)]
    Place(Box<PlaceProblem>),
    /// A set-point to which no way leads.
    #[error("{robot} cannot reach its set-point: {reason}")]
    Unreachable {
        /// The robot.
        robot: String,
        /// Why not.
        reason: Box<Unreachable>,
    },
    /// A name used twice.
    #[error("two entries are called `{0}`; give each its own name or leave the names out")]
    DuplicateName(String),
    /// Two starts, or a start and an obstacle, at the same place.
    #[error("{a} and {b} are at the same place [{x}, {y}] m at the start: nothing can separate them; move one of them")]
    Coincident {
        /// The robot.
        a: String,
        /// Another robot or an obstacle.
        b: String,
        /// x, m.
        x: f64,
        /// y, m.
        y: f64,
    },
    /// Overlapping discs at the start.
    #[error(
        "{a} starts {distance:.4} m from {b}, nearer than the {needed:.4} m that their radii need; move one of them, \
         or write allow_close_start = true if it is meant"
    )]
    CloseStart {
        /// The robot.
        a: String,
        /// Another robot or an obstacle.
        b: String,
        /// Between centres, m.
        distance: f64,
        /// Sum of the radii, m.
        needed: f64,
    },
    /// A set-point that can never be filled.
    #[error(
        "the set-point of {a} is {distance:.4} m from {b}, nearer than the {needed:.4} m that their radii need: \
         both can never be there; move one of them"
    )]
    CloseSetPoint {
        /// The robot.
        a: String,
        /// Another robot's set-point or an obstacle.
        b: String,
        /// Between centres, m.
        distance: f64,
        /// Sum of the radii, m.
        needed: f64,
    },
    /// No valid start was found near the given one.
    #[error("no start within {spread} m of {robot}'s keeps its distances; use a smaller spread")]
    NoJitteredStart {
        /// The robot.
        robot: String,
        /// Largest move per axis, m.
        spread: f64,
    },
}

impl Problem {
    /// The robot or obstacle that it is about, if it is about one; of two the first.
    pub(super) fn who(&self) -> Option<&str> {
        match self {
            Self::Coordinate { who, .. } | Self::Radius { who, .. } | Self::Speed { who, .. } => Some(who),
            Self::DuplicateName(name) => Some(name),
            Self::Coincident { a, .. } | Self::CloseStart { a, .. } | Self::CloseSetPoint { a, .. } => Some(a),
            Self::Unreachable { robot, .. } | Self::NoJitteredStart { robot, .. } => Some(robot),
            Self::Place(problem) => match &**problem {
                PlaceProblem::Inside { robot, .. } | PlaceProblem::TooNear { robot, .. } => Some(robot),
            },
            Self::NoRobots | Self::TooManyRobots(_) | Self::Integer { .. } => None,
        }
    }
}
