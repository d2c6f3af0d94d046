//! The tables of a comparison: a row per family and controller for reading, a row per run for working on.

use super::{Comparison, Job, Median, Plan, Row, Run};
use crate::text_table::TextTable;

/// One row per scenario family and controller, then one per controller over all families.
pub fn by_family(comparison: &Comparison) -> TextTable {
    let mut table = TextTable::new(&[
        "scenario",
        "controller",
        "success",
        "ratio",
        "95 % interval",
        "ticks (max)",
        "time s (max)",
        "min separation",
        "pairs below",
        "step us",
        "mean",
    ]);
    // One family is its own total.
    let totals = if comparison.rows.len() > comparison.totals.len() { &comparison.totals[..] } else { &[] };
    comparison.rows.iter().chain(totals).for_each(|row| table.row(cells(row)));
    table
}

fn cells(row: &Row) -> [String; 11] {
    let number = |value: Option<f64>, digits: usize| value.map_or("-".into(), |value| format!("{value:.digits$}"));
    let with_most = |value: Option<Median>, digits: usize| {
        value.map_or("-".into(), |Median { median, most, .. }| format!("{median:.digits$} ({most:.digits$})"))
    };
    [
        row.family.clone(),
        row.controller.clone(),
        format!("{}/{}", row.successes, row.runs),
        number(row.ratio.map(|ratio| ratio.median), 3),
        row.ratio
            .filter(|_| row.successes > 1)
            .map_or("-".into(), |ratio| format!("{:.3}..{:.3}", ratio.low, ratio.high)),
        with_most(row.ticks, 0),
        with_most(row.time_s, 1),
        number(row.min_separation, 6),
        row.pairs_below.to_string(),
        number(row.step_p50_us, 1),
        number(row.step_us, 1),
    ]
}

/// One row per run. Everything but the last two columns is the same at every repetition.
pub fn by_run(plan: &Plan, jobs: &[Job], runs: &[Run]) -> TextTable {
    let mut table = TextTable::new(&[
        "family",
        "scenario",
        "robots",
        "controller",
        "horizon",
        "seed",
        "success",
        "arrived",
        "ticks",
        "time_s",
        "path_m",
        "ratio",
        "min_separation_m",
        "pairs_below",
        "collisions",
        "activations",
        "infeasible",
        "shielded",
        "step_p50_us",
        "step_us",
    ]);
    for (job, Run { summary: run, step_us, step_p50_us }) in jobs.iter().zip(runs) {
        let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        table.row([
            plan.entries[job.entry].family.clone(),
            job.scenario.name.clone(),
            job.scenario.robots.len().to_string(),
            plan.contenders[job.contender].to_string(),
            job.horizon.clone(),
            job.scenario.seed.to_string(),
            run.success.to_string(),
            run.completion_time.is_some().to_string(),
            run.ticks.to_string(),
            number(run.completion_time),
            run.path_cost.to_string(),
            number(run.path_ratio),
            number(run.min_separation),
            run.pairs_below_min_separation.to_string(),
            run.collisions.to_string(),
            run.activations.to_string(),
            run.infeasible.to_string(),
            run.shielded.to_string(),
            format!("{step_p50_us:.3}"),
            format!("{step_us:.3}"),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{Contenders, expand, run_all};
    use shared::stop::StopFlag;

    fn plan(scenarios: &[&str], contenders: &[&str], max_ticks: Option<u64>) -> Plan {
        Plan {
            entries: scenarios.iter().flat_map(|spec| expand(spec).unwrap()).collect(),
            contenders: contenders.iter().flat_map(|spec| spec.parse::<Contenders>().unwrap().0).collect(),
            seeds: vec![0, 1],
            start_jitter: 0.0,
            sets: vec![],
            max_ticks,
        }
    }

    /// The lines of the runs without the two times at their end.
    fn runs(plan: &Plan) -> Vec<String> {
        let jobs = plan.jobs().unwrap();
        let runs: Vec<Run> = run_all(&jobs, &StopFlag::default(), || ()).done.into_iter().flatten().collect();
        let csv = by_run(plan, &jobs, &runs).csv();
        csv.lines().map(|line| line.rsplitn(3, ',').last().unwrap().to_string()).collect()
    }

    #[test]
    fn every_controller_gets_a_row_per_family_and_one_for_all() {
        let plan = plan(&["rand8o0_s0", "rand8o0_s1", "two_setpoint"], &["safe:each:10,20,random", "orca-rh"], Some(4));
        let jobs = plan.jobs().unwrap();
        let runs: Vec<Run> = run_all(&jobs, &StopFlag::default(), || ()).done.into_iter().flatten().collect();
        let text = by_family(&Comparison::new(&plan, &jobs, &runs)).csv();
        let firsts: Vec<&str> = text.lines().skip(1).map(|line| line.split(",-").next().unwrap()).collect();
        // The jitter of the safe profile makes fixed horizons random too: two seeds each.
        let expected = [
            "rand8o0,\"safe:each:10,20,random\",0/12",
            "rand8o0,orca-rh,0/2",
            "two_setpoint,\"safe:each:10,20,random\",0/6",
            "two_setpoint,orca-rh,0/1",
            "all,\"safe:each:10,20,random\",0/18",
            "all,orca-rh,0/3",
        ];
        assert_eq!(firsts, expected);
    }

    #[test]
    fn the_runs_of_a_comparison_are_the_same_every_time() {
        let plan = plan(&["two_setpoint", "four_gate"], &["safe:random", "orca[orca.push=0.3]"], Some(60));
        let first = runs(&plan);
        assert_eq!(first.len(), 1 + 2 * 2 * 2);
        assert_eq!(first, runs(&plan));
        assert_ne!(first[1].replace(",0,", ",1,"), first[2], "seeds differ");
    }
}
