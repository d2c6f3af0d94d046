//! A robot's whole step in a closed loop: fourteen robots, three obstacles, one process.

use super::row::{Results, Row};
use super::{BenchError, Extent, Options, cost};
use crate::in_process::run_whole;
use coordinator::latency::Latency;
use vodca::horizon_source::{HorizonSource, HorizonSpec};
use vodca::params::Profile;
use vodca::scenario::set_up;
use vodca::step::{Level, Step};

const SCENARIO: &str = "ex14_d";
const ROBOTS: u64 = 14;
/// Ticks of every case; each is a step of every robot.
const TICKS: u64 = 20_000;
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
/// What a whole step is compared with: the case whose controller solves no QP and looks at nothing but now.
const PEER: usize = 6;

fn ticks(options: &Options) -> u64 {
    options.pick(TICKS, 10)
}

/// What so many ticks are expected to take, s.
fn cost_of(ticks: u64) -> f64 {
    (ticks * ROBOTS) as f64 * cost::STEP
}

/// What this part is expected to take, s.
pub(super) fn seconds(options: &Options) -> f64 {
    CASES.len() as f64 * cost_of(ticks(options))
}

/// Measures every case. Episodes take turns: a pass is one of every case that has not had enough.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    extent.tell("step");
    let wanted = ticks(extent.options);
    let mut found: Vec<Parts> = CASES.iter().map(|_| Parts::default()).collect();
    for pass in 0.. {
        let few = CASES.into_iter().zip(&mut found).filter(|(_, parts)| parts.ticks < wanted);
        let mut driven = false;
        for ((profile, horizons, _), parts) in few {
            let before = parts.ticks;
            episode(extent.options, profile, horizons, pass, parts)?;
            extent.advance(cost_of(parts.ticks.min(wanted) - before))?;
            driven = true;
        }
        if !driven {
            break;
        }
    }
    tell(&found, results);
    Ok(())
}

fn tell(found: &[Parts], results: &mut Results) {
    let name = |(profile, horizons, _): (Profile, &str, Option<usize>)| format!("{profile}, {horizons}");
    let peer = format!("{}: step", name(CASES[PEER]));
    let (mut clarabel, mut qps) = (0, 0);
    for (case, parts) in CASES.into_iter().zip(found) {
        let row =
            |what, latency: &Latency| Row::new("step", format!("{}: {what}", name(case)), case.2, latency.clone());
        results.row(row("step", &parts.step).over(&peer, &found[PEER].step));
        if parts.qps > 0 {
            results.row(row("detect", &parts.detect));
            results.row(row("solve", &parts.solve));
        }
        clarabel += parts.clarabel;
        qps += parts.qps;
    }
    results.figure("step", "QPs in these runs", qps as f64, "");
    results.figure("step", "share of them that needed Clarabel", 100.0 * clarabel as f64 / qps.max(1) as f64, "%");
}

#[derive(Default)]
struct Parts {
    ticks: u64,
    step: Latency,
    detect: Latency,
    solve: Latency,
    qps: u64,
    clarabel: u64,
}

/// One episode with a seed of its own.
fn episode(
    options: &Options,
    profile: Profile,
    horizons: &str,
    pass: u64,
    parts: &mut Parts,
) -> Result<(), BenchError> {
    let (mut scenario, params) = set_up(Some(SCENARIO), None, profile, &[])?;
    scenario.max_ticks = options.pick(scenario.max_ticks, 10);
    scenario.seed += pass;
    let spec: HorizonSpec = horizons.parse()?;
    let source = HorizonSource::new(&spec, scenario.robots.len(), scenario.seed, params.horizon.jitter)?;
    run_whole(&scenario, &params, &source, |steps: &[Step]| {
        parts.ticks += 1;
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
