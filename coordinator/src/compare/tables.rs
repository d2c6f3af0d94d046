//! The tables of a comparison: a row per family and controller for reading, a row per run for working on.

use super::{Contender, Job, Run};
use crate::text_table::TextTable;
use shared::scenario::suite::family;

/// One row per scenario family and controller: medians with their range over the runs that succeeded, the
/// smallest separation and the pairs below min_separation over all.
pub fn by_family(contenders: &[Contender], jobs: &[Job], runs: &[Run]) -> TextTable {
    let mut table = TextTable::new(&[
        "scenario",
        "controller",
        "success",
        "ratio",
        "ratio range",
        "ticks",
        "time s",
        "time range",
        "min separation",
        "pairs below",
        "step us",
    ]);
    let mut families: Vec<&str> = jobs.iter().map(|job| family(&job.scenario.name)).collect();
    families.dedup(); // jobs come scenario by scenario
    for name in families {
        for (index, contender) in contenders.iter().enumerate() {
            let group: Vec<&Run> = jobs
                .iter()
                .zip(runs)
                .filter(|(job, _)| job.contender == index && family(&job.scenario.name) == name)
                .map(|(_, run)| run)
                .collect();
            table.row(row(name, contender, &group));
        }
    }
    table
}

fn row(name: &str, contender: &Contender, group: &[&Run]) -> [String; 11] {
    let good: Vec<&Run> = group.iter().copied().filter(|run| run.summary.success).collect();
    let ratio = Spread::of(good.iter().filter_map(|run| run.summary.path_ratio));
    let ticks = Spread::of(good.iter().map(|run| run.summary.ticks as f64));
    let time = Spread::of(good.iter().filter_map(|run| run.summary.completion_time));
    let nearest = Spread::of(group.iter().filter_map(|run| run.summary.min_separation));
    let below: u64 = group.iter().map(|run| run.summary.pairs_below_min_separation).sum();
    [
        name.into(),
        contender.to_string(),
        format!("{}/{}", good.len(), group.len()),
        ratio.median(3),
        ratio.range(3),
        ticks.median(0),
        time.median(1),
        time.range(1),
        nearest.least(6),
        below.to_string(),
        Spread::of(group.iter().map(|run| run.step_us)).median(1),
    ]
}

/// One row per run.
pub fn by_run(contenders: &[Contender], jobs: &[Job], runs: &[Run]) -> TextTable {
    let mut table = TextTable::new(&[
        "scenario",
        "controller",
        "seed",
        "success",
        "ticks",
        "path",
        "ratio",
        "min_separation",
        "pairs_below",
        "collisions",
        "activations",
        "infeasible",
        "shielded",
        "step_us",
    ]);
    for (job, Run { summary: run, step_us }) in jobs.iter().zip(runs) {
        let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        table.row([
            job.scenario.name.clone(),
            contenders[job.contender].to_string(),
            job.scenario.seed.to_string(),
            run.success.to_string(),
            run.ticks.to_string(),
            run.path_cost.to_string(),
            number(run.path_ratio),
            number(run.min_separation),
            run.pairs_below_min_separation.to_string(),
            run.collisions.to_string(),
            run.activations.to_string(),
            run.infeasible.to_string(),
            run.shielded.to_string(),
            format!("{step_us:.3}"),
        ]);
    }
    table
}

/// Sorted numbers.
struct Spread(Vec<f64>);

impl Spread {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        Self(values)
    }

    /// The middle, or the mean of the two in the middle; `-` of nothing.
    fn median(&self, digits: usize) -> String {
        let middle = self.0.len() / 2;
        match self.0.as_slice() {
            [] => "-".into(),
            values if values.len() % 2 == 1 => format!("{:.digits$}", values[middle]),
            values => format!("{:.digits$}", (values[middle - 1] + values[middle]) / 2.0),
        }
    }

    fn range(&self, digits: usize) -> String {
        match self.0.as_slice() {
            [least, .., most] => format!("{least:.digits$}..{most:.digits$}"),
            _ => "-".into(),
        }
    }

    fn least(&self, digits: usize) -> String {
        self.0.first().map_or("-".into(), |least| format!("{least:.digits$}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Plan;

    #[test]
    fn medians_and_ranges_are_those_of_the_numbers() {
        let spread = Spread::of([3.0, 1.0, 2.0, 10.0].into_iter());
        assert_eq!((spread.median(1), spread.range(0), spread.least(0)), ("2.5".into(), "1..10".into(), "1".into()));
        let one = Spread::of([3.0].into_iter());
        assert_eq!((one.median(0), one.range(0)), ("3".into(), "-".into()));
        assert_eq!(Spread::of(std::iter::empty()).median(0), "-");
    }

    #[test]
    fn every_controller_gets_a_row_per_family_and_every_run_a_line() {
        let plan = Plan {
            scenarios: vec!["rand8o0_s0".into(), "rand8o0_s1".into(), "two_setpoint".into()],
            contenders: ["safe:fixed:20", "orca-rh"].iter().map(|spec| spec.parse().unwrap()).collect(),
            seeds: vec![0, 1],
            spread: 0.05,
            sets: vec![],
            max_ticks: Some(4),
        };
        let jobs = plan.jobs().unwrap();
        let runs: Vec<Run> = jobs.iter().map(super::super::Job::run).collect();
        let text = by_family(&plan.contenders, &jobs, &runs).csv();
        let firsts: Vec<&str> = text.lines().skip(1).map(|line| line.split(",-").next().unwrap()).collect();
        let expected = [
            "rand8o0,safe:fixed:20,0/4",
            "rand8o0,orca-rh,0/4",
            "two_setpoint,safe:fixed:20,0/2",
            "two_setpoint,orca-rh,0/2",
        ];
        assert_eq!(firsts, expected);
        assert_eq!(by_run(&plan.contenders, &jobs, &runs).csv().lines().count(), 1 + 3 * 2 * 2);
    }
}
