use super::*;
use crate::Input;
use crate::horizon::Horizon;
use crate::metrics;
use crate::prediction::Prediction;
use crate::scenario::{Obstacle, Robot};
use crate::step::Level;
use proptest::prelude::*;

fn at(x: f64, y: f64) -> Position {
    Position::new(x, y)
}

fn step(from: Position, to: Position) -> Step {
    Step {
        position: from,
        measured: from,
        input: Input::zeros(),
        next_position: to,
        next_measured: to,
        horizon: Horizon::MIN,
        rows: 0,
        level: Level::ClosedForm,
        status: Status::Solved,
        filtered: false,
        plan: Prediction::from_states(&[from, to], to),
        detect_ns: 0,
        solve_ns: 0,
        step_ns: 0,
    }
}

fn layout(robots: &[(Position, Position, Option<f64>)], obstacles: &[(Position, Option<f64>)]) -> Scenario {
    Scenario {
        name: "test".into(),
        robots: robots
            .iter()
            .enumerate()
            .map(|(i, &(start, set_point, radius))| Robot {
                name: format!("r{i}"),
                start,
                set_point,
                radius,
                max_speed: None,
            })
            .collect(),
        obstacles: obstacles
            .iter()
            .map(|&(position, radius)| Obstacle { name: "o".into(), position, radius })
            .collect(),
        shapes: Vec::new(),
        max_ticks: 10,
        seed: 0,
        allow_close_start: false,
        params: toml::Table::new(),
    }
}

#[test]
fn a_run_succeeds_when_all_are_there_at_the_same_tick() {
    let scenario = layout(&[(at(0.0, 0.0), at(1.0, 0.0), None), (at(0.0, 5.0), at(2.0, 5.0), None)], &[]);
    let mut metrics = RunMetrics::new(&scenario, &Params::paper());
    // Robot 0 passes through, leaves and comes back; robot 1 arrives at the last tick.
    let path = [(1.0, 0.5), (1.2, 1.0), (0.95, 1.95)];
    let mut before = (0.0, 0.0);
    for (tick, now) in path.into_iter().enumerate() {
        assert!(!metrics.arrived_all());
        metrics
            .observe(tick as u64, &[step(at(before.0, 0.0), at(now.0, 0.0)), step(at(before.1, 5.0), at(now.1, 5.0))]);
        before = now;
    }
    let summary = metrics.finish();
    assert!(summary.success && metrics.arrived_all());
    assert_eq!((summary.ticks, summary.completion_time), (3, Some(3.0 * 0.2)));
    assert_eq!((summary.robots[0].arrived_tick, summary.robots[1].arrived_tick), (Some(3), Some(3)));
    assert!((summary.path_cost - (1.0 + 0.2 + 0.25 + 1.95)).abs() < 1e-12);
    assert!((summary.path_ratio.unwrap() - 3.4 / 3.0).abs() < 1e-12);
    assert_eq!((summary.min_separation, summary.collisions), (Some(5.0), 0));
}

#[test]
fn a_collision_spoils_success_and_names_both_robots() {
    let scenario = layout(
        &[(at(0.0, 0.0), at(2.0, 0.0), None), (at(2.0, 0.0), at(0.0, 0.0), None), (at(9.0, 9.0), at(9.0, 9.0), None)],
        &[],
    );
    let mut metrics = RunMetrics::new(&scenario, &Params::paper());
    let stay = step(at(9.0, 9.0), at(9.0, 9.0));
    metrics.observe(0, &[step(at(0.0, 0.0), at(2.0, 0.0)), step(at(2.0, 0.0), at(0.0, 0.0)), stay]);
    let summary = metrics.finish();
    assert!(metrics.arrived_all() && !summary.success);
    assert_eq!(summary.min_separation, Some(0.0), "they met between the samples");
    assert_eq!((summary.collisions, summary.robots_collided, summary.ticks_collided), (1, 2, 1));
    assert_eq!((summary.pairs_below_min_separation, summary.ticks_below_min_separation), (1, 1));
    assert_eq!(summary.robots.iter().map(|robot| robot.collided).collect::<Vec<_>>(), [true, true, false]);
    assert_eq!(summary.robots[2].arrived_tick, Some(0));
}

