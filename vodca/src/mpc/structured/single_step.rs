//! One step of the dual active-set method of Goldfarb and Idnani (1983): adds one violated
//! constraint and drops those whose multipliers reach zero on the way.
//!
//! The multiplier of the added constraint grows; the others follow so that the active ones stay
//! equations. The dual cost rises strictly, so no active set returns; that is what the block steps
//! of the main loop fall back on.

use super::super::problem::{Problem, SolveError};
use super::active::{ActiveSet, Constraint, RowState};
use super::chain::Track;
use super::equality::{Budget, DEPENDENT, Equality, coupling, freest};
use super::small_factor::MAX_ACTIVE;
use crate::horizon::MAX_HORIZON;
use nalgebra::Vector2;

/// Rates of change below this share of the largest are rounding.
const NEGLIGIBLE: f64 = 1e-11;

/// The constraint being added and its multiplier so far.
#[derive(Clone, Copy, Debug)]
struct Added {
    constraint: Constraint,
    price: f64,
    /// A soft row beyond its linear price.
    violated: bool,
}

/// What ends a piece of the way, at which the directions change.
#[derive(Clone, Copy, Debug)]
enum Event {
    FreeInput {
        l: usize,
        axis: usize,
    },
    SetRow {
        index: usize,
        state: RowState,
    },
    /// The added soft row has reached its linear price.
    AddedViolated,
    /// The added constraint is met.
    Met,
}

/// Buffers of the step, allocated once.
#[derive(Clone, Debug)]
pub(super) struct SingleStep {
    states: Track,
    inputs: Track,
    gradient: Track,
    prices: Vec<f64>,
    /// Change of the members' multipliers per unit of the added one, negated.
    rates: Vec<f64>,
    /// How much a unit of the added multiplier opens each member.
    couplings: Vec<f64>,
    source: Track,
    drift: Track,
}

impl SingleStep {
    pub(super) fn new(row_capacity: usize) -> Self {
        let zero = [Vector2::zeros(); MAX_HORIZON];
        Self {
            states: zero,
            inputs: zero,
            gradient: zero,
            prices: Vec::with_capacity(row_capacity),
            rates: Vec::with_capacity(MAX_ACTIVE),
            couplings: Vec::with_capacity(MAX_ACTIVE),
            source: zero,
            drift: zero,
        }
    }

    /// Adds `constraint` to `set`, whose solution `equality` holds.
    ///
    /// `Infeasible` is proven: a non-negative combination of hard rows asks for more than the bounds
    /// can give. `GaveUp`: out of budget, or the numbers contradict each other.
    pub(super) fn run(
        &mut self,
        problem: &Problem<'_>,
        equality: &mut Equality,
        set: &mut ActiveSet,
        constraint: Constraint,
        budget: &mut Budget,
    ) -> Result<(), SolveError> {
        let steps = problem.horizon.steps();
        self.states = equality.chain.states;
        self.inputs = equality.chain.inputs;
        self.prices.clear();
        self.prices.extend_from_slice(&equality.prices);
        for l in 0..steps {
            self.gradient[l] = equality.chain.gradient(l, problem.target.inputs[l]);
        }
        let mut added = Added { constraint, price: 0.0, violated: false };
        loop {
            equality.assemble(problem, set, budget)?;
            let opening = self.direction(problem, equality, constraint);
            let (length, event) = self.next_event(problem, equality, set, added, opening);
            if !length.is_finite() {
                let proven = self.proves_infeasible(problem, equality, constraint);
                return Err(if proven { SolveError::Infeasible } else { budget.gave_up() });
            }
            for l in 0..steps {
                self.states[l] += equality.chain.states[l] * length;
                self.inputs[l] += equality.chain.inputs[l] * length;
                self.gradient[l] += equality.chain.gradient(l, Vector2::zeros()) * length;
            }
            for (&index, rate) in equality.members.iter().zip(&self.rates) {
                self.prices[index] -= rate * length;
            }
            added.price += length;
            match event {
                Event::FreeInput { l, axis } => set.bounds[l][axis] = 0,
                Event::SetRow { index, state } => {
                    set.rows[index] = state;
                    set.forget_open();
                }
                Event::AddedViolated => added.violated = true,
                Event::Met => {
                    set.add(constraint, if added.violated { RowState::Violated } else { RowState::Tight });
                    return Ok(());
                }
            }
        }
    }

    /// Fills `rates` and leaves in `equality.chain` the change of states and inputs, all per unit of
    /// the added multiplier. Returns how much the added constraint opens per unit.
    fn direction(&mut self, problem: &Problem<'_>, equality: &mut Equality, constraint: Constraint) -> f64 {
        let steps = problem.horizon.steps();
        self.source[..steps].fill(Vector2::zeros());
        self.drift[..steps].fill(Vector2::zeros());
        self.rates.clear();
        for &member in &equality.members {
            let row = &problem.rows[member];
            self.rates.push(match constraint {
                Constraint::Bound { l, axis, sign } => {
                    -f64::from(sign) * equality.chain.input_influence(row.step, l)[axis] * row.normal[axis]
                }
                Constraint::Row(index) => coupling(&equality.chain, problem, index, member),
            });
        }
        self.couplings.clear();
        self.couplings.extend_from_slice(&self.rates);
        equality.factor.solve(&mut self.rates);
        for (&member, rate) in equality.members.iter().zip(&self.rates) {
            let row = &problem.rows[member];
            self.source[row.step - 1] -= row.normal * *rate;
        }
        match constraint {
            Constraint::Bound { l, axis, sign } => {
                self.drift[l][axis] = -f64::from(sign) / (2.0 * problem.input_weight);
            }
            Constraint::Row(index) => {
                let row = &problem.rows[index];
                self.source[row.step - 1] += row.normal;
            }
        }
        equality.chain.solve(Vector2::zeros(), &self.source, &self.drift);
        match constraint {
            Constraint::Bound { l, axis, sign } => -f64::from(sign) * equality.chain.inputs[l][axis],
            Constraint::Row(index) => {
                let row = &problem.rows[index];
                row.normal.dot(&equality.chain.states[row.step - 1])
            }
        }
    }

