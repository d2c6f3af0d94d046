//! A controller with several variants counts with its best one in each layout: what a patient user of it would
//! have found by hand.

use super::{Experiment, Job, Run, Sample};
use crate::text_table::TextTable;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// Name of the controller that tries all [`orca_variants`].
pub(super) const ORCA_BEST: &str = "orca-best";

/// Time horizons of ORCA that are tried, s: short ones pass close by, long ones give way early.
const TIME_HORIZONS: [f64; 4] = [1.0, 2.0, 5.0, 10.0];
/// Pushes, m/s. None at all is no choice: from an exactly symmetric start plain ORCA stands still for ever.
const PUSHES: [f64; 2] = [0.05, 0.3];
/// Aims, rad: straight at the set-point, or keeping to the right.
const AIMS: [f64; 2] = [0.0, 0.35];

/// What [`ORCA_BEST`] chooses from: every time horizon with every push and every aim, as settings of parameters.
pub(super) fn orca_variants() -> Vec<Vec<String>> {
    let mut variants = Vec::new();
    for time_horizon in TIME_HORIZONS {
        for push in PUSHES {
            for aim in AIMS {
                variants.push(vec![
                    format!("orca.time_horizon={time_horizon}"),
                    format!("orca.push={push}"),
                    format!("orca.aim={aim}"),
                ]);
            }
        }
    }
    variants
}

/// Settings for reading: without the group of the parameters, `time_horizon=5 push=0.05 aim=0`.
pub(super) fn in_short(settings: &[String]) -> String {
    let short = |set: &String| match set.split_once('=') {
        Some((key, value)) => format!("{}={value}", key.rsplit('.').next().unwrap_or(key)),
        None => set.clone(),
    };
    settings.iter().map(short).collect::<Vec<_>>().join(" ")
}

/// How one variant of a controller did in one layout.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// Index into [`Experiment::entries`].
    pub entry: usize,
    /// Index into [`Experiment::controllers`].
    pub controller: usize,
    /// Index into the controller's variants.
    pub variant: usize,
    /// Runs, one per seed.
    pub runs: usize,
    /// Runs in which all arrived and nobody collided.
    pub successes: usize,
    /// Median time until all had arrived over those, s.
    pub time_s: Option<f64>,
    /// Median path over those, m.
    pub path_m: Option<f64>,
    /// Whether its runs are the controller's in this layout.
    pub best: bool,
}

impl Tried {
    fn of(runs: &[Run]) -> Option<Self> {
        let job = runs.first()?.job;
        let good = || runs.iter().map(|run| &run.summary).filter(|run| run.success);
        Some(Self {
            entry: job.entry,
            controller: job.controller,
            variant: job.variant,
            runs: runs.len(),
            successes: good().count(),
            time_s: Sample::of(good().filter_map(|run| run.completion_time)).middle(),
            path_m: Sample::of(good().map(|run| run.path_cost)).middle(),
            best: false,
        })
    }

    /// More successes come first, then a shorter time, then a shorter path.
    fn order(&self, other: &Self) -> Ordering {
        let last = |value: Option<f64>| value.unwrap_or(f64::INFINITY);
        let by_time = || last(self.time_s).total_cmp(&last(other.time_s));
        let by_path = || last(self.path_m).total_cmp(&last(other.path_m));
        other.successes.cmp(&self.successes).then_with(by_time).then_with(by_path)
    }
}

/// What counts of a comparison.
#[derive(Debug)]
pub struct Counted<'a> {
    /// In the order of their jobs.
    pub runs: Vec<Run<'a>>,
    /// How every variant of a controller with several did.
    pub tried: Vec<Tried>,
}

/// Leaves out what was not done and, of a controller with variants, all but its best one in each layout (of equal ones
/// the first). A layout in which not all of them were done has no best one. `done` are the results of `jobs`.
pub fn keep_best<'a>(experiment: &Experiment, jobs: &[Job], done: Vec<Option<Run<'a>>>) -> Counted<'a> {
    let row = |job: &Job| (job.entry, job.controller);
    let has_variants = |job: &Job| experiment.controllers[job.controller].variants.len() > 1;
    let undone: BTreeSet<_> =
        jobs.iter().zip(&done).filter(|(_, run)| run.is_none()).map(|(job, _)| row(job)).collect();
    let mut runs: Vec<Run> = done.into_iter().flatten().collect();
    runs.retain(|run| !(has_variants(run.job) && undone.contains(&row(run.job))));
    let mut tried: Vec<Tried> = runs
        .chunk_by(|a, b| (row(a.job), a.job.variant) == (row(b.job), b.job.variant))
        .filter(|variant| variant.iter().all(|run| has_variants(run.job)))
        .filter_map(Tried::of)
        .collect();
    let mut best = BTreeMap::new();
    for row in tried.chunk_by_mut(|a, b| (a.entry, a.controller) == (b.entry, b.controller)) {
        if let Some(first) = row.iter_mut().min_by(|a, b| a.order(b)) {
            first.best = true;
            best.insert((first.entry, first.controller), first.variant);
        }
    }
    runs.retain(|run| best.get(&row(run.job)).is_none_or(|&variant| variant == run.job.variant));
    Counted { runs, tried }
}

