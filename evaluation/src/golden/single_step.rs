//! Single steps: previous predictions in; rows, stacked constraints and the optimum out.

use super::Deviation;
use super::switches::Switches;
use serde::Deserialize;
use vodca::Position;
use vodca::conflict::rows::collision_rows;
use vodca::conflict::{Hazard, PredictedMotion};
use vodca::horizon::Horizon;
use vodca::mpc::ladder::Ladder;
use vodca::mpc::problem::{Problem, Row, SlackPrice, Solution, SolveError};
use vodca::mpc::stacked::Stacked;
use vodca::params::Params;
use vodca::prediction::Prediction;
use vodca::reference;
use vodca::safety::cell::{Cell, Present};

/// One robot, one tick.
#[derive(Clone, Debug, Deserialize)]
#[allow(non_snake_case)] // The files' names.
pub struct Case {
    /// Its name in the file.
    pub name: String,
    robot: usize,
    switches: Switches,
    x0: [f64; 2],
    goal: [f64; 2],
    horizon: Horizon,
    previous: Vec<Option<Vec<[f64; 2]>>>,
    present: Option<Vec<[f64; 2]>>,
    obstacles: Vec<[f64; 2]>,
    kc_rows: Vec<GoldenRow>,
    cell_rows: Vec<GoldenRow>,
    A_coll: Vec<Vec<f64>>,
    b_coll: Vec<f64>,
    feasible: bool,
    U: Option<Vec<f64>>,
}

/// `b' x[step] >= c`, not normalised.
#[derive(Clone, Debug, Deserialize)]
struct GoldenRow {
    b: [f64; 2],
    c: f64,
    step: usize,
}

impl Case {
    /// Computes the step and finds the first deviation.
    pub fn check(&self, tolerance: f64) -> Result<Option<Deviation>, String> {
        let params = self.switches.params()?;
        let position = place(&self.x0);
        let mut rows = self.collision_rows(&params);
        let collision_rows = rows.len();
        rows.extend(self.cell(&params).as_rows(position));
        let wanted: Vec<&GoldenRow> = self.kc_rows.iter().chain(&self.cell_rows).collect();
        let mut worst = Worst { robot: self.robot, tolerance, found: None };
        worst.see("number of rows", collision_rows.abs_diff(self.kc_rows.len()) as f64);
        worst.see("number of cell rows", (rows.len() - collision_rows).abs_diff(self.cell_rows.len()) as f64);
        if worst.found.is_some() {
            return Ok(worst.found);
        }
        for (row, golden) in rows.iter().zip(&wanted) {
            let b = place(&golden.b);
            worst.see("row step", row.step.abs_diff(golden.step) as f64);
            worst.see("row normal", (row.normal * b.norm() - b).amax());
            worst.see("row offset", (row.offset * b.norm() - golden.c).abs());
        }
        let mut target = reference::empty_target();
        reference::set_point(&mut target, place(&self.goal), self.horizon);
        let problem = Problem {
            horizon: self.horizon,
            position,
            target: &target,
            rows: &rows,
            slack: SlackPrice { linear: params.vodca.slack_linear, quadratic: params.vodca.slack_quadratic },
            sample_time: params.model.sample_time,
            max_speed: params.model.max_speed,
            state_weight: params.mpc.state_weight,
            input_weight: params.mpc.input_weight,
        };
        self.check_stacked(&problem, &wanted, &mut worst);
        self.check_optimum(&problem, &mut worst);
        Ok(worst.found)
    }

    fn collision_rows(&self, params: &Params) -> Vec<Row> {
        let plans: Vec<Option<Prediction>> = self.previous.iter().map(|states| Some(plan(states.as_ref()?))).collect();
        let mut rows = Vec::new();
        let Some(Some(own)) = plans.get(self.robot) else { return rows };
        let separation = params.model.min_separation;
        let others = plans.iter().enumerate().filter(|(other, _)| *other != self.robot);
        let neighbours = others.filter_map(|(_, plan)| {
            Some(Hazard { course: PredictedMotion::Plan { plan: plan.as_ref()?, age: 0 }, separation })
        });
        let obstacles =
            self.obstacles.iter().map(|at| Hazard { course: PredictedMotion::Still(place(at)), separation });
        let hazards = neighbours.chain(obstacles);
        collision_rows(&params.vodca, separation, params.vodca.turn, own, self.horizon, hazards, &mut rows);
        rows
    }

    fn cell(&self, params: &Params) -> Cell {
        let mut cell = Cell::with_capacity(8, params.model.sample_time * params.model.max_speed);
        let Some(present) = self.present.as_ref().filter(|_| params.cell.enabled) else { return cell };
        let own = place(&present[self.robot]);
        let separation = params.cell.separation;
        for (other, at) in present.iter().enumerate().filter(|(other, _)| *other != self.robot) {
            let hazard = Present { position: place(at), separation, moves: Some(cell.stride) };
            cell.keep_away(own, &hazard, params.cell.escape, self.robot < other);
        }
        for at in &self.obstacles {
            let hazard = Present { position: place(at), separation, moves: None };
            cell.keep_away(own, &hazard, params.cell.escape, true);
        }
        cell
    }

    /// A_coll and b_coll of the paper's stacked form.
    fn check_stacked(&self, problem: &Problem<'_>, wanted: &[&GoldenRow], worst: &mut Worst) {
        worst.see("rows of A_coll", self.A_coll.len().abs_diff(wanted.len()) as f64);
        let stacked = Stacked::new(problem);
        for (index, (golden, a)) in wanted.iter().zip(&self.A_coll).enumerate() {
            let scale = place(&golden.b).norm();
            let found = stacked.rows.row(index) * scale;
            worst.see("length of a row of A_coll", a.len().abs_diff(found.len()) as f64);
            let off = found.iter().zip(a).map(|(found, wanted)| (found - wanted).abs());
            worst.see("A_coll", off.fold(0.0, f64::max));
            worst.see("b_coll", (stacked.limits[index] * scale - self.b_coll[index]).abs());
        }
    }

    fn check_optimum(&self, problem: &Problem<'_>, worst: &mut Worst) {
        let mut plan = Solution::default();
        let outcome = Ladder::default().solve(problem, &mut plan);
        match (outcome, &self.U) {
            (Ok(_), Some(wanted)) if self.feasible => {
                let inputs = plan.inputs.iter().flat_map(|input| [input.x, input.y]);
                let off = inputs.zip(wanted).map(|(found, wanted)| (found - wanted).abs());
                worst.see("U, m/s", off.fold(0.0, f64::max));
                worst.see("length of U", wanted.len().abs_diff(2 * self.horizon.steps()) as f64);
            }
            (Err(SolveError::Infeasible), _) if !self.feasible => {}
            _ => worst.see("feasible", 1.0),
        }
    }
}

/// Keeps the first deviation beyond tolerance.
struct Worst {
    robot: usize,
    tolerance: f64,
    found: Option<Deviation>,
}

impl Worst {
    fn see(&mut self, what: &'static str, deviation: f64) {
        if self.found.is_none() && (deviation.is_nan() || deviation > self.tolerance) {
            self.found = Some(Deviation { tick: 0, robot: self.robot, what, deviation, allowed: self.tolerance });
        }
    }
}

fn place(at: &[f64; 2]) -> Position {
    Position::new(at[0], at[1])
}

/// A plan from its states l = 1..=N; state(0) is not used here.
fn plan(states: &Vec<[f64; 2]>) -> Prediction {
    let all: Vec<Position> = states.iter().take(1).chain(states).map(place).collect();
    Prediction::from_states(&all, Position::zeros())
}