    /// What the added constraint lacks at the present point: m/s or m.
    fn missing(&self, problem: &Problem<'_>, constraint: Constraint) -> f64 {
        match constraint {
            Constraint::Bound { l, axis, sign } => f64::from(sign) * self.inputs[l][axis] - problem.max_speed,
            Constraint::Row(index) => {
                let row = &problem.rows[index];
                -row.gap(&self.states[row.step - 1])
            }
        }
    }

    /// Sum of what the opening is the difference of: its rounding is a small share of this.
    fn magnitude(&self, problem: &Problem<'_>, constraint: Constraint) -> f64 {
        let alone = match constraint {
            Constraint::Bound { .. } => 1.0 / (2.0 * problem.input_weight),
            Constraint::Row(index) => freest(problem, problem.rows[index].step),
        };
        let cancelled = self.couplings.iter().zip(&self.rates).map(|(open, rate)| (open * rate).abs());
        cancelled.fold(alone, |sum, term| sum + term)
    }

    /// How far the multiplier of the added constraint, which opens it by `opening` per unit, can
    /// grow until something changes, and what. Infinite: for ever.
    fn next_event(
        &self,
        problem: &Problem<'_>,
        equality: &Equality,
        set: &ActiveSet,
        added: Added,
        opening: f64,
    ) -> (f64, Event) {
        let linear = problem.slack.linear;
        let missing = self.missing(problem, added.constraint);
        let reach = if added.violated {
            let compliance = 1.0 / problem.slack.quadratic;
            (missing - (added.price - linear) * compliance).max(0.0) / (opening + compliance)
        } else if opening > DEPENDENT * self.magnitude(problem, added.constraint) {
            missing.max(0.0) / opening
        } else {
            f64::INFINITY
        };
        let mut first = (reach, Event::Met);
        // Rates that are rounding of zero end nothing: forces that cancel leave about 1e-16 of them.
        let unit = if matches!(added.constraint, Constraint::Row(_)) { 1.0 } else { 1.0 / problem.sample_time };
        let negligible = NEGLIGIBLE * self.rates.iter().fold(unit, |a, r| a.max(r.abs()));
        let negligible_gradient = negligible * problem.sample_time;
        let mut consider = |left: f64, rate: f64, negligible: f64, event: Event| {
            // `left` shrinks by `rate` per unit; what is already gone ends the way at once.
            if rate > negligible && left.max(0.0) < first.0 * rate {
                first = (left.max(0.0) / rate, event);
            }
        };
        for l in 0..problem.horizon.steps() {
            if set.bounds[l] == [0; 2] {
                continue;
            }
            let change = equality.chain.gradient(l, Vector2::zeros());
            for axis in 0..2 {
                let sign = f64::from(set.bounds[l][axis]);
                consider(
                    -sign * self.gradient[l][axis],
                    sign * change[axis],
                    negligible_gradient,
                    Event::FreeInput { l, axis },
                );
            }
        }
        for (&index, &rate) in equality.members.iter().zip(&self.rates) {
            let have = self.prices[index];
            let state = |state| Event::SetRow { index, state };
            if set.rows[index] == RowState::Violated {
                consider(have - linear, rate, negligible, state(RowState::Tight));
            } else {
                consider(have, rate, negligible, state(RowState::Open));
                if !problem.rows[index].hard {
                    consider(linear - have, -rate, negligible, state(RowState::Violated));
                }
            }
        }
        if let Constraint::Row(index) = added.constraint
            && !problem.rows[index].hard
            && !added.violated
        {
            consider(linear - added.price, 1.0, 0.0, Event::AddedViolated);
        }
        first
    }

    /// Whether the direction proves infeasibility: rows weighted by what would grow for ever ask for
    /// more than the bounds can give. Holds for any weights >= 0, however they were computed.
    fn proves_infeasible(&mut self, problem: &Problem<'_>, equality: &Equality, constraint: Constraint) -> bool {
        let steps = problem.horizon.steps();
        self.source[..steps].fill(Vector2::zeros());
        let (mut asked, mut total) = (0.0, 0.0);
        let added = match constraint {
            Constraint::Row(index) => Some((index, 1.0)),
            Constraint::Bound { .. } => None,
        };
        let members = equality.members.iter().zip(&self.rates).map(|(&index, &rate)| (index, (-rate).max(0.0)));
        for (index, weight) in members.chain(added) {
            let row = &problem.rows[index];
            if !row.hard {
                continue;
            }
            self.source[row.step - 1] += row.normal * weight;
            asked -= weight * row.gap(&problem.position);
            total += weight;
        }
        let mut force = Vector2::<f64>::zeros();
        let mut given = 0.0;
        for l in (0..steps).rev() {
            force += self.source[l];
            given += problem.sample_time * problem.max_speed * force.abs().sum();
        }
        asked - given > 1e-9 * total
    }
}
