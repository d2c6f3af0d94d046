//! One QP: the ladder beside Clarabel, on the same random problems.
//!
//! Every problem is solved several times and its shortest time counts; the distribution is over
//! problems. What else the machine does is in the times that are left out.

use super::dump;
use super::row::{Results, Row};
use super::{BenchError, Extent};
use coordinator::latency::Latency;
use std::hint::black_box;
use std::time::Instant;
use vodca::horizon::Horizon;
use vodca::mpc::clarabel::Clarabel;
use vodca::mpc::cross_check::CrossCheck;
use vodca::mpc::ladder::Ladder;
use vodca::mpc::problem::{Plan, Problem, QpSolver};
use vodca::mpc::sample::{Family, Sample};

const HORIZONS: [i64; 2] = [20, 49];
const ROWS: [usize; 3] = [0, 3, 10];
const FAMILIES: [(Family, &str); 2] = [(Family::Safe, "safe"), (Family::Hard, "paper")];
const SEED: u64 = 2026;
/// Times that every problem is solved.
const REPEATS: usize = 5;

/// Measures every family, horizon and number of rows, and writes the problems where that was asked for.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    let problems = extent.pick(500, 4);
    extent.tell("solver", FAMILIES.len() * HORIZONS.len() * ROWS.len() + 2);
    let mut dumped = Vec::new();
    let mut check = CrossCheck::default();
    for (family, family_name) in FAMILIES {
        for horizon in HORIZONS {
            for rows in ROWS {
                let samples: Vec<Sample> = (0..problems)
                    .map(|index| Sample::new(family, Horizon::saturating(horizon), rows, SEED, index))
                    .collect();
                let case = format!("{family_name}, {rows} rows");
                let (mut ladder, mut clarabel) = (Ladder::default(), Clarabel::unpolished(1e-9));
                let ours = measure(&samples, |problem, plan| ladder.solve(problem, plan).is_ok());
                let theirs = measure(&samples, |problem, plan| clarabel.solve(problem, plan).is_ok());
                let p50 = ours.percentiles().p50_us;
                let size = Some(horizon as usize);
                results.row(Row::new("solver", format!("{case}: ladder"), size, ours));
                results.row(Row::new("solver", format!("{case}: Clarabel"), size, theirs).over(Some(p50)));
                for sample in &samples {
                    let mut plan = Plan::default();
                    let outcome = ladder.solve(&sample.problem(), &mut plan);
                    check.compare(&sample.problem(), outcome.map(|_| &plan));
                    if extent.options.dump.is_some() {
                        dumped.push(dump::problem(
                            family_name,
                            rows,
                            &sample.problem(),
                            outcome.is_ok().then_some(&plan),
                        ));
                    }
                }
                extent.advance()?;
            }
        }
    }
    let found = check.found();
    results.figure("solver", "QPs compared with Clarabel at 1e-10", found.problems as f64, "");
    results.figure("solver", "largest difference of an input", found.largest_difference, "m/s");
    results.figure("solver", "verdicts that differ", found.verdicts_differ as f64, "");
    changing_horizons(extent, results)?;
    match &extent.options.dump {
        Some(path) => dump::write(path, &dumped),
        None => Ok(()),
    }
}

/// What it costs that the horizon changes with every problem: uniform over 1..=49 beside their mean, 25.
fn changing_horizons(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    let mut means = [0.0; 2];
    for (changing, mean) in [false, true].into_iter().zip(&mut means) {
        // 18 and 49 have no common divisor: every horizon comes as often as any other.
        let horizon = |index: i64| if changing { 1 + (index * 18) % 49 } else { 25 };
        let samples: Vec<Sample> = (0..extent.pick(980, 49))
            .map(|index| Sample::new(Family::Safe, Horizon::saturating(horizon(index)), 3, SEED, index as u64))
            .collect();
        let mut ladder = Ladder::default();
        let latency = measure(&samples, |problem, plan| ladder.solve(problem, plan).is_ok());
        *mean = latency.mean_us();
        let name = if changing { "safe, 3 rows, horizon changing 1..=49" } else { "safe, 3 rows, horizon fixed 25" };
        results.row(Row::new("solver", name, None, latency));
        extent.advance()?;
    }
    results.figure("solver", "mean QP with changing horizons over a fixed one", means[1] / means[0], "");
    Ok(())
}

/// The shortest time of each problem. Problems follow each other, so that none finds its own data warm.
fn measure(samples: &[Sample], mut solve: impl FnMut(&Problem<'_>, &mut Plan) -> bool) -> Latency {
    let mut shortest = vec![u64::MAX; samples.len()];
    let mut plan = Plan::default();
    for _ in 0..REPEATS {
        for (sample, shortest) in samples.iter().zip(&mut shortest) {
            let problem = sample.problem();
            let start = Instant::now();
            black_box(solve(black_box(&problem), &mut plan));
            *shortest = (*shortest).min(start.elapsed().as_nanos() as u64);
        }
    }
    let mut latency = Latency::new();
    shortest.into_iter().for_each(|time| latency.record_ns(time));
    latency
}
