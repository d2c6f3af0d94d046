use agent::mpc::clarabel::Clarabel;
use agent::mpc::closed_form::ClosedForm;
use agent::mpc::problem::{Plan, QpSolver, SolveError};
use agent::mpc::sample::{Family, Sample};
use agent::mpc::structured::Structured;
use shared::Position;
use shared::horizon::{Horizon, MAX_HORIZON};

#[test]
fn experiment() {
    let count: u64 = std::env::var("COUNT").ok().and_then(|c| c.parse().ok()).unwrap_or(60);
    let check = std::env::var("NOCHECK").is_err();
    for family in Family::ALL {
        for n in [1, 2, 5, 10, 20, 30, 49] {
            for m in [1, 3, 10] {
                let (mut infeasible, mut gave, mut differ, mut worst) = (0, 0, 0, 0.0f64);
                let mut its = Vec::new();
                let mut times = Vec::new();
                let mut solver = Structured::default();
                let mut closed = ClosedForm::new(0.2, 5.0, 10.0);
                for index in 0..count {
                    let sample = Sample::new(family, Horizon::new(n).unwrap(), m, 1, index * 1000 + n * 20 + m as u64);
                    let problem = sample.problem();
                    let mut free = Plan::default();
                    let mut states = [Position::zeros(); MAX_HORIZON];
                    if closed.solve(&problem, &mut free, &mut states) {
                        continue;
                    }
                    let mut plan = free.clone();
                    let mut best = f64::MAX;
                    let mut mine = Ok(Default::default());
                    for _ in 0..5 {
                        let t = std::time::Instant::now();
                        closed.solve(&problem, &mut plan, &mut states);
                        mine = solver.solve(&problem, &mut plan);
                        best = best.min(t.elapsed().as_nanos() as f64 / 1e3);
                    }
                    times.push(best);
                    match mine {
                        Ok(e) => its.push(e.iterations),
                        Err(SolveError::Infeasible) => infeasible += 1,
                        Err(e) => {
                            if gave < 3 {
                                println!("{e}");
                            }
                            gave += 1;
                            continue;
                        }
                    }
                    if !check {
                        continue;
                    }
                    let mut reference = Plan::default();
                    let theirs = Clarabel::reference().solve(&problem, &mut reference);
                    match (mine, theirs) {
                        (Ok(_), Ok(_)) => {
                            let du = (0..n as usize)
                                .map(|l| (plan.inputs[l] - reference.inputs[l]).amax())
                                .fold(0.0, f64::max);
                            worst = worst.max(du);
                        }
                        (Err(SolveError::Infeasible), Err(SolveError::Infeasible)) => {}
                        (a, b) => {
                            println!("verdict differs {a:?} {b:?}");
                            differ += 1;
                        }
                    }
                }
                its.sort();
                times.sort_by(f64::total_cmp);
                let p = |q: f64| if its.is_empty() { 0 } else { its[((its.len() - 1) as f64 * q) as usize] };
                let t = |q: f64| if times.is_empty() { 0.0 } else { times[((times.len() - 1) as f64 * q) as usize] };
                println!(
                    "{family:?} N={n} m={m}: infeasible {infeasible} gave up {gave} differ {differ} worst du {worst:.1e} its p50 {} p90 {} max {}; us p50 {:.2} p90 {:.2} max {:.2}",
                    p(0.5),
                    p(0.9),
                    p(1.0),
                    t(0.5),
                    t(0.9),
                    t(1.0)
                );
            }
        }
    }
}
