//! The figures of a comparison by family and controller: `summary.json` and the table for reading.

use super::{Job, Median, Plan, Run, Sample};
use coordinator::record::about::{Machine, Versions};
use serde::Serialize;

/// Version of the format; fields are only added within a version.
pub const VERSION: u32 = 1;

/// The content of `summary.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// [`VERSION`].
    pub version: u32,
    /// The command line.
    pub command: Vec<String>,
    /// Seeds of what is random.
    pub seeds: Vec<u64>,
    /// Largest move of a start per axis, m.
    pub start_jitter: f64,
    /// Parameters changed for all.
    pub sets: Vec<String>,
    /// Last tick in place of the scenarios'.
    pub max_ticks: Option<u64>,
    /// What ran.
    pub versions: Versions,
    /// Where it ran.
    pub machine: Machine,
    /// One per family and controller.
    pub rows: Vec<Row>,
    /// One per controller, over all families.
    pub totals: Vec<Row>,
}

/// The runs of one family with one controller. Medians are over the runs that succeeded; separations over
/// all runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Scenarios that differ by their seed only; `all` in a total.
    pub family: String,
    /// The controller as given.
    pub controller: String,
    /// Number of runs.
    pub runs: usize,
    /// Runs in which all arrived and nobody collided.
    pub successes: usize,
    /// Path over straight lines.
    pub ratio: Option<Median>,
    /// Ticks until all had arrived.
    pub ticks: Option<Median>,
    /// Seconds until all had arrived.
    pub time_s: Option<Median>,
    /// Smallest separation, between samples too, m.
    pub min_separation: Option<f64>,
    /// Runs in which some pair was below min_separation.
    pub runs_below: usize,
    /// Such pairs.
    pub pairs_below: u64,
    /// Pairs that collided.
    pub collisions: u64,
    /// Time of an agent's step: median over the runs of their medians, us.
    pub step_p50_us: Option<f64>,
    /// The same of their means, us.
    pub step_us: Option<f64>,
}

/// The name of a total's family.
pub(super) const ALL: &str = "all";

impl Comparison {
    /// Puts `runs`, the results of `jobs` in their order, together.
    pub fn new(plan: &Plan, jobs: &[Job], runs: &[Run]) -> Self {
        let mut families: Vec<&str> = Vec::new();
        for entry in &plan.entries {
            if !families.contains(&entry.family.as_str()) {
                families.push(&entry.family);
            }
        }
        let group = |contender: usize, family: Option<&str>| -> Vec<&Run> {
            let belongs = |job: &Job| {
                job.contender == contender && family.is_none_or(|family| plan.entries[job.entry].family == family)
            };
            jobs.iter().zip(runs).filter(|(job, _)| belongs(job)).map(|(_, run)| run).collect()
        };
        let controllers = || plan.contenders.iter().map(ToString::to_string).enumerate();
        let row = |family: Option<&str>, (index, controller): (usize, String)| {
            Row::of(family.unwrap_or(ALL).into(), controller, &group(index, family))
        };
        Self {
            version: VERSION,
            command: std::iter::once("./run.sh".to_string()).chain(std::env::args().skip(1)).collect(),
            seeds: plan.seeds.clone(),
            start_jitter: plan.start_jitter,
            sets: plan.sets.clone(),
            max_ticks: plan.max_ticks,
            versions: Versions::here(),
            machine: Machine::here(),
            rows: families
                .iter()
                .flat_map(|family| controllers().map(|controller| row(Some(family), controller)))
                .collect(),
            totals: controllers().map(|controller| row(None, controller)).collect(),
        }
    }
}

impl Row {
    fn of(family: String, controller: String, runs: &[&Run]) -> Self {
        let good: Vec<_> = runs.iter().map(|run| &run.summary).filter(|run| run.success).collect();
        Self {
            family,
            controller,
            runs: runs.len(),
            successes: good.len(),
            ratio: Sample::of(good.iter().filter_map(|run| run.path_ratio)).median(),
            ticks: Sample::of(good.iter().map(|run| run.ticks as f64)).median(),
            time_s: Sample::of(good.iter().filter_map(|run| run.completion_time)).median(),
            min_separation: Sample::of(runs.iter().filter_map(|run| run.summary.min_separation)).least(),
            runs_below: runs.iter().filter(|run| run.summary.pairs_below_min_separation > 0).count(),
            pairs_below: runs.iter().map(|run| run.summary.pairs_below_min_separation).sum(),
            collisions: runs.iter().map(|run| run.summary.collisions).sum(),
            step_p50_us: Sample::of(runs.iter().map(|run| run.step_p50_us)).middle(),
            step_us: Sample::of(runs.iter().map(|run| run.step_us)).middle(),
        }
    }
}
