//! `--check-solver` compares every QP of a run with Clarabel's answer and says so in the summary.

use tests::{Robots, Run};

#[test]
fn every_qp_of_a_run_is_solved_twice_and_agrees() {
    for profile in ["safe", "paper"] {
        let run = Run::start(Robots::Real, &format!("4 --profile {profile} --check-solver --max-ticks 60"));
        let finished = run.finish();
        let check = &finished.summary["solver_check"];
        let (problems, ticks) = (check["problems"].as_u64().unwrap(), finished.summary["ticks"].as_u64().unwrap());
        assert!(problems >= 4 * ticks, "{profile}: {check} in {ticks} ticks");
        assert!(check["largest_difference"].as_f64().unwrap() <= 1e-6, "{profile}: {check}");
        assert_eq!(check["verdicts_differ"], 0, "{profile}: {check}");
        assert!(finished.stdout.contains("QPs solved twice"), "{}", finished.stdout);
    }
}

#[test]
fn a_run_that_was_not_checked_says_nothing_about_it() {
    let finished = Run::start(Robots::Real, "2 --max-ticks 3").finish();
    assert!(finished.summary["solver_check"].is_null(), "{}", finished.summary);
}
