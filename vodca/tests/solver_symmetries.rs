//! What must not change a plan, or must change it in a known way, whatever the solver.

use proptest::prelude::*;
use vodca::horizon::Horizon;
use vodca::mpc::ladder::Ladder;
use vodca::mpc::problem::{Problem, QpSolver, Row, Solution, SolveError, Target};
use vodca::mpc::sample::{Family, Sample};
use vodca::mpc::structured::Structured;
use vodca::{Input, Position};

fn solve(problem: &Problem<'_>) -> Result<Solution, SolveError> {
    let mut plan = Solution::default();
    Ladder::default().solve(problem, &mut plan).map(|_| plan)
}

/// Both plans within `tolerance` m/s, or the same error.
fn same(a: &Result<Solution, SolveError>, b: &Result<Solution, SolveError>, tolerance: f64) -> bool {
    match (a, b) {
        (Ok(a), Ok(b)) => a.largest_difference(b) <= tolerance,
        (a, b) => a.as_ref().err() == b.as_ref().err(),
    }
}

/// The problem with every point moved by `map` and every direction by `turn`.
fn moved(
    problem: &Problem<'_>,
    map: impl Fn(Position) -> Position,
    turn: impl Fn(Position) -> Position,
) -> (Target, Vec<Row>, Position) {
    let mut target = problem.target.clone();
    target.states = target.states.map(&map);
    target.inputs = target.inputs.map(&turn);
    let rows = problem.rows.iter().map(|row| {
        let normal = turn(row.normal);
        // A point of the half plane's edge goes along.
        let edge = map(row.normal * row.offset);
        Row { normal, offset: normal.dot(&edge), ..*row }
    });
    (target, rows.collect(), map(problem.position))
}