/// One row per layout and variant: what was tried, and which of it counts.
pub fn by_variant(experiment: &Experiment, tried: &[Tried]) -> TextTable {
    let mut table =
        TextTable::new(&["layout", "controller", "variant", "runs", "successes", "time_s", "path_m", "best"]);
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for one in tried {
        let controller = &experiment.controllers[one.controller];
        table.row([
            experiment.entries[one.entry].spec.clone(),
            controller.to_string(),
            in_short(&controller.variants[one.variant]),
            one.runs.to_string(),
            one.successes.to_string(),
            number(one.time_s),
            number(one.path_m),
            one.best.to_string(),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{ControllerSpecs, expand, run_all};
    use shared::stop::StopFlag;

    fn experiment(controllers: &[&str], max_ticks: u64) -> Experiment {
        Experiment {
            entries: expand("two_setpoint").unwrap(),
            controllers: controllers.iter().flat_map(|spec| spec.parse::<ControllerSpecs>().unwrap().0).collect(),
            seeds: vec![0, 1],
            start_jitter: 0.0,
            sets: vec![],
            max_ticks: Some(max_ticks),
            check_solver: false,
        }
    }

    #[test]
    fn every_time_horizon_is_tried_with_every_push_and_aim() {
        let variants = orca_variants();
        assert_eq!((variants.len(), in_short(&variants[0])), (16, "time_horizon=1 push=0.05 aim=0".into()));
        assert_eq!(in_short(&variants[15]), "time_horizon=10 push=0.3 aim=0.35");
    }

    #[test]
    fn the_best_is_the_variant_that_most_often_arrives_and_then_the_fastest() {
        let tried = |successes, time_s, path_m| Tried {
            entry: 0,
            controller: 0,
            variant: 0,
            runs: 2,
            successes,
            time_s,
            path_m,
            best: false,
        };
        let arrives = tried(2, Some(20.0), Some(50.0));
        assert!(arrives.order(&tried(1, Some(10.0), Some(40.0))).is_lt());
        assert!(arrives.order(&tried(2, Some(21.0), Some(40.0))).is_lt());
        assert!(arrives.order(&tried(2, Some(20.0), Some(51.0))).is_lt());
        assert!(
            arrives.order(&tried(0, None, None)).is_lt() && tried(0, None, None).order(&tried(0, None, None)).is_eq()
        );
    }

    #[test]
    fn only_the_runs_of_the_best_variant_count_and_others_stay_as_they_are() {
        let experiment = experiment(&["orca-best", "orca"], 300);
        let jobs = experiment.jobs().unwrap();
        assert_eq!(jobs.len(), 16 * 2 + 1);
        let done = run_all(&jobs, &StopFlag::default(), || ()).done;
        let Counted { runs: kept, tried } = keep_best(&experiment, &jobs, done);
        assert_eq!((kept.len(), tried.len()), (2 + 1, 16));
        let [best] = tried.iter().filter(|one| one.best).collect::<Vec<_>>()[..] else { panic!("one is the best") };
        assert!(kept[..2].iter().all(|run| run.job.variant == best.variant && run.summary.success));
        assert!(tried.iter().all(|one| !one.order(best).is_lt()), "{tried:?}");
        let lines = by_variant(&experiment, &tried).csv();
        assert_eq!((lines.lines().count(), lines.matches(",true\n").count()), (1 + 16, 1));
    }

    #[test]
    fn a_layout_of_which_a_variant_was_not_done_has_no_best_one() {
        let experiment = experiment(&["orca-best", "orca"], 3);
        let jobs = experiment.jobs().unwrap();
        let mut done = run_all(&jobs, &StopFlag::default(), || ()).done;
        done[31] = None;
        let Counted { runs, tried } = keep_best(&experiment, &jobs, done);
        assert_eq!((runs.len(), tried.len()), (1, 0));
    }
}
