//! Teams of processes that are measured: the product's own coordinator and exchange, nothing else.

use super::{BenchError, partner};
use coordinator::launch::Program;
use coordinator::policy::PolicyOptions;
use coordinator::record::{PARAMS_FILE, RecordError, RunFolder, SCENARIO_FILE};
use coordinator::run::{Options, Outcome, Run, RunTick};
use shared::exchange::Kind;
use shared::stop::StopFlag;
use std::time::{Duration, Instant};
use vodca::metrics::RunMetrics;
use vodca::params::Profile;
use vodca::play::Verdict;
use vodca::scenario::set_up;

/// What robots do in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Load {
    /// Hear everybody, publish, report.
    NoQp,
    /// The controller of the profile `safe`.
    Safe,
    /// The controller of the profile `paper`.
    Paper,
}

impl Load {
    /// All of them with their names in tables.
    pub(super) const ALL: [(Load, &'static str); 3] =
        [(Self::NoQp, "no QP"), (Self::Safe, "safe"), (Self::Paper, "paper")];
}

/// A team to be measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct TeamSpec<'a> {
    /// Scenario by name, `ring:14` for instance.
    pub(super) scenario: &'a str,
    /// What its robots do.
    pub(super) load: Load,
    /// The form of the exchange; `None`: the default for the number of robots.
    pub(super) kind: Option<Kind>,
    /// One tick per sample time.
    pub(super) real_time: bool,
    /// Ticks at most; robots without a QP never arrive.
    pub(super) ticks: u64,
}

/// What a team came to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Driven {
    /// From starting processes to the announcement of tick 0.
    pub(super) start: Duration,
    /// Ticks done.
    pub(super) ticks: u64,
    /// From the announcement of tick 0 to the end of the last tick.
    pub(super) driving: Duration,
}

/// Starts the team, lets it drive until it has arrived or its ticks are used up, and ends it. Ticks are
/// handed to `observe`; what that does takes place between two ticks.
pub(super) fn drive(
    spec: &TeamSpec<'_>,
    stop: &StopFlag,
    observe: &mut dyn FnMut(&RunTick<'_>) -> Result<(), BenchError>,
) -> Result<Driven, BenchError> {
    drive_with(spec, None, stop, observe)
}

/// [`drive`] with horizons of a policy.
pub(super) fn drive_with(
    spec: &TeamSpec<'_>,
    policy: Option<PolicyOptions>,
    stop: &StopFlag,
    observe: &mut dyn FnMut(&RunTick<'_>) -> Result<(), BenchError>,
) -> Result<Driven, BenchError> {
    let profile = if spec.load == Load::Paper { Profile::Paper } else { Profile::Safe };
    let (mut scenario, params) = set_up(Some(spec.scenario), None, profile, &[])?;
    scenario.max_ticks = spec.ticks;
    let home = tempfile::tempdir().map_err(|source| BenchError::System { what: "make a folder", source })?;
    let folder = RunFolder::at(&home.path().join("run"))?;
    let text = scenario.to_toml().map_err(|error| RecordError::Encode {
        path: folder.file(SCENARIO_FILE),
        what: "the scenario",
        reason: error.to_string(),
    })?;
    folder.write(SCENARIO_FILE, text.as_bytes())?;
    folder.write(PARAMS_FILE, params.to_toml().as_bytes())?;

    let robots = scenario.robots.len();
    let mut options = Options::new(folder.path(), &scenario).map_err(coordinator::run::RunError::from)?;
    options.exchange = spec.kind.unwrap_or(Kind::default_for(robots));
    options.real_time = spec.real_time;
    options.policy = policy;
    options.tick_deadline = Duration::from_secs(20); // a busy machine shall spoil a figure, not the benchmark
    options.start_patience = Duration::from_secs(120);
    if spec.load == Load::NoQp {
        let path = std::env::current_exe().map_err(|source| BenchError::System { what: "find itself", source })?;
        options.agents = coordinator::launch::Agents::Launch(Program {
            path,
            arguments: vec![partner::COMMAND.into(), "still".into()],
        });
    }
    let (mut metrics, mut failed, mut driven) = (RunMetrics::new(&scenario, &params), None, Driven::default());
    let mut first = 0;
    let began = Instant::now();
    let run = Run::launch(&scenario, &params, options, stop)?;
    let mut watch = |tick: &RunTick<'_>| {
        if tick.tick == 0 {
            // What has passed since the announcement belongs to the tick.
            let since = Duration::from_nanos(shared::os::now_ns().saturating_sub(tick.team.moments().announced));
            driven.start = began.elapsed().saturating_sub(since);
            first = tick.team.moments().announced;
        }
        driven.ticks = tick.tick + 1;
        driven.driving = Duration::from_nanos(tick.team.moments().collected.saturating_sub(first));
        if let Err(error) = observe(tick) {
            failed = Some(error);
            return Ok(Verdict::Over);
        }
        Ok(Verdict::Continue)
    };
    let ended = run.play(&mut [&mut watch], &mut metrics)?;
    if let Some(error) = failed {
        return Err(error);
    }
    match ended.outcome {
        Outcome::Completed | Outcome::TimedOut => Ok(driven),
        Outcome::Stopped => Err(BenchError::Stopped),
        Outcome::PeerLost(lost) => Err(BenchError::Team { robots, reason: lost.to_string() }),
    }
}