#[test]
fn touching_is_not_below() {
    let scenario = layout(&[(at(0.0, 0.0), at(0.0, 0.0), None), (at(1.5 - 5e-7, 0.0), at(3.0, 0.0), None)], &[]);
    let mut metrics = RunMetrics::new(&scenario, &Params::paper());
    let steps = [step(at(0.0, 0.0), at(0.0, 0.0)), step(at(1.5 - 5e-7, 0.0), at(3.0, 0.0))];
    metrics.observe(0, &steps);
    assert_eq!(metrics.finish().ticks_below_min_separation, 0);
}

#[test]
fn rows_levels_and_statuses_are_counted_per_robot_and_in_all() {
    let scenario = layout(&[(at(0.0, 0.0), at(9.0, 0.0), None), (at(0.0, 5.0), at(9.0, 5.0), None)], &[]);
    let mut metrics = RunMetrics::new(&scenario, &Params::paper());
    let still = |y: f64| step(at(0.0, y), at(0.0, y));
    let outcomes =
        [(Level::Structured, Status::Relaxed), (Level::Fallback, Status::Shifted), (Level::Clarabel, Status::Held)];
    for (tick, (level, status)) in outcomes.into_iter().enumerate() {
        let busy = Step { rows: tick as u32, level, status, filtered: tick == 1, ..still(0.0) };
        metrics.observe(tick as u64, &[busy, still(5.0)]);
    }
    let summary = metrics.finish();
    assert_eq!((summary.activations, summary.ticks_with_rows, summary.infeasible, summary.filtered), (3, 2, 2, 1));
    assert_eq!((summary.robots[0].fallback_steps, summary.robots[1].fallback_steps), (1, 0));
    let levels = SolverLevels { closed_form: 3, structured: 1, clarabel: 1, fallback: 1, baseline: 0 };
    assert_eq!(summary.solver_levels, levels);
    assert_eq!(summary.statuses, Statuses { solved: 3, relaxed: 1, held: 1, shifted: 1, ..Statuses::default() });
    assert_eq!((summary.success, summary.completion_time), (false, None));
}

#[test]
fn json_holds_null_where_there_is_nothing_to_meet() {
    let scenario = layout(&[(at(0.0, 0.0), at(0.0, 0.0), None)], &[]);
    let summary = RunMetrics::new(&scenario, &Params::paper()).finish();
    assert!(summary.success, "it is there already");
    let json = serde_json::to_value(&summary).unwrap();
    assert!(json["min_separation"].is_null() && json["path_ratio"].is_null());
    assert_eq!(json["robots"][0]["arrived_tick"], 0);
    assert_eq!(serde_json::from_value::<RunSummary>(json).unwrap(), summary);
}

/// An independent implementation wrote these runs and their figures.
#[test]
fn it_finds_the_figures_of_the_reference_runs() {
    let golden: serde_json::Value =
        serde_json::from_str(include_str!("../../../tests/golden/safe_closed_loop.json")).unwrap();
    let points = |list: &serde_json::Value| -> Vec<Position> {
        let list: Vec<[f64; 2]> = serde_json::from_value(list.clone()).unwrap();
        list.into_iter().map(Position::from).collect()
    };
    let mut whole_runs = 0;
    for case in golden["cases"].as_array().unwrap() {
        let positions: Vec<Vec<Position>> = case["positions"].as_array().unwrap().iter().map(points).collect();
        let set_points = points(&case["goal"]);
        let robots: Vec<_> = positions[0].iter().zip(&set_points).map(|(&start, &goal)| (start, goal, None)).collect();
        let obstacles: Vec<_> = points(&case["obstacles"]).into_iter().map(|position| (position, None)).collect();
        let mut metrics = RunMetrics::new(&layout(&robots, &obstacles), &Params::safe());
        for (tick, pair) in positions.windows(2).enumerate() {
            assert!(!metrics.arrived_all(), "{} at {tick}", case["name"]);
            let steps: Vec<Step> = pair[0].iter().zip(&pair[1]).map(|(&from, &to)| step(from, to)).collect();
            metrics.observe(tick as u64, &steps);
        }
        let summary = metrics.finish();
        let least = case["min_separation"].as_f64().unwrap();
        assert!((summary.min_separation.unwrap() - least).abs() < 1e-8, "{}: {summary:?}", case["name"]);
        let whole = &case["whole_run"];
        if whole["steps"].as_u64() == Some(summary.ticks) {
            whole_runs += 1;
            assert!((summary.path_cost - whole["path"].as_f64().unwrap()).abs() < 1e-6, "{}", case["name"]);
            assert_eq!(Some(summary.success), whole["ok"].as_bool(), "{}", case["name"]);
        }
    }
    assert!(whole_runs >= 10, "{whole_runs}");
}

