//! The runs of a comparison, on all cores.

use super::experiment::{Job, Source};
use crate::in_process::drive;
use crate::parallel;
use coordinator::policy::client::{ClientError, PolicyClient};
use coordinator::solver_check::SolverCheck;
use shared::stop::StopFlag;
use std::convert::Infallible;
use std::sync::{Mutex, PoisonError};
use vodca::metrics::RunSummary;
use vodca::play;
use vodca::step::Step;
use vodca::team::Team;

/// Policy servers that a core keeps at a time.
const MOST_SERVERS: usize = 4;

/// A run that was done, and how it went.
#[derive(Clone, Debug)]
pub struct Run<'a> {
    /// What was to be done.
    pub job: &'a Job,
    /// Its figures, without those of single robots.
    pub summary: RunSummary,
    /// Mean time from having all messages to having a plan, us.
    pub step_us: f64,
    /// Half of these times are no longer than this, us.
    pub step_p50_us: f64,
    /// What solving every QP twice has found, where that was asked for.
    pub solver_check: Option<SolverCheck>,
}

/// What became of all runs.
#[derive(Debug)]
pub struct Runs<'a> {
    /// By job; `None`: not done, because somebody asked to stop or because of the failure.
    pub done: Vec<Option<Run<'a>>>,
    /// Why not all were done, unless a stop was asked for.
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

impl From<Infallible> for Halt {
    fn from(never: Infallible) -> Self {
        match never {}
    }
}

/// Why a team in this process, with horizons that may fail with `H`, did not come to its end.
fn halt<H: Into<Halt>>(ended: play::Halt<Infallible, H, Halt>) -> Halt {
    match ended {
        play::Halt::Team(never) => match never {},
        play::Halt::Horizons(error) => error.into(),
        play::Halt::Observer(halt) => halt,
    }
}

/// Does all runs on all cores until `stop` is set or a policy gives no answer; `advance` is told after each.
/// What a run gives depends on nothing but its job.
pub fn run_all<'a>(jobs: &'a [Job], stop: &StopFlag, advance: impl Fn() + Sync) -> Runs<'a> {
    let halt = StopFlag::default(); // one run failed: the others need not go on
    let failure = Mutex::new(None);
    let work = |servers: &mut Vec<PolicyClient>, job: &'a Job| match job.run(servers, [stop, &halt]) {
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
    fn run(&self, servers: &mut Vec<PolicyClient>, stops: [&StopFlag; 2]) -> Result<Run<'_>, Halt> {
        let go_on = || if stops.iter().any(|stop| stop.is_set()) { Err(Halt::Stopped) } else { Ok(()) };
        go_on()?;
        let (scenario, params) = (&self.scenario, &self.params);
        let mut nanoseconds: Vec<u64> = Vec::new();
        let on_tick = |_, steps: &[Step]| {
            nanoseconds.extend(steps.iter().map(|step| step.step_ns));
            go_on()
        };
        let build = if self.check_solver { Team::checked } else { Team::new };
        let mut team = build(scenario, params, scenario.seed);
        let metrics = match &self.source {
            Source::Table(source) => drive(&mut team, scenario, params, &mut source.clone(), on_tick).map_err(halt)?,
            Source::Policy(policy) => {
                let mut client = match servers.iter().position(|client| client.policy() == policy) {
                    Some(at) => servers.remove(at),
                    None => {
                        servers.drain(..servers.len().saturating_sub(MOST_SERVERS - 1));
                        PolicyClient::start(policy, scenario, params, stops[0])?
                    }
                };
                let mut horizons = client.horizons(params, scenario.seed);
                let metrics = drive(&mut team, scenario, params, &mut horizons, on_tick).map_err(halt)?;
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
        Ok(Run {
            job: self,
            summary,
            step_us: mean / 1e3,
            step_p50_us: half as f64 / 1e3,
            solver_check: team.comparison().map(SolverCheck::from),
        })
    }
}
