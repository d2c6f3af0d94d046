//! Environment ticks per second: what learning and sweeps live on.

use super::row::Results;
use super::teams::{Load, TeamSpec, drive};
use super::{BenchError, Extent};
use crate::in_process::run_whole;
use shared::exchange::Kind;
use std::time::{Duration, Instant};
use vodca::horizon::Horizon;
use vodca::horizon_source::{HorizonSource, HorizonSpec};
use vodca::params::Profile;
use vodca::scenario::set_up;

const SCENARIO: &str = "ex14_d";

/// Fourteen robots with the profile `safe`, as processes and in one process.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    let episodes = extent.pick(8, 1);
    extent.tell("ticks per second", 2 * episodes + 1);
    for (kind, name) in [(Kind::Peer, "peer"), (Kind::Relay, "relay")] {
        let (mut ticks, mut driving) = (0, Duration::ZERO);
        for _ in 0..episodes {
            let spec = TeamSpec {
                scenario: SCENARIO,
                load: Load::Safe,
                kind: Some(kind),
                real_time: false,
                ticks: extent.pick(1_000, 5),
            };
            let driven = drive(&spec, extent.stop, &mut |_| Ok(()))?;
            ticks += driven.ticks;
            driving += driven.driving;
            extent.advance()?;
        }
        let per_second = ticks as f64 / driving.as_secs_f64().max(f64::MIN_POSITIVE);
        results.figure("scale", format!("14 processes, safe, {name}"), per_second, "ticks/s");
    }
    let (mut scenario, params) = set_up(Some(SCENARIO), None, Profile::Safe, &[])?;
    scenario.max_ticks = extent.pick(scenario.max_ticks, 5);
    let spec = HorizonSpec::Fixed(vec![Horizon::saturating(20)]);
    let source = HorizonSource::new(&spec, scenario.robots.len(), scenario.seed, params.horizon.jitter)?;
    let (mut ticks, start) = (0, Instant::now());
    for _ in 0..extent.pick(40, 1) {
        ticks += run_whole(&scenario, &params, &source, |_| {}).ticks;
    }
    results.figure("scale", "14 robots, safe, in one process", ticks as f64 / start.elapsed().as_secs_f64(), "ticks/s");
    extent.advance()
}
