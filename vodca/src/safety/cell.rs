//! Hard cell rows on the first step (ARCHITECTURE, rule 5).
//!
//! Between two robots at distance d >= r_s both must keep `n . move >= (r_s - d) / 2`; added up,
//! `n . (x_i - x_j)` stays >= r_s at the end of the tick and, being linear, in between. Both sides must
//! use the SAME two positions: the broadcast ones, never a mix with sensed ones. Standing still always
//! satisfies every row whose demand is not positive.

use crate::Position;
use crate::geometry::NO_DIRECTION;
use crate::mpc::problem::Row;
use std::f64::consts::SQRT_2;

/// `normal . move >= demand` for the move of one tick, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellRow {
    /// Unit vector from the hazard to the robot.
    pub normal: Position,
    /// Smallest move along `normal`, m; negative: how far the robot may approach.
    pub demand: f64,
}

/// Where a robot may move within this tick.
#[derive(Clone, Debug)]
pub struct Cell {
    /// The half planes, for hazards near enough to matter.
    pub rows: Vec<CellRow>,
    /// Largest length of the move, m: finite when a neighbour's position is not known for this tick.
    pub reach: f64,
    /// Largest move per axis in a tick, m: h times the largest speed.
    pub stride: f64,
}

/// A hazard's present place as everybody knows it.
#[derive(Clone, Copy, Debug)]
pub struct Present {
    /// Broadcast position, m.
    pub position: Position,
    /// r_s plus radii beyond r_min / 2, m.
    pub separation: f64,
    /// Its largest move per axis in a tick, m, if it moves by the same rules (a robot); none where it stays.
    pub moves: Option<f64>,
}

/// What was last heard of a robot.
#[derive(Clone, Copy, Debug)]
pub struct Last {
    /// Broadcast position, m.
    pub position: Position,
    /// Ticks since.
    pub age: u64,
    /// Its largest move per axis in a tick, m.
    pub stride: f64,
}

impl Cell {
    /// An empty cell with room for `hazards` rows.
    pub fn with_capacity(hazards: usize, stride: f64) -> Self {
        Self { rows: Vec::with_capacity(hazards), reach: f64::INFINITY, stride }
    }

    /// Forgets the last tick.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.reach = f64::INFINITY;
    }

    /// Keeps away from a hazard whose present position is known. `own` is the robot's own broadcast
    /// position; `escape` is the move away that is demanded below the separation, m; `lower` says
    /// which side a robot takes when both stand on the same point.
    pub fn keep_away(&mut self, own: Position, hazard: &Present, escape: f64, lower: bool) {
        let apart = own - hazard.position;
        let distance = apart.norm();
        let share = if hazard.moves.is_some() { 0.5 } else { 1.0 };
        if distance >= hazard.separation + SQRT_2 * (self.stride + hazard.moves.unwrap_or(0.0)) {
            return; // Out of reach even if both run straight at each other.
        }
        let normal = if distance >= NO_DIRECTION {
            apart / distance
        } else {
            Position::new(if lower { -1.0 } else { 1.0 }, 0.0)
        };
        let demand = if distance >= hazard.separation { (hazard.separation - distance) * share } else { escape };
        self.rows.push(CellRow { normal, demand });
    }

    /// Limits the move when a robot's position was last heard some ticks ago: it may have run towards us since. The
    /// move is then short enough for any direction of it.
    pub fn stay_near(&mut self, own: Position, last: &Last, separation: f64) {
        let run = SQRT_2 * last.stride * last.age as f64;
        let room = ((own - last.position).norm() - run - separation) / 2.0;
        self.reach = self.reach.min(room.max(0.0));
    }

    /// The cell as hard rows of the QP; `position` is `x[0]`, m.
    pub fn as_rows(&self, position: Position) -> impl Iterator<Item = Row> + '_ {
        self.rows.iter().map(move |row| Row {
            step: 1,
            normal: row.normal,
            offset: row.normal.dot(&position) + row.demand,
            hard: true,
        })
    }
}
