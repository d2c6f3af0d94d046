//! Layouts in which robots once waited for ever, kept so that they never do again.
#![allow(clippy::unwrap_used)] // a panic is how a test fails

use vodca::horizon::Horizon;
use vodca::metrics::RunMetrics;
use vodca::params::{Params, Profile};
use vodca::scenario::Scenario;
use vodca::team::Team;

/// Whether everybody arrives in `name` with `fixed` horizons, random ones without.
fn arrives(name: &str, fixed: Option<u64>, seed: u64, sets: &[&str]) -> bool {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    let params = Params::resolve(Profile::Safe, name, &Default::default(), &sets).unwrap();
    let scenario = Scenario::resolve(Some(name), None).unwrap();
    let mut team = Team::new(&scenario, &params, seed);
    let mut metrics = RunMetrics::new(&scenario, &params);
    for tick in 0..scenario.max_ticks {
        let horizon = |robot| {
            let base = fixed.map_or(Horizon::random(seed, robot, tick), |steps| Horizon::new(steps).unwrap());
            base.jittered(params.horizon.jitter, seed, robot, tick)
        };
        let horizons: Vec<Horizon> = (0..scenario.robots.len()).map(horizon).collect();
        let steps = team.step(&horizons);
        metrics.observe(tick, steps);
        if metrics.arrived_all() {
            return true;
        }
    }
    false
}

#[test]
fn pockets_are_left_along_the_way_round() {
    for name in ["pocket:6:0", "pocket:6:3"] {
        assert!(arrives(name, Some(20), 0, &[]), "{name}");
        let straight = arrives(name, Some(20), 0, &["mpc.reference=\"straight\""]);
        assert!(!straight, "{name} shows nothing any more: take another one");
    }
}

#[test]
fn lots_without_room_are_filled_from_their_middle() {
    for (name, fixed) in [("park:16:0", Some(20)), ("park:36:0", None), ("tight_ring:24:0", Some(20))] {
        assert!(arrives(name, fixed, 0, &[]), "{name}");
        let straight = arrives(name, fixed, 0, &["mpc.reference=\"straight\""]);
        assert!(!straight, "{name} shows nothing any more: take another one");
    }
}

#[test]
fn who_is_in_the_place_of_another_is_let_out() {
    for (name, seed) in [("park:16:28", 2), ("park:16:45", 4), ("park:36:98", 1)] {
        assert!(arrives(name, Some(20), seed, &[]), "{name}");
    }
}

#[test]
fn a_set_point_is_entered_from_a_side_on_which_nobody_stands() {
    for (name, seed) in [("park:36:76", 0), ("park:36:58", 0), ("park:36:37", 0)] {
        assert!(arrives(name, None, seed, &[]), "{name}");
    }
}

#[test]
fn robots_wedged_between_each_other_come_apart() {
    assert!(arrives("permute:16:2", Some(20), 1, &[]));
    let without = arrives("permute:16:2", Some(20), 1, &["vodca.back_off=1"]);
    assert!(!without, "shows nothing any more: take another one");
}

#[test]
fn lanes_for_one_robot_are_left_to_those_who_need_them() {
    // Without a toll on such lanes this one's robots met in them and had not arrived after 1,500 ticks.
    assert!(arrives("warehouse:20:64", None, 64, &[]));
}
