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
fn pockets_between_obstacles_and_parked_robots_are_left() {
    for seed in [52, 62] {
        let name = format!("box:{}:2:{seed}", if seed == 52 { 10 } else { 20 });
        assert!(arrives(&name, None, seed, &[]), "{name}");
        assert!(!arrives(&name, None, seed, &["vodca.patience=1"]), "{name} shows nothing any more: take another one");
    }
}

#[test]
fn robots_wedged_between_each_other_come_apart() {
    assert!(arrives("rand48o0_s3", Some(10), 101, &[]));
    let without = arrives("rand48o0_s3", Some(10), 101, &["vodca.back_off=1"]);
    assert!(!without, "shows nothing any more: take another one");
}
