//! Environment ticks per second: what learning and comparisons live on.

use super::row::Results;
use super::teams::{Load, TeamSpec, drive};
use super::{BenchError, Extent, Options, cost};
use crate::in_process::run_whole;
use coordinator::run::RunTick;
use shared::exchange::Kind;
use std::time::Instant;
use vodca::horizon::Horizon;
use vodca::horizon_source::{HorizonSource, HorizonSpec};
use vodca::params::Profile;
use vodca::scenario::set_up;

const SCENARIO: &str = "ex14_d";
const ROBOTS: usize = 14;
const TICKS: u64 = 20_000;
const KINDS: [(Kind, &str); 2] = [(Kind::Peer, "peer"), (Kind::Relay, "relay")];

fn ticks(options: &Options) -> u64 {
    options.pick(TICKS, 5)
}

/// What driving that team as processes is expected to take, s.
fn as_processes(options: &Options, kind: Kind) -> f64 {
    ticks(options) as f64 * cost::tick(kind, Load::Safe, ROBOTS) + cost::start(ROBOTS)
}

/// And in one process.
fn in_one(options: &Options) -> f64 {
    ticks(options) as f64 * ROBOTS as f64 * cost::STEP
}

/// What this is expected to take, s.
pub(super) fn seconds(options: &Options) -> f64 {
    KINDS.map(|(kind, _)| as_processes(options, kind)).iter().sum::<f64>() + in_one(options)
}

/// Fourteen robots with the profile `safe`, as processes and in one process.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    extent.tell("ticks per second");
    let wanted = ticks(extent.options);
    for (kind, name) in KINDS {
        let spec = TeamSpec { scenario: SCENARIO, load: Load::Safe, kind: Some(kind), real_time: false, ticks: wanted };
        let driven = drive(&spec, extent.stop, &mut |_, _: &RunTick<'_>| Ok(()))?;
        let per_second = driven.ticks as f64 / driven.driving.as_secs_f64().max(f64::MIN_POSITIVE);
        results.figure("scale", format!("14 processes, safe, {name}"), per_second, "ticks/s");
        extent.advance(as_processes(extent.options, kind))?;
    }
    let (mut scenario, params) = set_up(Some(SCENARIO), None, Profile::Safe, &[])?;
    scenario.max_ticks = scenario.max_ticks.min(wanted);
    let spec = HorizonSpec::Fixed(vec![Horizon::saturating(20)]);
    let source = HorizonSource::new(&spec, scenario.robots.len(), scenario.seed, params.horizon.jitter)?;
    let (mut ticks, start) = (0, Instant::now());
    while ticks < wanted {
        ticks += run_whole(&scenario, &params, &source, |_| {}).ticks;
    }
    results.figure("scale", "14 robots, safe, in one process", ticks as f64 / start.elapsed().as_secs_f64(), "ticks/s");
    extent.advance(in_one(extent.options))
}
