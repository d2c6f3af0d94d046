//! The figures of a comparison by family and controller: `summary.json` and the table for reading.

use super::best::in_short;
use super::{ControllerSpec, Experiment, Median, Run, Sample, Tried};
use coordinator::record::about::{Machine, Versions};
use coordinator::solver_check::SolverCheck;
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
    /// What solving every QP twice has found over all runs, where that was asked for.
    pub solver_check: Option<SolverCheck>,
    /// What ran.
    pub versions: Versions,
    /// Where it ran.
    pub machine: Machine,
    /// One per family and controller.
    pub rows: Vec<Row>,
    /// One per controller, over all families.
    pub totals: Vec<Row>,
}

/// How the variants of a controller fared in a family: in each layout only the runs of its best one count.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BestOf {
    /// Number of variants.
    pub variants: usize,
    /// The one that was best in most layouts, the first of equal ones.
    pub variant: String,
    /// Layouts in which it was.
    pub best_in: usize,
    /// Layouts of the family.
    pub layouts: usize,
}

/// The runs of one family with one controller. Medians are over the runs that succeeded; separations over
/// all runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Scenarios that differ by their seed only; `all` in a total.
    pub family: String,
    /// The controller as given.
    pub controller: String,
    /// What its runs are the best of, when it has variants.
    pub best_of: Option<BestOf>,
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
    /// Puts together the runs that count, and which variants were the best ([`keep_best`](super::keep_best)).
    pub fn new(experiment: &Experiment, runs: &[Run], tried: &[Tried]) -> Self {
        let (families, family_of) = experiment.families();
        let controllers = experiment.controllers.len();
        let mut groups: Vec<Vec<&Run>> = vec![Vec::new(); families.len() * controllers];
        for run in runs {
            groups[family_of[run.job.entry] * controllers + run.job.controller].push(run);
        }
        let row = |family: Option<usize>, controller: usize, runs: &[&Run]| {
            let name = family.map_or(ALL, |family| families[family]).into();
            let spec = &experiment.controllers[controller];
            let belongs = |one: &&Tried| {
                one.best && one.controller == controller && family.is_none_or(|family| family_of[one.entry] == family)
            };
            Row::of(name, spec, BestOf::new(spec, tried.iter().filter(belongs)), runs)
        };
        let all =
            |controller: usize| -> Vec<&Run> { runs.iter().filter(|run| run.job.controller == controller).collect() };
        Self {
            version: VERSION,
            command: std::iter::once("./run.sh".to_string()).chain(std::env::args().skip(1)).collect(),
            seeds: experiment.seeds.clone(),
            start_jitter: experiment.start_jitter,
            sets: experiment.sets.clone(),
            max_ticks: experiment.max_ticks,
            solver_check: runs.iter().filter_map(|run| run.solver_check).reduce(SolverCheck::with),
            versions: Versions::here(),
            machine: Machine::here(),
            rows: groups
                .iter()
                .enumerate()
                .map(|(n, runs)| row(Some(n / controllers), n % controllers, runs))
                .collect(),
            totals: (0..controllers).map(|controller| row(None, controller, &all(controller))).collect(),
        }
    }
}

impl BestOf {
    /// `None`: the controller has no variants, or no layout was finished.
    fn new<'a>(spec: &ControllerSpec, best: impl Iterator<Item = &'a Tried>) -> Option<Self> {
        let mut wins = vec![0usize; spec.variants.len()];
        best.for_each(|one| wins[one.variant] += 1);
        let layouts = wins.iter().sum();
        let (variant, &best_in) = wins.iter().enumerate().rev().max_by_key(|(_, wins)| **wins)?;
        (layouts > 0).then(|| Self {
            variants: wins.len(),
            variant: in_short(&spec.variants[variant]),
            best_in,
            layouts,
        })
    }
}

impl Row {
    fn of(family: String, controller: &ControllerSpec, best_of: Option<BestOf>, runs: &[&Run]) -> Self {
        let good: Vec<_> = runs.iter().map(|run| &run.summary).filter(|run| run.success).collect();
        Self {
            family,
            controller: controller.to_string(),
            best_of,
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
