//! A robot's whole step in a closed loop: fourteen robots, three obstacles, one process.

use super::row::{Results, Row};
use super::{BenchError, Extent};
use crate::in_process::run_whole;
use coordinator::latency::Latency;
use vodca::horizon_source::{HorizonSource, HorizonSpec};
use vodca::params::Profile;
use vodca::scenario::set_up;
use vodca::step::{Level, Step};

const SCENARIO: &str = "ex14_d";
/// Profile and horizons, with the horizon where there is one.
const CASES: [(Profile, &str, Option<usize>); 8] = [
    (Profile::Safe, "fixed:20", Some(20)),
    (Profile::Safe, "fixed:49", Some(49)),
    (Profile::Safe, "fixed:25", Some(25)),
    (Profile::Safe, "random:1", None),
    (Profile::Paper, "fixed:20", Some(20)),
    (Profile::Paper, "fixed:49", Some(49)),
    (Profile::Orca, "fixed:20", None),
    (Profile::OrcaRh, "fixed:20", None),
];

/// Measures every case; passes are interleaved.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    let passes = extent.pick(6, 1);
    extent.tell("step", passes * CASES.len());
    let mut found: Vec<Parts> = CASES.iter().map(|_| Parts::default()).collect();
    for _ in 0..passes {
        for ((profile, horizons, _), parts) in CASES.into_iter().zip(&mut found) {
            episode(extent, profile, horizons, parts)?;
            extent.advance()?;
        }
    }
    let (mut clarabel, mut qps) = (0, 0);
    for ((profile, horizons, size), parts) in CASES.into_iter().zip(found) {
        let name = format!("{profile}, {horizons}");
        results.row(Row::new("step", format!("{name}: step"), size, parts.step));
        if parts.qps > 0 {
            results.row(Row::new("step", format!("{name}: detect"), size, parts.detect));
            results.row(Row::new("step", format!("{name}: solve"), size, parts.solve));
        }
        clarabel += parts.clarabel;
        qps += parts.qps;
    }
    results.figure("step", "QPs in these runs", qps as f64, "");
    results.figure("step", "share of them that needed Clarabel", 100.0 * clarabel as f64 / qps.max(1) as f64, "%");
    Ok(())
}

#[derive(Default)]
struct Parts {
    step: Latency,
    detect: Latency,
    solve: Latency,
    qps: u64,
    clarabel: u64,
}

fn episode(extent: &Extent<'_>, profile: Profile, horizons: &str, parts: &mut Parts) -> Result<(), BenchError> {
    let (mut scenario, params) = set_up(Some(SCENARIO), None, profile, &[])?;
    scenario.max_ticks = extent.pick(scenario.max_ticks, 10);
    let spec: HorizonSpec = horizons.parse()?;
    let source = HorizonSource::new(&spec, scenario.robots.len(), scenario.seed, params.horizon.jitter)?;
    run_whole(&scenario, &params, &source, |steps: &[Step]| {
        for step in steps {
            parts.step.record_ns(step.step_ns);
            if step.level != Level::Baseline {
                parts.detect.record_ns(step.detect_ns);
                parts.solve.record_ns(step.solve_ns);
                parts.qps += 1;
                parts.clarabel += u64::from(step.level == Level::Clarabel);
            }
        }
    });
    Ok(())
}
