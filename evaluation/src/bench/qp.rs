//! One QP: the ladder beside Clarabel, on the same random problems.
//!
//! Every problem is solved once by each, and every solution is a sample. Solvers take turns, a chunk of
//! problems each, so that what the machine does meanwhile falls on both.

use super::dump;
use super::row::{Results, Row};
use super::{BenchError, Extent, Options, cost};
use coordinator::latency::Latency;
use std::hint::black_box;
use std::time::Instant;
use vodca::horizon::Horizon;
use vodca::mpc::clarabel::Clarabel;
use vodca::mpc::cross_check::CrossCheck;
use vodca::mpc::ladder::Ladder;
use vodca::mpc::problem::{Problem, QpSolver, Solution};
use vodca::mpc::sample::{Family, Sample};

const HORIZONS: [usize; 2] = [20, 49];
const ROWS: [usize; 3] = [0, 3, 10];
const FAMILIES: [(Family, &str); 2] = [(Family::Safe, "safe"), (Family::Hard, "paper")];
const SEED: u64 = 2026;
/// Problems of every case.
const PROBLEMS: u64 = 20_000;
/// Problems between two turns.
const CHUNK: u64 = 200;
/// So many problems of every case are compared with Clarabel at its most exact, and written for others.
const CHECKED: u64 = 500;

/// Problems of a case, and of a chunk of them.
fn problems(options: &Options) -> (u64, u64) {
    options.pick((PROBLEMS, CHUNK), (4, 4))
}

/// What a chunk of `problems` is expected to take, s.
fn chunk_seconds(problems: u64) -> f64 {
    problems as f64 * (cost::DRAWN + cost::LADDER + cost::CLARABEL)
}

/// What `problems` problems with changing horizons, and as many with a fixed one, are expected to take, s.
fn changing_seconds(problems: u64) -> f64 {
    2.0 * problems as f64 * (cost::DRAWN + cost::LADDER)
}

/// What this part is expected to take, s.
pub(super) fn seconds(options: &Options) -> f64 {
    let (problems, _) = problems(options);
    let cases = (FAMILIES.len() * HORIZONS.len() * ROWS.len()) as f64;
    let checked = CHECKED.min(problems) as f64 * 2.0 * cost::CLARABEL;
    cases * (chunk_seconds(problems) + checked) + changing_seconds(problems)
}

/// Measures every family, horizon and number of rows, and writes the problems where that was asked for.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    extent.tell("solver");
    let mut dumped = Vec::new();
    let mut check = CrossCheck::default();
    for family in FAMILIES {
        for horizon in HORIZONS {
            let mut cases = ROWS.map(|rows| Case { family, horizon, rows, times: Default::default() });
            measure(extent, &mut cases)?;
            for case in &cases {
                case.tell(&cases[0], results);
                case.check(extent, &mut check, &mut dumped)?;
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

/// Problems of one kind.
struct Case {
    family: (Family, &'static str),
    horizon: usize,
    rows: usize,
    /// Of the ladder, and of Clarabel.
    times: [Latency; 2],
}

impl Case {
    fn sample(&self, index: u64) -> Sample {
        Sample::new(self.family.0, Horizon::saturating(self.horizon as i64), self.rows, SEED, index)
    }

    fn name(&self, solver: &str) -> String {
        format!("{}, {} rows: {solver}", self.family.1, self.rows)
    }

    /// The ladder stands beside itself on problems without rows, Clarabel beside the ladder.
    fn tell(&self, without_rows: &Self, results: &mut Results) {
        let [ours, theirs] = self.times.clone();
        let row = |solver, times| Row::new("solver", self.name(solver), Some(self.horizon), times);
        let floor = without_rows.name("ladder");
        let peer = row("Clarabel", theirs).over(self.name("ladder"), &ours);
        results.row(row("ladder", ours).over(floor, &without_rows.times[0]));
        results.row(peer);
    }

    fn check(
        &self,
        extent: &Extent<'_>,
        check: &mut CrossCheck,
        dumped: &mut Vec<serde_json::Value>,
    ) -> Result<(), BenchError> {
        let (problems, _) = problems(extent.options);
        let (mut ladder, mut plan) = (Ladder::default(), Solution::default());
        for index in 0..CHECKED.min(problems) {
            let sample = self.sample(index);
            let outcome = ladder.solve(&sample.problem(), &mut plan);
            check.compare(&sample.problem(), outcome.map(|_| &plan));
            if extent.options.dump.is_some() {
                let plan = outcome.is_ok().then_some(&plan);
                dumped.push(dump::problem(self.family.1, self.rows, &sample.problem(), plan));
            }
            extent.advance(2.0 * cost::CLARABEL)?;
        }
        Ok(())
    }
}

/// Both solvers on all cases, chunk by chunk.
fn measure(extent: &Extent<'_>, cases: &mut [Case]) -> Result<(), BenchError> {
    let (problems, chunk) = problems(extent.options);
    let (mut ladder, mut clarabel) = (Ladder::default(), Clarabel::unpolished(1e-9));
    for first in (0..problems).step_by(chunk as usize) {
        for case in cases.iter_mut() {
            let samples: Vec<Sample> = (first..first + chunk).map(|index| case.sample(index)).collect();
            time(&samples, &mut case.times[0], |problem, plan| ladder.solve(problem, plan).is_ok());
            time(&samples, &mut case.times[1], |problem, plan| clarabel.solve(problem, plan).is_ok());
            extent.advance(chunk_seconds(chunk))?;
        }
    }
    Ok(())
}

/// What it costs that the horizon changes with every problem: uniform over 1..=49 beside their mean, 25.
fn changing_horizons(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    // 18 and 49 have no common divisor: every horizon comes as often as any other.
    let horizon = |changing: bool, index: u64| if changing { 1 + (index * 18) % 49 } else { 25 };
    let (problems, _) = problems(extent.options);
    let names = ["safe, 3 rows, horizon fixed 25", "safe, 3 rows, horizon changing 1..=49"];
    let (mut ladder, mut times) = (Ladder::default(), [Latency::new(), Latency::new()]);
    for first in (0..problems).step_by(49) {
        for (changing, times) in [false, true].into_iter().zip(&mut times) {
            let sample = |index| {
                let steps = Horizon::saturating(horizon(changing, index) as i64);
                Sample::new(Family::Safe, steps, 3, SEED, index)
            };
            let samples: Vec<Sample> = (first..first + 49).map(sample).collect();
            time(&samples, times, |problem, plan| ladder.solve(problem, plan).is_ok());
        }
        extent.advance(changing_seconds(49.min(problems - first)))?;
    }
    let [fixed, changing] = times;
    results.figure(
        "solver",
        "mean QP with changing horizons over a fixed one",
        changing.mean_us() / fixed.mean_us(),
        "",
    );
    let peer = Row::new("solver", names[1], None, changing).over(names[0], &fixed);
    results.row(Row::new("solver", names[0], None, fixed).as_floor());
    results.row(peer);
    Ok(())
}

/// Solves each problem once. One that is not counted comes first: it touches the solver's memory.
fn time(samples: &[Sample], times: &mut Latency, mut solve: impl FnMut(&Problem<'_>, &mut Solution) -> bool) {
    let mut plan = Solution::default();
    if let Some(first) = samples.first() {
        solve(&first.problem(), &mut plan);
    }
    for sample in samples {
        let problem = sample.problem();
        let start = Instant::now();
        let solved = solve(black_box(&problem), &mut plan);
        times.record(start.elapsed());
        black_box(solved); // finding that there is no solution costs time as well
    }
}