/// Positions of robots over ticks, `[tick][robot]`, radii and obstacles.
type Run = (Vec<Vec<Position>>, Vec<Option<f64>>, Vec<(Position, Option<f64>)>);

fn runs() -> impl Strategy<Value = Run> {
    let point = || (-4.0f64..4.0, -4.0f64..4.0).prop_map(|(x, y)| at(x, y));
    let radius = || prop::option::of(0.2f64..1.5);
    (1usize..6, 1usize..8).prop_flat_map(move |(robots, ticks)| {
        (
            prop::collection::vec(prop::collection::vec(point(), robots), ticks + 1),
            prop::collection::vec(radius(), robots),
            prop::collection::vec((point(), radius()), 0..3),
        )
    })
}

proptest! {
    #[test]
    fn it_finds_what_comparing_everything_finds((positions, radii, obstacles) in runs()) {
        let params = Params::paper();
        let robots: Vec<_> = positions[0].iter().zip(&radii).map(|(&start, &radius)| (start, at(9.0, 9.0), radius)).collect();
        let scenario = layout(&robots, &obstacles);
        let mut metrics = RunMetrics::new(&scenario, &params);
        let n = robots.len();
        let half = 0.75;
        // One entry per pair: its separations over time.
        let extra: Vec<f64> = radii.iter().map(|r| r.map_or(0.0, |r| r - half)).collect();
        let discs = scenario.discs(1.5);
        let mut least = vec![f64::INFINITY; n];
        let mut pairs = std::collections::BTreeMap::new();
        let (mut below, mut collided) = (0, 0);
        for (tick, pair) in positions.windows(2).enumerate() {
            let moves: Vec<_> = pair[0].iter().copied().zip(pair[1].iter().copied()).collect();
            let steps: Vec<Step> = moves.iter().map(|&(from, to)| step(from, to)).collect();
            metrics.observe(tick as u64, &steps);
            for i in 0..n {
                for j in 0..n + discs.len() {
                    let (other, more) = match j.checked_sub(n) {
                        Some(l) => ((discs[l].centre, discs[l].centre), discs[l].extra),
                        None => (moves[j], extra[j]),
                    };
                    if i != j {
                        let found = separation(moves[i], other) - (extra[i.min(j)] + if j < i { extra[i] } else { more });
                        least[i] = least[i].min(found);
                        let worst = pairs.entry((i.min(j), i.max(j))).or_insert(f64::INFINITY);
                        *worst = f64::min(*worst, found);
                    }
                }
            }
            let now = metrics::min_separation(&moves, &extra, &discs);
            below += u64::from(now < 1.5 - SEPARATION_TOLERANCE);
            collided += u64::from(now < 0.75);
        }
        let summary = metrics.finish();
        for (robot, &least) in summary.robots.iter().zip(&least) {
            prop_assert_eq!(robot.min_separation, finite(least));
        }
        let count = |limit: f64| pairs.values().filter(|&&worst| worst < limit).count() as u64;
        prop_assert_eq!(summary.pairs_below_min_separation, count(1.5 - SEPARATION_TOLERANCE));
        prop_assert_eq!(summary.collisions, count(0.75));
        prop_assert_eq!(summary.ticks_below_min_separation, below);
        prop_assert_eq!(summary.ticks_collided, collided);
        let path: f64 = positions.windows(2).flat_map(|p| p[0].iter().zip(&p[1])).map(|(a, b)| (b - a).norm()).sum();
        prop_assert!((summary.path_cost - path).abs() < 1e-9);
    }
}
