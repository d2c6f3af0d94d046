//! The QP of one robot at one tick, as a structured problem: every solver builds what suits it.

use crate::horizon::{Horizon, MAX_HORIZON};
use crate::{Input, Position};

/// One collision row: `normal . x[step] >= offset` in metres, with a unit `normal`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Prediction step 1..=N the row acts on.
    pub step: usize,
    /// Unit vector pointing from the hazard to the free side.
    pub normal: Position,
    /// Signed distance of the half plane from the world's origin along `normal`, m.
    pub offset: f64,
    /// Hard rows hold exactly; soft rows have a slack with an exact penalty.
    pub hard: bool,
}

impl Row {
    /// Signed distance of `position` from the row's half plane, m; negative where it is violated.
    pub fn gap(&self, position: &Position) -> f64 {
        self.normal.dot(position) - self.offset
    }
}

/// Price of violating a soft row by `e` metres: `linear * e + quadratic / 2 * e^2`
/// (ours: the paper does not say what happens when hard rows have no solution).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlackPrice {
    /// Per metre.
    pub linear: f64,
    /// Per square metre.
    pub quadratic: f64,
}

/// `min sum_{l=1..N} q |x[l] - state_target[l-1]|^2 + sum_{l=0..N-1} w |u[l] - input_target[l]|^2`
/// subject to `x[l+1] = x[l] + h u[l]`, `|u| <= max_speed` per axis, and the rows. No 1/2 in front.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// N.
    pub horizon: Horizon,
    /// `x[0]`, the measured position, m.
    pub position: Position,
    /// What the plan is drawn to.
    pub target: &'a Target,
    /// Collision rows; any number, any order.
    pub rows: &'a [Row],
    /// Slack price of the rows that are not hard.
    pub slack: SlackPrice,
    /// h, s.
    pub sample_time: f64,
    /// Bound on |u| per axis, m/s.
    pub max_speed: f64,
    /// Q = q I.
    pub state_weight: f64,
    /// W = w I.
    pub input_weight: f64,
}

impl Problem<'_> {
    /// Whether every number of the problem is finite and every row's step lies in 1..=N. Solvers
    /// give up at once where this does not hold.
    pub fn is_well_posed(&self) -> bool {
        let steps = self.horizon.steps();
        let finite = |v: &Position| v.x.is_finite() && v.y.is_finite();
        finite(&self.position)
            && self.target.states[..steps].iter().all(finite)
            && self.target.inputs[..steps].iter().all(finite)
            && self
                .rows
                .iter()
                .all(|row| finite(&row.normal) && row.offset.is_finite() && (1..=steps).contains(&row.step))
            && [self.state_weight, self.slack.linear, self.slack.quadratic].iter().all(|v| v.is_finite() && *v >= 0.0)
            && [self.sample_time, self.max_speed, self.input_weight].iter().all(|v| v.is_finite() && *v > 0.0)
    }
}

/// The targets of state and input at every step.
#[derive(Clone, Debug)]
pub struct Target {
    /// How the targets were made, which tells the closed form that applies.
    pub kind: TargetKind,
    /// Target of x[l + 1] at index l; N entries are used.
    pub states: [Position; MAX_HORIZON],
    /// Target of `u[l]` at index l; N entries are used.
    pub inputs: [Input; MAX_HORIZON],
}

/// How a target was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetKind {
    /// All states the set-point, all inputs zero (the paper).
    SetPoint,
    /// A reference that starts at `x[0]`, obeys the model and the bounds: it is the free optimum itself.
    Feasible,
}

/// A solver's answer: `inputs[..N]`.
#[derive(Clone, Debug)]
pub struct Solution {
    /// `u[l]` at index l, m/s; entries from N on are zero.
    pub inputs: [Input; MAX_HORIZON],
}

impl Default for Solution {
    fn default() -> Self {
        Self { inputs: [Input::zeros(); MAX_HORIZON] }
    }
}

impl Solution {
    /// Puts `x[l + 1]` at index `l < N` of `states`, by the model from `problem.position`.
    pub fn roll_out(&self, problem: &Problem<'_>, states: &mut [Position; MAX_HORIZON]) {
        let mut state = problem.position;
        let steps = problem.horizon.steps();
        for (next, input) in states[..steps].iter_mut().zip(&self.inputs) {
            state += input * problem.sample_time;
            *next = state;
        }
    }

    /// Largest difference of an input, m/s; not a number if one of them is not.
    pub fn largest_difference(&self, other: &Self) -> f64 {
        let pairs = self.inputs.iter().zip(&other.inputs);
        pairs.flat_map(|(a, b)| [(a.x - b.x).abs(), (a.y - b.y).abs()]).fold(0.0, |largest, difference| {
            if difference > largest || difference.is_nan() { difference } else { largest }
        })
    }

    /// Cost of the inputs, slack included (hard rows are not looked at).
    pub fn cost(&self, problem: &Problem<'_>) -> f64 {
        let mut states = [Position::zeros(); MAX_HORIZON];
        self.roll_out(problem, &mut states);
        let mut cost = 0.0;
        let steps = problem.horizon.steps();
        for (state, target) in states[..steps].iter().zip(&problem.target.states) {
            cost += problem.state_weight * (state - target).norm_squared();
        }
        for (input, target) in self.inputs[..steps].iter().zip(&problem.target.inputs) {
            cost += problem.input_weight * (input - target).norm_squared();
        }
        for row in problem.rows.iter().filter(|row| !row.hard) {
            let excess = (-row.gap(&states[row.step - 1])).max(0.0);
            cost += excess * (problem.slack.linear + 0.5 * problem.slack.quadratic * excess);
        }
        cost
    }
}

/// What a solver did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Iterations of the solver's main loop.
    pub iterations: u32,
}

/// Why a solver gave no plan. `plan` then holds nothing of use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SolveError {
    /// The hard rows and bounds admit no input.
    #[error("no input satisfies the bounds and the hard collision rows")]
    Infeasible,
    /// The solver stopped at its iteration cap or lost its numbers; another solver may finish.
    #[error("the solver gave up after {iterations} iterations")]
    GaveUp {
        /// Iterations spent.
        iterations: u32,
    },
}

/// One way to solve a [`Problem`].
pub trait QpSolver {
    /// Writes the optimal inputs to `plan`.
    fn solve(&mut self, problem: &Problem<'_>, plan: &mut Solution) -> Result<Effort, SolveError>;
}
