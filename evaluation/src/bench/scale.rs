//! Large teams: how long they take to start, and whether they keep the real-time clock.

use super::row::{Results, Row};
use super::teams::{Load, TeamSpec, drive};
use super::{BenchError, Extent};
use coordinator::latency::Latency;
use coordinator::run::RunTick;

/// Measures teams in the form of exchange that is their default.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    let sizes = extent.sizes(&[14, 50, 100, 200], &[3]);
    extent.tell("scale", sizes.len());
    for &robots in &sizes {
        let scenario = format!("ring:{robots}");
        let ticks = extent.pick(150, 3);
        let spec = TeamSpec { scenario: &scenario, load: Load::Safe, kind: None, real_time: true, ticks };
        let (mut tick_time, mut late) = (Latency::new(), Latency::new());
        let mut observe = |tick: &RunTick<'_>| {
            tick_time.record_ns(tick.team.moments().collected.saturating_sub(tick.team.moments().announced));
            late.record_ns(tick.team.moments().late);
            Ok(())
        };
        let driven = drive(&spec, extent.stop, &mut observe)?;
        results.figure("scale", format!("start of {robots} robots"), driven.start.as_secs_f64(), "s");
        results.row(Row::new("scale", "tick, safe, real time", Some(robots), tick_time));
        results.row(Row::new("scale", "lateness, safe, real time", Some(robots), late));
        extent.advance()?;
    }
    Ok(())
}
