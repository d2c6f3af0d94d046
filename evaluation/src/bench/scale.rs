//! Large teams: how long they take to start, and what a tick takes at the pace of real time.

use super::row::Results;
use super::teams::{Load, TeamSpec, drive};
use super::{BenchError, Extent, Options, cost, real_time};
use coordinator::run::RunTick;

/// Sizes of teams.
const ROBOTS: [usize; 5] = [2, 14, 50, 100, 200];
/// Starts of every team; their median counts.
const STARTS: usize = 5;

fn sizes(options: &Options) -> Vec<usize> {
    options.sizes(&ROBOTS, &[2, 3])
}

/// What this is expected to take, s.
pub(super) fn seconds(options: &Options) -> f64 {
    let starts = options.pick(STARTS, 1) as f64;
    let sizes = sizes(options);
    sizes.iter().map(|&robots| starts * cost::start(robots)).sum::<f64>() + real_time::seconds(options, &sizes)
}

/// Measures teams in the form of exchange that is their default.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    extent.tell("scale");
    let sizes = sizes(extent.options);
    for &robots in &sizes {
        let scenario = format!("ring:{robots}");
        let spec = TeamSpec { scenario: &scenario, load: Load::Safe, kind: None, real_time: false, ticks: 1 };
        let mut starts = Vec::new();
        for _ in 0..extent.options.pick(STARTS, 1) {
            starts.push(drive(&spec, extent.stop, &mut |_, _: &RunTick<'_>| Ok(()))?.start);
            extent.advance(cost::start(robots))?;
        }
        starts.sort_unstable();
        let median = starts[starts.len() / 2].as_secs_f64();
        results.figure("scale", format!("start of {robots} robots"), median, "s");
    }
    real_time::run(extent, &sizes, results)
}
