//! Clarabel with polish against the closed form, the KKT conditions and itself.

use agent::mpc::clarabel::Clarabel;
use agent::mpc::closed_form::ClosedForm;
use agent::mpc::kkt;
use agent::mpc::problem::{Plan, QpSolver, SolveError};
use agent::mpc::sample::{Family, Sample};
use shared::Position;
use shared::horizon::{Horizon, MAX_HORIZON};

#[test]
fn experiment() {
    for family in Family::ALL {
        for n in [1, 2, 5, 10, 20, 30, 49] {
            for m in [0, 1, 3, 10] {
                let (mut infeasible, mut gave, mut unpolished, mut worst, mut closed, mut total) =
                    (0, 0, 0, 0.0f64, 0, 0);
                for index in 0..60 {
                    total += 1;
                    let sample = Sample::new(family, Horizon::new(n).unwrap(), m, 1, index * 1000 + n * 20 + m as u64);
                    let problem = sample.problem();
                    let mut plan = Plan::default();
                    let mut free = Plan::default();
                    let mut states = [Position::zeros(); MAX_HORIZON];
                    let done = ClosedForm::new(0.2, 5.0, 10.0).solve(&problem, &mut free, &mut states);
                    let mut solver = Clarabel::reference();
                    match solver.solve(&problem, &mut plan) {
                        Ok(_) => {
                            let r = kkt::residual(&problem, &plan, solver.multipliers()).largest();
                            if r > 1e-9 {
                                unpolished += 1;
                            } else {
                                worst = worst.max(r);
                            }
                            if done {
                                closed += 1;
                                let du = (0..n as usize)
                                    .map(|l| (plan.inputs[l] - free.inputs[l]).amax())
                                    .fold(0.0, f64::max);
                                if du > 1e-9 {
                                    println!("closed differs {du:e}");
                                }
                            }
                        }
                        Err(SolveError::Infeasible) => infeasible += 1,
                        Err(_) => gave += 1,
                    }
                }
                println!(
                    "{family:?} N={n} m={m}: total {total} closed {closed} infeasible {infeasible} gave up {gave} unpolished {unpolished} worst polished {worst:.1e}"
                );
            }
        }
    }
}
