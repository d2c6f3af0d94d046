//! Closed loops: start, horizons and switches in; positions, row counts and infeasible QPs out.

use super::Deviation;
use super::switches::Switches;
use serde::Deserialize;
use vodca::Position;
use vodca::horizon::Horizon;
use vodca::params::Params;
use vodca::scenario::{Obstacle, Robot, Scenario};
use vodca::step::Status;
use vodca::team::Team;

/// One closed loop of K ticks and n robots.
#[derive(Clone, Debug, Deserialize)]
pub struct Case {
    /// Its name in the file.
    pub name: String,
    switches: Switches,
    start: Vec<[f64; 2]>,
    goal: Vec<[f64; 2]>,
    obstacles: Vec<[f64; 2]>,
    /// `horizons[tick][robot]`.
    pub horizons: Vec<Vec<Horizon>>,
    /// `positions[tick][robot]`, K + 1 entries, m.
    pub positions: Vec<Vec<[f64; 2]>>,
    rows: Vec<Vec<u32>>,
    infeasible: Option<Vec<Vec<u32>>>,
    exact_steps: usize,
    sensitivity: Vec<f64>,
}

impl Case {
    /// The case as a scenario; its robots may start anywhere.
    pub fn scenario(&self) -> Scenario {
        let place = |at: &[f64; 2]| Position::new(at[0], at[1]);
        let robot = |(index, (start, goal)): (usize, (&[f64; 2], &[f64; 2]))| Robot {
            name: format!("robot{index}"),
            start: place(start),
            set_point: place(goal),
            radius: None,
            max_speed: None,
        };
        let obstacle = |(index, at): (usize, &[f64; 2])| Obstacle {
            name: format!("obstacle{index}"),
            position: place(at),
            radius: None,
        };
        Scenario {
            name: self.name.clone(),
            robots: self.start.iter().zip(&self.goal).enumerate().map(robot).collect(),
            obstacles: self.obstacles.iter().enumerate().map(obstacle).collect(),
            shapes: Vec::new(),
            max_ticks: self.horizons.len() as u64,
            seed: 0,
            allow_close_start: true,
            params: toml::Table::new(),
        }
    }

    /// The case's switches as parameters.
    pub fn params(&self) -> Result<Params, String> {
        self.switches.params()
    }

    /// Allowed deviation of positions at `tick`, m: tight while the reference is exact, then what the loop's own
    /// sensitivity to rounding allows.
    fn allowed(&self, tick: usize, tolerance: f64) -> f64 {
        if tick <= self.exact_steps { tolerance } else { tolerance.max(100.0 * self.sensitivity[tick]) }
    }

    /// Runs the loop and finds the first deviation.
    pub fn check(&self, tolerance: f64) -> Result<Option<Deviation>, String> {
        let mut team = Team::new(&self.scenario(), &self.params()?, 0);
        for (tick, horizons) in self.horizons.iter().enumerate() {
            let steps = team.step(horizons);
            for (robot, step) in steps.iter().enumerate() {
                let reference = self.positions[tick + 1][robot];
                let off = (step.next_position - Position::new(reference[0], reference[1])).norm();
                let allowed = self.allowed(tick + 1, tolerance);
                let counted = |what, found: u32, wanted: u32| {
                    let deviation = f64::from(found.abs_diff(wanted));
                    (found != wanted).then_some(Deviation { tick, robot, what, deviation, allowed: 0.0 })
                };
                let infeasible = u32::from(matches!(step.status, Status::Relaxed | Status::Held));
                let wanted = self.infeasible.as_ref().map_or(infeasible, |list| list[tick][robot]);
                let position = Deviation { tick: tick + 1, robot, what: "position, m", deviation: off, allowed };
                let deviation = counted("rows", step.rows, self.rows[tick][robot])
                    .or_else(|| counted("infeasible", infeasible, wanted))
                    .or_else(|| (off.is_nan() || off > allowed).then_some(position));
                if deviation.is_some() {
                    return Ok(deviation);
                }
            }
        }
        Ok(None)
    }
}
