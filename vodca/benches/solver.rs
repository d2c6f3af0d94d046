//! Time per QP of each solver, by horizon and number of rows: `cargo bench -p agent --bench solver`.
//!
//! Every measurement goes round 200 random problems, so it is a mean over problems. `safe`: straight
//! reference, soft rows, one hard first-step row for every second of them; `paper`: set-point and
//! hard rows. The structured solver starts from the closed form, whose time is included.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;
use vodca::Position;
use vodca::horizon::{Horizon, MAX_HORIZON};
use vodca::mpc::clarabel::Clarabel;
use vodca::mpc::closed_form::ClosedForm;
use vodca::mpc::problem::{Problem, QpSolver, Solution};
use vodca::mpc::sample::{Family, Sample};
use vodca::mpc::structured::Structured;

const PROBLEMS: u64 = 200;

fn samples(family: Family, horizon: u64, rows: usize) -> Vec<Sample> {
    let horizon = Horizon::new(horizon).expect("horizons of the table are valid");
    (0..PROBLEMS).map(|index| Sample::new(family, horizon, rows, 2026, index)).collect()
}

/// Goes round `samples`, one QP per iteration.
fn measure(criterion: &mut Criterion, name: &str, samples: &[Sample], mut solve: impl FnMut(&Problem<'_>)) {
    let mut next = samples.iter().cycle();
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| {
            if let Some(sample) = next.next() {
                solve(&black_box(sample).problem());
            }
        })
    });
}

fn solvers(criterion: &mut Criterion) {
    let mut states = [Position::zeros(); MAX_HORIZON];
    let mut plan = Solution::default();
    let mut closed_form = ClosedForm::new(0.2, 5.0, 10.0);
    let mut structured = Structured::default();
    let mut clarabel = Clarabel::unpolished(1e-9);
    for horizon in [5, 20, 49] {
        for (profile, family) in [("safe", Family::Safe), ("paper", Family::Hard)] {
            let free = samples(family, horizon, 0);
            measure(criterion, &format!("closed form, {profile}, N = {horizon}"), &free, |problem| {
                black_box(closed_form.solve(problem, &mut plan, &mut states));
            });
            for rows in [1, 3, 10] {
                let problems = samples(family, horizon, rows);
                let case = format!("{profile}, N = {horizon}, {rows} rows");
                measure(criterion, &format!("structured, {case}"), &problems, |problem| {
                    closed_form.solve(problem, &mut plan, &mut states);
                    let _ = black_box(structured.solve(problem, &mut plan));
                });
                measure(criterion, &format!("Clarabel 1e-9, {case}"), &problems, |problem| {
                    let _ = black_box(clarabel.solve(problem, &mut plan));
                });
            }
        }
    }
}

/// What it costs that the horizon changes at every tick: uniform over 1..=49 beside their mean.
fn horizons(criterion: &mut Criterion) {
    let mut states = [Position::zeros(); MAX_HORIZON];
    let mut plan = Solution::default();
    let mut closed_form = ClosedForm::new(0.2, 5.0, 10.0);
    let mut structured = Structured::default();
    for (name, changing) in [("fixed 25", false), ("changing 1..=49", true)] {
        let problems: Vec<Sample> = (0..980)
            .map(|index| {
                let steps = if changing { 1 + (index * 18) % 49 } else { 25 };
                Sample::new(Family::Safe, Horizon::saturating(steps), 3, 2026, index as u64)
            })
            .collect();
        measure(criterion, &format!("structured, safe, 3 rows, horizon {name}"), &problems, |problem| {
            closed_form.solve(problem, &mut plan, &mut states);
            let _ = black_box(structured.solve(problem, &mut plan));
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = solvers, horizons
}
criterion_main!(benches);
