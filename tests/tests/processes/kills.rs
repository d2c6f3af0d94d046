//! One process of a team is killed at a random tick: nobody else is lost, nobody comes too near, all others arrive.

use crate::checked;
use vodca::random::{self, Use};

/// Kills in this sample; `./run.sh faults` does a thousand.
const KILLS: u64 = 30;

#[test]
fn a_kill_at_a_random_tick_costs_nobody_else_anything() {
    for kill in 0..KILLS {
        let mut draw = random::stream(2026, Use::Fault, kill, 0);
        let (robot, tick) = (random::below(&mut draw, 14), random::below(&mut draw, 80));
        let respawn = kill % 2;
        let exchange = if kill % 4 < 2 { "peer" } else { "relay" };
        let what =
            format!("14 --horizon random:{kill} --exchange {exchange} --respawn {respawn} --chaos kill:{robot}@{tick}");
        let finished = checked(&what);
        let summary = &finished.summary;
        assert_eq!(summary["pairs_below_min_separation"], 0, "{what}: {finished:?}");
        assert_eq!(summary["absences"].as_array().map(Vec::len), Some(1), "{what}: nobody else is lost: {finished:?}");
        assert_eq!(summary["end"], "arrived", "{what}: {finished:?}");
        let arrived = summary["robots"]
            .as_array()
            .map_or(0, |robots| robots.iter().filter(|robot| !robot["arrived_tick"].is_null()).count());
        let shut_off = summary["shut_off"].as_u64().unwrap_or_default() as usize;
        assert!(arrived + shut_off + 1 - respawn as usize >= 14, "{what}: {finished:?}");
        assert_eq!(finished.status.code() == Some(0), respawn == 1, "{what}: {finished:?}");
    }
}
