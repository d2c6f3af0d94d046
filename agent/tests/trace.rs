use agent::mpc::closed_form::ClosedForm;
use agent::mpc::structured::Structured;
use agent::mpc::problem::{Plan, QpSolver, SolveError};
use agent::mpc::sample::{Family, Sample};
use shared::Position;
use shared::horizon::{Horizon, MAX_HORIZON};
#[test]
fn trace() {
    let v = |k: &str| std::env::var(k).unwrap().parse::<u64>().unwrap();
    let (n, m, f) = (v("N"), v("M") as usize, v("F") as usize);
    let mut solver = Structured::default();
    let mut closed = ClosedForm::new(0.2, 5.0, 10.0);
    for index in 0..v("COUNT") {
        let sample = Sample::new(Family::ALL[f], Horizon::new(n).unwrap(), m, 1, index * 1000 + n * 20 + m as u64);
        let problem = sample.problem();
        let mut plan = Plan::default();
        let mut states = [Position::zeros(); MAX_HORIZON];
        if closed.solve(&problem, &mut plan, &mut states) { continue; }
        let free = plan.clone();
        let r = solver.solve(&problem, &mut plan);
        let over = std::env::var("OVER").ok().and_then(|s| s.parse::<u32>().ok()).unwrap_or(u32::MAX);
        if matches!(r, Err(SolveError::GaveUp{..})) || matches!(r, Ok(e) if e.iterations > over) {
            plan = free;
            unsafe { std::env::set_var("TRACE", "1"); }
            eprintln!("{:?} {:?}", sample.rows, problem.position);
            let _ = solver.solve(&problem, &mut plan);
            return;
        }
    }
}
