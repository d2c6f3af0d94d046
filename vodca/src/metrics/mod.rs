//! What a run is judged by, computed the same way in every process and offline.

mod run;
mod summary;

pub use run::RunMetrics;
pub use summary::{RobotSummary, RunSummary, SolverLevels, Statuses, TaskSummary};

use crate::Position;
use crate::geometry::Disc;
use crate::separation::separation;

/// Distances that count as below min_separation are more than this below it, m: a hard row that
/// binds leaves exactly min_separation, up to rounding.
pub const SEPARATION_TOLERANCE: f64 = 1e-6;

/// Smallest effective separation of one tick: `moves[i]` is robot i's straight motion. Effective means
/// that radii beyond min_separation / 2 are taken off, so that min_separation is the limit for all.
/// `f64::INFINITY` when there is nothing to meet.
pub fn min_separation(moves: &[(Position, Position)], robot_extra: &[f64], obstacles: &[Disc]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, &own) in moves.iter().enumerate() {
        for (j, &other) in moves.iter().enumerate().skip(i + 1) {
            least = least.min(separation(own, other) - robot_extra[i] - robot_extra[j]);
        }
        for obstacle in obstacles {
            let still = (obstacle.centre, obstacle.centre);
            least = least.min(separation(own, still) - robot_extra[i] - obstacle.extra);
        }
    }
    least
}
