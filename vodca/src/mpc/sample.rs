//! Random QPs like those of a crowded run, by seed: for tests, benchmarks and comparisons with
//! other solvers.
//!
//! The position lies in [0, 25]^2 m, the set-point 0.5..20 m away; hazards stand 0.7..1.499 m from a
//! point of the row-free plan, within 60 degrees of the heading.

use super::closed_form::ClosedForm;
use super::problem::{Problem, Row, SlackPrice, Solution, Target, TargetKind};
use crate::horizon::{Horizon, MAX_HORIZON};
use crate::random::{self, Use};
use crate::{Input, Position};
use chacha20::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

const SAMPLE_TIME: f64 = 0.2;
const MAX_SPEED: f64 = 1.5;
const MIN_SEPARATION: f64 = 1.5;

/// What a sampled problem looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// The paper's: drawn to a set-point, hard rows; a share of them is infeasible.
    Hard,
    /// The paper's after relaxation: drawn to a set-point, soft rows.
    Soft,
    /// The safe profile: straight reference, soft rows with turned normals, one hard first-step
    /// row for every second soft one; standing still is feasible.
    Safe,
    /// Rows that repeat, touch or share their step: dependent active sets. Hard and soft mixed.
    Degenerate,
    /// Two hard rows that exclude each other, beside others.
    Opposed,
}

impl Family {
    /// All families.
    pub const ALL: [Family; 5] = [Self::Hard, Self::Soft, Self::Safe, Self::Degenerate, Self::Opposed];
}

/// One sampled problem; owns what [`Problem`] borrows.
#[derive(Clone, Debug)]
pub struct Sample {
    horizon: Horizon,
    position: Position,
    target: Target,
    /// The rows, free to change.
    pub rows: Vec<Row>,
}

impl Sample {
    /// The problem number `index` of `seed`, with about `rows` rows (exactly, but for the families
    /// that add their own).
    pub fn new(family: Family, horizon: Horizon, rows: usize, seed: u64, index: u64) -> Self {
        let mut draw = Draw(random::stream(seed, Use::Problem, family as u64, index));
        let position = Position::new(draw.between(0.0, 25.0), draw.between(0.0, 25.0));
        let (distance, heading) = (draw.between(0.5, 20.0), draw.between(0.0, TAU));
        let set_point = position + direction(heading) * distance;
        let target = if family == Family::Safe { straight(position, set_point) } else { constant(set_point) };
        let mut sample = Self { horizon, position, target, rows: Vec::new() };
        let mut states = [Position::zeros(); MAX_HORIZON];
        ClosedForm::new(SAMPLE_TIME, 5.0, 10.0).solve(&sample.problem(), &mut Solution::default(), &mut states);
        for number in 0..rows {
            let step = 1 + random::below(&mut draw.0, horizon.steps() as u64) as usize;
            let hard = match family {
                Family::Hard | Family::Opposed => true,
                Family::Soft | Family::Safe => false,
                Family::Degenerate => number % 2 == 0,
            };
            let turn = if family == Family::Safe { 0.35 } else { 0.0 };
            let row = draw.row(step, &states, heading, turn, hard);
            sample.rows.push(row);
            if family == Family::Safe && number % 2 == 1 {
                let cell = draw.cell(position);
                sample.rows.push(cell);
            }
        }
        sample.distort(family, &mut draw, &states);
        sample
    }

    fn distort(&mut self, family: Family, draw: &mut Draw, states: &[Position; MAX_HORIZON]) {
        let last = self.horizon.steps();
        let Some(&row) = self.rows.first() else { return };
        if family == Family::Opposed {
            let gap = draw.between(0.01, 1.0);
            self.rows.push(Row { normal: -row.normal, offset: gap - row.offset, ..row });
        }
        if family == Family::Degenerate {
            // A copy, a soft copy, the same half plane one step later, one that touches the plan.
            self.rows.push(row);
            self.rows.push(Row { hard: false, ..row });
            self.rows.push(Row { step: (row.step + 1).min(last), hard: false, ..row });
            let touching = states[last - 1].dot(&row.normal);
            self.rows.push(Row { step: last, offset: touching, ..row });
        }
    }

    /// The problem, with the parameters of the paper.
    pub fn problem(&self) -> Problem<'_> {
        Problem {
            horizon: self.horizon,
            position: self.position,
            target: &self.target,
            rows: &self.rows,
            slack: SlackPrice { linear: 1e5, quadratic: 1e3 },
            sample_time: SAMPLE_TIME,
            max_speed: MAX_SPEED,
            state_weight: 5.0,
            input_weight: 10.0,
        }
    }
}

/// The set-point at every step, zero input.
fn constant(set_point: Position) -> Target {
    Target { kind: TargetKind::SetPoint, states: [set_point; MAX_HORIZON], inputs: [Input::zeros(); MAX_HORIZON] }
}

/// The straight line with the largest axis at full speed (ARCHITECTURE, rule 1).
fn straight(position: Position, set_point: Position) -> Target {
    let way = set_point - position;
    let at = |step: usize| position + way * (MAX_SPEED * SAMPLE_TIME * step as f64 / way.amax()).min(1.0);
    let mut target = constant(set_point);
    target.kind = TargetKind::Feasible;
    for l in 0..MAX_HORIZON {
        target.states[l] = at(l + 1);
        target.inputs[l] = (at(l + 1) - at(l)) / SAMPLE_TIME;
    }
    target
}

fn direction(angle: f64) -> Position {
    Position::new(angle.cos(), angle.sin())
}

struct Draw(ChaCha8Rng);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * random::unit(&mut self.0)
    }

    /// A VODCA row against a hazard near the plan's point at `step`.
    fn row(&mut self, step: usize, states: &[Position; MAX_HORIZON], heading: f64, turn: f64, hard: bool) -> Row {
        let distance = self.between(0.7, 1.499);
        let bearing = heading + self.between(-PI / 3.0, PI / 3.0);
        let hazard = states[step - 1] + direction(bearing) * distance;
        let normal = direction(bearing + PI + turn);
        Row { step, normal, offset: MIN_SEPARATION + normal.dot(&hazard), hard }
    }

    /// A hard first-step row that standing still satisfies (ARCHITECTURE, rule 5).
    fn cell(&mut self, position: Position) -> Row {
        let normal = direction(self.between(0.0, TAU));
        let offset = normal.dot(&position) - self.between(-0.05, 0.3).max(0.0);
        Row { step: 1, normal, offset, hard: true }
    }
}
