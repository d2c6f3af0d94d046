//! Comparisons of controllers over scenarios and seeds, all in this process.

mod contender;
mod layouts;
mod plan;
mod sample;
mod summary;
mod tables;

pub use contender::{Contender, ContenderError, Contenders, HorizonPart};
pub use layouts::{Entry, EntryError, expand};
pub use plan::{CompareError, Job, Plan};
pub use sample::{Median, Sample};
pub use summary::{Comparison, Row, VERSION};
pub use tables::{by_family, by_run};

use crate::in_process::run_team;
use crate::parallel;
use coordinator::policy::client::{ClientError, PolicyClient};
use plan::Source;
use shared::stop::StopFlag;
use std::convert::Infallible;
use std::sync::Mutex;
use std::sync::PoisonError;
use vodca::metrics::RunSummary;
use vodca::play;
use vodca::step::Step;

/// Policy servers that a core keeps at a time.
const MOST_SERVERS: usize = 4;

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

/// What became of all runs.
#[derive(Debug)]
pub struct Runs {
    /// By job; `None`: not done, because somebody asked to stop or because of the failure.
    pub done: Vec<Option<Run>>,
    /// Why not all were done, when nobody asked for it.
    pub failure: Option<ClientError>,
}

/// Why a run did not come to its end.
enum Halt {
    Stopped,
    Failed(ClientError),
}

impl From<ClientError> for Halt {
    fn from(error: ClientError) -> Self {
        Self::Failed(error)
    }
}

/// A run of a team in this process with horizons that may fail with `H`.
fn halt<H: Into<Halt>>(ended: play::Halt<Infallible, H, Halt>) -> Halt {
    match ended {
        play::Halt::Team(never) => match never {},
        play::Halt::Horizons(error) => error.into(),
        play::Halt::Observer(halt) => halt,
    }
}

impl From<Infallible> for Halt {
    fn from(never: Infallible) -> Self {
        match never {}
    }
}

/// Does all runs on all cores until `stop` is set or a policy gives no answer; `advance` is told after each.
/// What a run gives depends on nothing but its job.
pub fn run_all(jobs: &[Job], stop: &StopFlag, advance: impl Fn() + Sync) -> Runs {
    let halt = StopFlag::default(); // one run failed: the others need not go on
    let failure = Mutex::new(None);
    let work = |servers: &mut Vec<PolicyClient>, job: &Job| match job.run(servers, [stop, &halt]) {
        Ok(run) => {
            advance();
            Some(run)
        }
        Err(_) if stop.is_set() => None,
        Err(Halt::Stopped) => None,
        Err(Halt::Failed(error)) => {
            halt.set();
            failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            None
        }
    };
    let done = parallel::map_while(jobs, Vec::new, work);
    Runs { done, failure: failure.into_inner().unwrap_or_else(PoisonError::into_inner) }
}

impl Job {
    /// r_min of its parameters, m.
    pub fn min_separation(&self) -> f64 {
        self.params.model.min_separation
    }

    /// Does the run; `servers` are those that this core keeps, the one used last at the end.
    fn run(&self, servers: &mut Vec<PolicyClient>, stops: [&StopFlag; 2]) -> Result<Run, Halt> {
        let go_on = || if stops.iter().any(|stop| stop.is_set()) { Err(Halt::Stopped) } else { Ok(()) };
        go_on()?;
        let mut nanoseconds: Vec<u64> = Vec::new();
        let on_tick = |_, steps: &[Step]| {
            nanoseconds.extend(steps.iter().map(|step| step.step_ns));
            go_on()
        };
        let metrics = match &self.source {
            Source::Table(source) => {
                run_team(&self.scenario, &self.params, &mut source.clone(), on_tick).map_err(halt)?
            }
            Source::Policy(policy) => {
                let mut client = match servers.iter().position(|client| client.policy() == policy) {
                    Some(at) => servers.remove(at),
                    None => {
                        servers.drain(..servers.len().saturating_sub(MOST_SERVERS - 1));
                        PolicyClient::start(policy, &self.scenario, &self.params, stops[0])?
                    }
                };
                let mut horizons = client.horizons(&self.params, self.scenario.seed);
                let metrics = run_team(&self.scenario, &self.params, &mut horizons, on_tick).map_err(halt)?;
                servers.push(client);
                metrics
            }
        };
        let mut summary = metrics.finish();
        summary.robots = Vec::new(); // Ten thousand runs are kept at once.
        let count = nanoseconds.len().max(1);
        let mean = nanoseconds.iter().sum::<u64>() as f64 / count as f64;
        let half = match nanoseconds.len() {
            0 => 0,
            count => *nanoseconds.select_nth_unstable(count / 2).1,
        };
        Ok(Run { summary, step_us: mean / 1e3, step_p50_us: half as f64 / 1e3 })
    }
}
