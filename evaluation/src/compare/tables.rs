//! The tables of a comparison: a row per family and controller for reading, a row per run for working on.

use super::{BestOf, Comparison, Experiment, Median, Row, Run};
use crate::text_table::TextTable;
use std::fmt;

/// One row per scenario family and controller, then one per controller over all families. A column says what the best
/// was chosen from, where a controller has variants.
pub fn by_family(comparison: &Comparison) -> TextTable {
    // One family is its own total.
    let totals = if comparison.rows.len() > comparison.totals.len() { &comparison.totals[..] } else { &[] };
    let rows = || comparison.rows.iter().chain(totals);
    let with_variants = rows().any(|row| row.best_of.is_some());
    let mut header = vec![
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
    ];
    header.extend(with_variants.then_some("variant"));
    let mut table = TextTable::new(&header);
    for row in rows() {
        let best_of = || row.best_of.as_ref().map_or("-".into(), BestOf::to_string);
        table.row(cells(row).into_iter().chain(with_variants.then(best_of)));
    }
    table
}

impl fmt::Display for BestOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { variants, variant, best_in, layouts } = self;
        match layouts {
            1 => write!(f, "best of {variants}: {variant}"),
            _ => write!(f, "best of {variants} in each layout, mostly {variant} ({best_in} of {layouts})"),
        }
    }
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

/// One row per run that counts. Everything but the last two columns is the same at every repetition.
pub fn by_run(experiment: &Experiment, runs: &[Run]) -> TextTable {
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
        "filtered",
        "variant",
        "step_p50_us",
        "step_us",
    ]);
    for Run { job, summary: run, step_us, step_p50_us, .. } in runs {
        let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        table.row([
            experiment.entries[job.entry].family.clone(),
            job.scenario.name.clone(),
            job.scenario.robots.len().to_string(),
            experiment.controllers[job.controller].to_string(),
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
            run.filtered.to_string(),
            experiment.variant(job),
            format!("{step_p50_us:.3}"),
            format!("{step_us:.3}"),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{ControllerSpecs, Counted, expand, keep_best, run_all};
    use shared::stop::StopFlag;

    fn experiment(scenarios: &[&str], controllers: &[&str], max_ticks: Option<u64>) -> Experiment {
        Experiment {
            entries: scenarios.iter().flat_map(|spec| expand(spec).unwrap()).collect(),
            controllers: controllers.iter().flat_map(|spec| spec.parse::<ControllerSpecs>().unwrap().0).collect(),
            seeds: vec![0, 1],
            start_jitter: 0.0,
            sets: vec![],
            max_ticks,
            check_solver: false,
        }
    }

    /// The lines of the runs without the two times at their end.
    fn runs(experiment: &Experiment) -> Vec<String> {
        let jobs = experiment.jobs().unwrap();
        let runs: Vec<Run> = run_all(&jobs, &StopFlag::default(), || ()).done.into_iter().flatten().collect();
        let csv = by_run(experiment, &runs).csv();
        csv.lines().map(|line| line.rsplitn(3, ',').last().unwrap().to_string()).collect()
    }

    #[test]
    fn every_controller_gets_a_row_per_family_and_one_for_all() {
        let experiment =
            experiment(&["rand8o0_s0", "rand8o0_s1", "two_setpoint"], &["safe:each:10,20,random", "orca-rh"], Some(4));
        let jobs = experiment.jobs().unwrap();
        let runs: Vec<Run> = run_all(&jobs, &StopFlag::default(), || ()).done.into_iter().flatten().collect();
        let text = by_family(&Comparison::new(&experiment, &runs, &[])).csv();
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
    fn the_table_says_what_the_best_was_chosen_from() {
        let experiment = experiment(&["two_setpoint", "four_gate"], &["orca-best"], Some(3));
        let jobs = experiment.jobs().unwrap();
        let Counted { runs, tried } = keep_best(&experiment, &jobs, run_all(&jobs, &StopFlag::default(), || ()).done);
        let text = by_family(&Comparison::new(&experiment, &runs, &tried)).csv();
        let lasts: Vec<&str> = text.lines().map(|line| line.rsplit(',').next().unwrap().trim_matches('"')).collect();
        // Nobody arrives in three ticks: the first of sixteen equal ones.
        let (one, all) =
            ("best of 16: time_horizon=1 push=0.05 aim=0", " mostly time_horizon=1 push=0.05 aim=0 (2 of 2)");
        assert_eq!(lasts, ["variant", one, one, all]);
        assert_eq!(runs.len(), 2 * 2);
    }

    #[test]
    fn the_runs_of_a_comparison_are_the_same_every_time() {
        let experiment = experiment(&["two_setpoint", "four_gate"], &["safe:random", "orca[orca.push=0.3]"], Some(60));
        let first = runs(&experiment);
        assert_eq!(first.len(), 1 + 2 * 2 * 2);
        assert_eq!(first, runs(&experiment));
        assert_ne!(first[1].replace(",0,", ",1,"), first[2], "seeds differ");
    }
}
