//! A layout of robots, set-points and obstacles.

use crate::Position;

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
    /// The obstacles.
    pub obstacles: Vec<Obstacle>,
    /// K: a run that has not arrived by then has failed.
    pub max_ticks: u64,
    /// Seed of everything random in this scenario (jitter, noise) unless `--seed` says otherwise.
    pub seed: u64,
    /// Whether robots may start nearer than min_separation on purpose.
    pub allow_close_start: bool,
    /// Overlay of parameters.
    pub params: toml::Table,
}
