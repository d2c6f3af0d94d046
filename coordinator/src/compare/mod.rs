//! Comparisons of controllers over scenarios and seeds, all in this process.

mod contender;
mod layouts;
mod plan;
mod sample;
mod summary;
mod tables;

pub use contender::{Contender, ContenderError};
pub use layouts::{Entry, EntryError, expand};
pub use plan::{CompareError, Job, Plan};
pub use sample::{Median, Sample};
pub use summary::{Comparison, Row, VERSION};
pub use tables::{by_family, by_run};

use crate::in_process::run_whole;
use shared::metrics::RunSummary;

/// How one run went.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its figures, without those of single robots.
    pub summary: RunSummary,
    /// Mean time from having all messages to having a plan, us.
    pub step_us: f64,
    /// Half of these times are no longer than this, us.
    pub step_p50_us: f64,
}

impl Job {
    /// r_min of its parameters, m.
    pub fn min_separation(&self) -> f64 {
        self.params.model.min_separation
    }

    /// Does the run.
    pub fn run(&self) -> Run {
        let mut nanoseconds: Vec<u64> = Vec::new();
        let mut summary = run_whole(&self.scenario, &self.params, &self.source, |steps| {
            nanoseconds.extend(steps.iter().map(|step| step.step_ns));
        });
        summary.robots = Vec::new(); // Ten thousand runs are kept at once.
        let count = nanoseconds.len().max(1);
        let mean = nanoseconds.iter().sum::<u64>() as f64 / count as f64;
        let half = match nanoseconds.len() {
            0 => 0,
            count => *nanoseconds.select_nth_unstable(count / 2).1,
        };
        Run { summary, step_us: mean / 1e3, step_p50_us: half as f64 / 1e3 }
    }
}
