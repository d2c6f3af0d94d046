//! Teams of processes that are measured: the product's own coordinator and exchange, nothing else.

use super::{BenchError, partner};
use coordinator::horizons::RunHorizons;
use coordinator::launch::Program;
use coordinator::policy::PolicyOptions;
use coordinator::record::{RecordError, RunFolder, write_setup};
use coordinator::run::{Episode, EpisodeDriver, Options, Outcome, Run, RunTick};
use coordinator::team::ProcessTeam;
use shared::exchange::Kind;
use shared::stop::StopFlag;
use std::time::{Duration, Instant};
use vodca::metrics::RunMetrics;
use vodca::params::Profile;
use vodca::play::{Observer, Verdict};
use vodca::scenario::{Scenario, set_up};

/// What robots do in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Load {
    /// Hear everybody, publish, report.
    NoQp,
    /// The controller of the profile `safe`.
    Safe,
}

impl Load {
    /// All of them with their names in tables.
    pub(super) const ALL: [(Load, &'static str); 2] = [(Self::NoQp, "no QP"), (Self::Safe, "safe")];
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
    /// Ticks in all: a team that has arrived goes back to its start and drives again.
    pub(super) ticks: u64,
}

/// What a team came to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Driven {
    /// From starting processes until tick 0 could be announced.
    pub(super) start: Duration,
    /// Ticks done.
    pub(super) ticks: u64,
    /// From the announcement of tick 0 to the end of the last tick.
    pub(super) driving: Duration,
}

/// What accompanies a team that is measured.
pub(super) trait Companion {
    /// Everybody is there; tick 0 is announced when this returns.
    fn ready(&mut self) -> Result<(), BenchError> {
        Ok(())
    }

    /// A tick is done, the `number`th of the team from 0; what this does takes place between two ticks.
    fn tick(&mut self, number: u64, tick: &RunTick<'_>) -> Result<(), BenchError>;
}

/// Nothing but a tick to be seen.
impl<F: FnMut(u64, &RunTick<'_>) -> Result<(), BenchError>> Companion for F {
    fn tick(&mut self, number: u64, tick: &RunTick<'_>) -> Result<(), BenchError> {
        self(number, tick)
    }
}

/// Starts the team, lets it drive until its ticks are used up, and ends it.
pub(super) fn drive(spec: &TeamSpec<'_>, stop: &StopFlag, companion: &mut dyn Companion) -> Result<Driven, BenchError> {
    drive_with(spec, None, stop, companion)
}

/// [`drive`] with horizons of a policy.
pub(super) fn drive_with(
    spec: &TeamSpec<'_>,
    policy: Option<PolicyOptions>,
    stop: &StopFlag,
    companion: &mut dyn Companion,
) -> Result<Driven, BenchError> {
    let (mut scenario, params) = set_up(Some(spec.scenario), None, Profile::Safe, &[])?;
    if spec.load == Load::NoQp {
        scenario.max_ticks = spec.ticks; // they never arrive
    }
    let home = tempfile::tempdir().map_err(|source| BenchError::System { what: "make a folder", source })?;
    let folder = RunFolder::at(&home.path().join("run"))?;
    write_setup(&folder, &scenario, &params)?;

    let robots = scenario.robots.len();
    let options = options(&folder, &scenario, spec, policy)?;
    let began = Instant::now();
    let run = Run::launch(&scenario, &params, options, stop)?;
    let mut laps = Laps { spec, companion, began, first: 0, driven: None, failed: None };
    let ended = run.play_episodes(&mut laps)?;
    let (failed, driven) = (laps.failed, laps.driven.unwrap_or_default());
    if let Some(error) = failed {
        return Err(error);
    }
    match ended.outcome {
        Outcome::Completed | Outcome::TimedOut => Ok(driven),
        Outcome::Stopped => Err(BenchError::Stopped),
        Outcome::PeerLost(lost) => Err(BenchError::Team { robots, reason: lost.to_string() }),
    }
}

fn options(
    folder: &RunFolder,
    scenario: &Scenario,
    spec: &TeamSpec<'_>,
    policy: Option<PolicyOptions>,
) -> Result<Options, BenchError> {
    let mut options = Options::new(folder.path(), scenario).map_err(coordinator::run::RunError::from)?;
    options.exchange = spec.kind.unwrap_or(options.exchange);
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
    Ok(options)
}

/// Episode after episode until the ticks are used up.
struct Laps<'a> {
    spec: &'a TeamSpec<'a>,
    companion: &'a mut dyn Companion,
    /// Start of the processes.
    began: Instant,
    /// Announcement of the first tick, ns.
    first: u64,
    /// `None` before the first episode.
    driven: Option<Driven>,
    failed: Option<BenchError>,
}

impl Laps<'_> {
    fn over(&self) -> bool {
        self.failed.is_some() || self.driven.is_some_and(|driven| driven.ticks >= self.spec.ticks)
    }
}

impl EpisodeDriver for Laps<'_> {
    fn begin(&mut self, _: &Episode<'_>) -> Result<Option<[u8; 32]>, RecordError> {
        if self.driven.is_none() {
            self.driven = Some(Driven { start: self.began.elapsed(), ..Driven::default() });
            self.failed = self.companion.ready().err();
        }
        Ok(None)
    }

    fn another(&mut self, _: &RunMetrics) -> Result<bool, RecordError> {
        Ok(!self.over())
    }
}

impl Observer<ProcessTeam, RunHorizons> for Laps<'_> {
    type Error = RecordError;

    fn tick(&mut self, tick: &RunTick<'_>) -> Result<Verdict, RecordError> {
        let moments = tick.team.moments();
        let driven = self.driven.get_or_insert_default();
        if driven.ticks == 0 {
            self.first = moments.announced;
        }
        let number = driven.ticks;
        driven.ticks += 1;
        driven.driving = Duration::from_nanos(moments.collected.saturating_sub(self.first));
        if self.failed.is_none() {
            self.failed = self.companion.tick(number, tick).err();
        }
        let arrived = self.spec.load != Load::NoQp && tick.metrics.arrived_all();
        Ok(if arrived || self.over() { Verdict::Over } else { Verdict::Continue })
    }
}
