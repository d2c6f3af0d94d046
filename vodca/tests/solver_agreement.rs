//! Our solver against Clarabel at 1e-10 (polished) on more than 20,000 random QPs, by family.

use vodca::Position;
use vodca::horizon::{Horizon, MAX_HORIZON};
use vodca::mpc::clarabel::Clarabel;
use vodca::mpc::closed_form::ClosedForm;
use vodca::mpc::problem::{Problem, QpSolver, Solution, SolveError, Target};
use vodca::mpc::sample::{Family, Sample};
use vodca::mpc::structured::Structured;

const HORIZONS: [u64; 7] = [1, 2, 5, 10, 20, 30, 49];
const SAMPLES: u64 = 210;
/// Largest difference of an input, m/s.
const ALLOWED: f64 = 1e-6;

#[derive(Debug, Default)]
struct Tally {
    solved: u64,
    infeasible: u64,
    given_up: u64,
    worst: f64,
}

impl Tally {
    /// Solves with both and compares plan or verdict.
    fn compare(&mut self, mine: &mut Structured, problem: &Problem<'_>, start: &Solution, name: &str) {
        let mut plan = start.clone();
        let mut reference = Solution::default();
        let theirs = Clarabel::reference().solve(problem, &mut reference);
        match (mine.solve(problem, &mut plan), theirs) {
            (Err(SolveError::GaveUp { .. }), Ok(_) | Err(SolveError::Infeasible)) => self.given_up += 1,
            (Ok(_), Ok(_)) => {
                let difference = plan.largest_difference(&reference);
                assert!(difference <= ALLOWED, "{name}: inputs differ by {difference:e} m/s");
                self.worst = self.worst.max(difference);
                self.solved += 1;
            }
            (Err(SolveError::Infeasible), Err(SolveError::Infeasible)) => self.infeasible += 1,
            (mine, theirs) => panic!("{name}: structured {mine:?}, Clarabel {theirs:?}"),
        }
    }

    /// At most one in a thousand goes to the next solver.
    fn conclude(&self, family: &str, at_least: u64) {
        println!("{family}: {self:?}");
        let total = self.solved + self.infeasible + self.given_up;
        assert!(total >= at_least, "{family}: {self:?}");
        assert!(self.given_up * 1000 <= total, "{family}: {self:?}");
    }
}

fn family_agrees(family: Family) -> Tally {
    let mut tally = Tally::default();
    let mut solver = Structured::default();
    let mut closed_form = ClosedForm::new(0.2, 5.0, 10.0);
    for n in HORIZONS {
        for rows in [1, 3, 10] {
            for index in 0..SAMPLES {
                let horizon = Horizon::saturating(n as i64);
                let sample = Sample::new(family, horizon, rows, n * 100 + rows as u64, index);
                let mut start = Solution::default();
                closed_form.solve(&sample.problem(), &mut start, &mut [Position::zeros(); MAX_HORIZON]);
                let name = format!("{family:?}, N = {n}, {rows} rows, sample {index}");
                tally.compare(&mut solver, &sample.problem(), &start, &name);
            }
        }
    }
    tally.conclude(&format!("{family:?}"), 7 * 3 * SAMPLES);
    tally
}

#[test]
fn hard_rows_get_the_same_plan_or_the_same_verdict() {
    let tally = family_agrees(Family::Hard);
    assert!(tally.infeasible > 500 && tally.solved > 2500, "{tally:?}");
}

#[test]
fn soft_rows_get_the_same_plan() {
    assert_eq!(family_agrees(Family::Soft).infeasible, 0);
}

#[test]
fn soft_rows_beside_hard_first_steps_get_the_same_plan() {
    assert_eq!(family_agrees(Family::Safe).infeasible, 0);
}

#[test]
fn rows_that_depend_on_each_other_get_the_same_plan_or_verdict() {
    let tally = family_agrees(Family::Degenerate);
    assert!(tally.infeasible > 300 && tally.solved > 2500, "{tally:?}");
}

#[test]
fn opposing_rows_are_infeasible_for_both() {
    assert_eq!(family_agrees(Family::Opposed).solved, 0);
}

#[test]
fn without_rows_the_closed_form_is_the_plan_of_both() {
    for family in [Family::Hard, Family::Safe] {
        for n in HORIZONS {
            for index in 0..60 {
                let sample = Sample::new(family, Horizon::new(n).unwrap(), 0, n, index);
                let problem = sample.problem();
                let (mut closed, mut mine, mut reference) =
                    (Solution::default(), Solution::default(), Solution::default());
                let mut states = [Position::zeros(); MAX_HORIZON];
                assert!(ClosedForm::new(0.2, 5.0, 10.0).solve(&problem, &mut closed, &mut states));
                Structured::default().solve(&problem, &mut mine).unwrap();
                Clarabel::reference().solve(&problem, &mut reference).unwrap();
                assert!(closed.largest_difference(&mine) < 1e-11, "{family:?}, N = {n}, sample {index}");
                assert!(closed.largest_difference(&reference) < 1e-11, "{family:?}, N = {n}, sample {index}");
            }
        }
    }
}

#[test]
fn other_weights_bounds_and_targets_get_the_same_plan() {
    let mut tally = Tally::default();
    let mut solver = Structured::default();
    for (state_weight, input_weight, sample_time, max_speed) in
        [(0.0, 1.0, 0.2, 1.5), (50.0, 0.5, 0.1, 3.0), (1.0, 200.0, 0.5, 0.5), (5.0, 10.0, 0.05, 10.0)]
    {
        for n in HORIZONS {
            for index in 0..40 {
                let family = [Family::Soft, Family::Degenerate][index as usize % 2];
                let sample = Sample::new(family, Horizon::new(n).unwrap(), 4, 77, index);
                let mut target = Target::clone(sample.problem().target);
                // Targets that jump and that no input within the bounds follows.
                for l in 0..n as usize {
                    target.states[l] += Position::new((l as f64).sin(), (2.0 * l as f64).cos()) * 3.0;
                    target.inputs[l] = Position::new((3.0 * l as f64).cos(), (l as f64).sin()) * 2.0;
                }
                let problem =
                    Problem { state_weight, input_weight, sample_time, max_speed, target: &target, ..sample.problem() };
                let name = format!("weights {state_weight} {input_weight}, N = {n}, sample {index}");
                tally.compare(&mut solver, &problem, &Solution::default(), &name);
            }
        }
    }
    tally.conclude("other parameters", 1120);
}