fn samples() -> impl Strategy<Value = Sample> {
    let family = prop_oneof![Just(Family::Hard), Just(Family::Soft), Just(Family::Safe), Just(Family::Degenerate)];
    (family, 1u64..=49, 1usize..8, 0u64..1 << 32)
        .prop_map(|(family, n, rows, seed)| Sample::new(family, Horizon::saturating(n as i64), rows, seed, 0))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_shift_of_the_world_changes_no_input(sample in samples(), x in -50.0..50.0f64, y in -50.0..50.0f64) {
        let problem = sample.problem();
        let (target, rows, position) = moved(&problem, |p| p + Position::new(x, y), |d| d);
        let shifted = Problem { target: &target, rows: &rows, position, ..problem };
        prop_assert!(same(&solve(&problem), &solve(&shifted), 1e-8));
    }

    #[test]
    fn mirrored_and_swapped_worlds_give_mirrored_and_swapped_inputs(sample in samples()) {
        let problem = sample.problem();
        for turn in [|d: Position| Position::new(-d.x, d.y), |d: Position| Position::new(d.y, d.x)] {
            let (target, rows, position) = moved(&problem, turn, turn);
            let image = Problem { target: &target, rows: &rows, position, ..problem };
            let expected = solve(&problem).map(|plan| Solution { inputs: plan.inputs.map(turn) });
            prop_assert!(same(&expected, &solve(&image), 1e-8));
        }
    }

    #[test]
    fn the_order_of_the_rows_and_copies_of_them_change_nothing(sample in samples()) {
        let problem = sample.problem();
        let plan = solve(&problem);
        let reversed: Vec<Row> = problem.rows.iter().rev().copied().collect();
        let again = solve(&Problem { rows: &reversed, ..problem });
        prop_assert!(same(&plan, &again, 1e-8));
        // A copy of a violated soft row costs twice; copies of hard rows cost nothing.
        let copies: Vec<Row> = problem.rows.iter().flat_map(|row| vec![*row; 1 + usize::from(row.hard)]).collect();
        let again = solve(&Problem { rows: &copies, ..problem });
        prop_assert!(same(&plan, &again, 1e-8));
    }

    #[test]
    fn a_row_that_the_plan_satisfies_changes_nothing(sample in samples(), angle in 0.0..6.3f64, room in 1e-6..5.0f64) {
        let problem = sample.problem();
        if let Ok(plan) = solve(&problem) {
            let mut states = [Position::zeros(); 49];
            plan.roll_out(&problem, &mut states);
            let normal = Position::new(angle.cos(), angle.sin());
            let step = problem.horizon.steps();
            let mut rows = problem.rows.to_vec();
            rows.push(Row { step, normal, offset: normal.dot(&states[step - 1]) - room, hard: true });
            let again = solve(&Problem { rows: &rows, ..problem });
            prop_assert!(same(&Ok(plan), &again, 1e-8));
        }
    }

    #[test]
    fn the_exact_penalty_gives_the_hard_plan_where_there_is_one(n in 1u64..=49, m in 1usize..6, seed in 0u64..1 << 32) {
        let hard = Sample::new(Family::Hard, Horizon::new(n).unwrap(), m, seed, 0);
        let problem = hard.problem();
        let mut solver = Structured::default();
        let mut plan = Solution::default();
        // Exact as long as no multiplier exceeds the price.
        if solver.solve(&problem, &mut plan).is_ok() && solver.multipliers().iter().all(|&m| m < 1e5) {
            let soft: Vec<Row> = problem.rows.iter().map(|row| Row { hard: false, ..*row }).collect();
            let again = solve(&Problem { rows: &soft, ..problem });
            prop_assert!(same(&Ok(plan), &again, 1e-8));
        }
    }

    #[test]
    fn half_planes_that_exclude_each_other_are_infeasible(sample in samples(), gap in 1e-6..2.0f64, angle in 0.0..6.3f64) {
        let problem = sample.problem();
        let normal = Position::new(angle.cos(), angle.sin());
        let step = problem.horizon.steps();
        let offset = normal.dot(&problem.position);
        let mut rows = problem.rows.to_vec();
        rows.push(Row { step, normal, offset, hard: true });
        rows.push(Row { step, normal: -normal, offset: gap - offset, hard: true });
        prop_assert_eq!(solve(&Problem { rows: &rows, ..problem }).err(), Some(SolveError::Infeasible));
    }

    #[test]
    fn no_other_admissible_input_is_cheaper(sample in samples(), change in prop::collection::vec(-1.0..1.0f64, 98)) {
        let problem = sample.problem();
        if let Ok(plan) = solve(&problem) {
            let cost = plan.cost(&problem);
            for size in [1e-3, 1e-1, 1.0] {
                let mut other = plan.clone();
                for (l, input) in other.inputs[..problem.horizon.steps()].iter_mut().enumerate() {
                    let moved = *input + Input::new(change[2 * l], change[2 * l + 1]) * size;
                    *input = moved.map(|u| u.clamp(-problem.max_speed, problem.max_speed));
                }
                let mut states = [Position::zeros(); 49];
                other.roll_out(&problem, &mut states);
                let admissible = problem.rows.iter().all(|row| !row.hard || row.gap(&states[row.step - 1]) >= 0.0);
                prop_assert!(!admissible || other.cost(&problem) >= cost - 1e-9 * cost.abs());
            }
        }
    }
}

#[test]
fn at_its_set_point_a_robot_stands_still() {
    let sample = Sample::new(Family::Hard, Horizon::new(30).unwrap(), 0, 1, 0);
    let problem = sample.problem();
    let mut target = problem.target.clone();
    target.states.fill(problem.position);
    let plan = solve(&Problem { target: &target, ..problem }).unwrap();
    assert_eq!(plan.inputs, Solution::default().inputs);
}

#[test]
fn one_step_towards_a_wall_stops_at_the_wall() {
    let sample = Sample::new(Family::Hard, Horizon::MIN, 0, 1, 0);
    let mut target = sample.problem().target.clone();
    target.states.fill(Position::new(10.0, 0.0));
    let wall = [Row { step: 1, normal: Position::new(-1.0, 0.0), offset: -0.1, hard: true }];
    let problem = Problem { target: &target, rows: &wall, position: Position::zeros(), ..sample.problem() };
    let plan = solve(&problem).unwrap();
    assert!((plan.inputs[0] - Input::new(0.5, 0.0)).amax() < 1e-12, "{:?}", plan.inputs[0]);
}
