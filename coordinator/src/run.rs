//! A run of a team of processes: what it is told, from its start to its end, and how it can end.
//!
//! [`crate::team`] is the team, [`crate::horizons`] chooses the horizons, [`vodca::play`] is the loop.

use crate::clock::Overruns;
use crate::horizons::RunHorizons;
use crate::launch::{self, Agents, LaunchError};
use crate::members::Change;
use crate::policy::{PolicyError, PolicyOptions, PolicySummary};
use crate::record::RecordError;
use crate::roster::PeerLost;
use crate::team::{Interrupt, ProcessTeam};
use shared::chaos::Chaos;
use shared::exchange::Kind;
use shared::messages::MAX_ROBOTS;
use shared::runtime_dir::{RuntimeDir, RuntimeDirError};
use shared::services::ServiceError;
use shared::stop::StopFlag;
use shared::team::{Episodes, TeamError};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use vodca::horizon::Horizon;
use vodca::horizon_source::{HorizonSourceError, HorizonSpec};
use vodca::metrics::RunMetrics;
use vodca::params::Params;
use vodca::play::{Ending, Halt, Limits, Observer, Playable, Tick, Verdict, play};
use vodca::scenario::{Scenario, ScenarioError};
use vodca::tasks::Tasks;

/// The usual [`Options::tick_deadline`]: a robot that hangs holds the others up no longer, or ends the run within 2 s.
pub const TICK_DEADLINE: Duration = Duration::from_millis(1200);
/// How long no further robot may come during the start.
pub const STALL: Duration = Duration::from_secs(3);

/// How long a robot may be silent before it is taken for dead and ended.
pub const LOST_AFTER: Duration = Duration::from_secs(5);

/// What a run does when a robot's process ends or falls silent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnLoss {
    /// It ends.
    Stop,
    /// The others drive on; the body that is left stands in their way.
    Continue {
        /// How often the process of a robot is started anew.
        respawn: u32,
    },
}

/// What one run is told beyond its scenario and parameters.
#[derive(Clone, Debug)]
pub struct Options {
    /// The run's folder; `scenario.toml` and `params.toml` are in it already.
    pub run: PathBuf,
    /// How robots come to life.
    pub agents: Agents,
    /// The form of the exchange.
    pub exchange: Kind,
    /// Where horizons come from without a policy.
    pub horizons: HorizonSpec,
    /// The policy that chooses them instead.
    pub policy: Option<PolicyOptions>,
    /// Seed of everything random in the first episode.
    pub seed: u64,
    /// What differs between episodes.
    pub episodes: Episodes,
    /// One tick per sample time rather than as fast as possible.
    pub real_time: bool,
    /// K, the most ticks.
    pub max_ticks: u64,
    /// How long a tick may take before a robot that has not answered is late (lost, where a loss ends the run).
    pub tick_deadline: Duration,
    /// What happens when a robot is lost after the first tick has begun.
    pub on_loss: OnLoss,
    /// How long a late robot may be silent before it is taken for dead and ended.
    pub lost_after: Duration,
    /// Where robots go that have arrived; orders from outside are taken then, too. `None`: they stay.
    pub tasks: Option<Tasks>,
    /// Faults on purpose.
    pub chaos: Chaos,
    /// How long robots may have to wait between two episodes.
    pub idle: Duration,
    /// How long the start may take. Of robots that are started here one is lost when, after the first
    /// was there, no further one comes for [`STALL`].
    pub start_patience: Duration,
}

impl Options {
    /// The usual values for `scenario`, run in `run` by robots that are started here.
    pub fn new(run: &Path, scenario: &Scenario) -> Result<Self, LaunchError> {
        Ok(Self {
            run: run.to_owned(),
            agents: Agents::Launch(launch::agent_program()?),
            exchange: Kind::default_for(scenario.robots.len()),
            horizons: HorizonSpec::Fixed(vec![Horizon::saturating(20)]),
            policy: None,
            seed: scenario.seed,
            episodes: Episodes::default(),
            real_time: false,
            max_ticks: scenario.max_ticks,
            tick_deadline: TICK_DEADLINE,
            on_loss: OnLoss::Stop,
            lost_after: LOST_AFTER,
            tasks: None,
            chaos: Chaos::default(),
            idle: Duration::ZERO,
            start_patience: Duration::from_secs(30),
        })
    }
}

/// Why a run could not be done. A run that was done, however it went, has an [`Outcome`].
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// Too many robots, or none.
    #[error("the scenario {scenario} has {robots} robots; a run can have 1..={MAX_ROBOTS}")]
    Robots {
        /// Its name.
        scenario: String,
        /// How many.
        robots: usize,
    },
    /// The place of its shared files.
    #[error(transparent)]
    RuntimeDir(#[from] RuntimeDirError),
    /// A file in its folder.
    #[error(transparent)]
    Team(#[from] TeamError),
    /// The layout of an episode.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Where horizons come from.
    #[error(transparent)]
    Horizons(#[from] HorizonSourceError),
    /// The robots' program.
    #[error(transparent)]
    Launch(#[from] LaunchError),
    /// The exchange.
    #[error(transparent)]
    Exchange(#[from] ServiceError),
    /// The policy server.
    #[error(transparent)]
    Policy(#[from] PolicyError),
    /// The observer could not record a tick.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// `iceoryx2.toml` cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Config {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Everybody had arrived, or an observer had seen enough.
    Completed,
    /// All ticks were used up.
    TimedOut,
    /// Somebody asked for it.
    Stopped,
    /// A robot ended or fell silent, and that ends the run ([`OnLoss::Stop`], or before the first tick).
    PeerLost(PeerLost),
}

/// How a run went.
#[derive(Clone, Debug, PartialEq)]
pub struct Ended {
    /// How it ended.
    pub outcome: Outcome,
    /// Ticks that began late (real time only).
    pub overruns: Overruns,
    /// What became of robots that did not take part all the time.
    pub changes: Vec<Change>,
    /// What the policy did.
    pub policy: Option<PolicySummary>,
}

/// A tick of a run, as its observers see it.
pub type RunTick<'a> = Tick<'a, ProcessTeam, RunHorizons>;
/// What watches a run.
pub type RunObserver<'a> = dyn Observer<ProcessTeam, RunHorizons, Error = RecordError> + 'a;

/// Plays episode after episode with one team of processes; an observer of every one of them.
pub trait EpisodeDriver: Observer<ProcessTeam, RunHorizons, Error = RecordError> {
    /// An episode begins. Gives the SHA-256 of the policy that must act in it, if that matters.
    fn begin(&mut self, episode: &Episode<'_>) -> Result<Option<[u8; 32]>, RecordError>;
    /// The episode has come to its end with these figures; `true`: another one.
    fn another(&mut self, metrics: &RunMetrics) -> Result<bool, RecordError>;
}

/// An episode that begins.
#[derive(Clone, Copy, Debug)]
pub struct Episode<'a> {
    /// Its number, from 0.
    pub number: u64,
    /// Seed of everything random in it.
    pub seed: u64,
    /// Its layout.
    pub scenario: &'a Scenario,
}

/// A team of processes and who chooses its horizons. Whatever happens, dropping it ends every process and deletes
/// every shared file of the run.
pub struct Run {
    // Dropped in this order: the policy server and the robots before the files of both.
    horizons: RunHorizons,
    team: ProcessTeam,
    until: Instant,
    max_ticks: u64,
}

impl Run {
    /// Makes the exchange, starts the policy server, if there is one, and the robots. Sweeps away what earlier runs
    /// left that were killed.
    ///
    /// # Errors
    /// Whatever of this the system refuses; nothing is left behind then.
    pub fn launch(scenario: &Scenario, params: &Params, options: Options, stop: &StopFlag) -> Result<Self, RunError> {
        let until = Instant::now() + options.start_patience;
        let max_ticks = options.max_ticks;
        let (spec, policy, run) = (options.horizons.clone(), options.policy.clone(), options.run.clone());
        let mut team = ProcessTeam::prepare(scenario, params, options, stop)?;
        let horizons = match policy {
            Some(policy) => RunHorizons::policy(policy, &team, &run, params.horizon.jitter, stop)?,
            None => RunHorizons::table(&spec, scenario.robots.len(), team.seed(), params.horizon.jitter)?,
        };
        team.start_robots()?;
        Ok(Self { horizons, team, until, max_ticks })
    }

    /// Runs until everybody has arrived, and ends the team in order whatever became of it. `metrics` are new and
    /// hold every finished tick afterwards.
    ///
    /// # Errors
    /// The run broke; a robot that was lost and a request to stop are outcomes.
    pub fn play<'a>(
        mut self,
        observers: &mut [&'a mut RunObserver<'a>],
        metrics: &mut RunMetrics,
    ) -> Result<Ended, RunError> {
        let limits = Limits { max_ticks: self.max_ticks, until_arrival: true };
        let outcome = match self.gather() {
            Ok(()) => self.episode(observers, metrics, limits),
            Err(interrupt) => interrupt.outcome(),
        };
        self.end(outcome)
    }

    /// Plays episode after episode until the driver has enough or one of them does not come to its end, and ends the
    /// team in order whatever became of it.
    ///
    /// # Errors
    /// As of [`Self::play`].
    pub fn play_episodes(mut self, driver: &mut dyn EpisodeDriver) -> Result<Ended, RunError> {
        let outcome = match self.gather() {
            Ok(()) => self.episodes(driver),
            Err(interrupt) => interrupt.outcome(),
        };
        self.end(outcome)
    }

    /// Waits until the policy server and all robots are there.
    fn gather(&mut self) -> Result<(), Interrupt> {
        if !self.horizons.gather(self.until).map_err(RunError::from)? {
            return Err(Interrupt::Stopped);
        }
        self.team.gather(self.until)
    }

    fn episodes(&mut self, driver: &mut dyn EpisodeDriver) -> Result<Outcome, RunError> {
        loop {
            let layout = self.team.episode()?;
            let (number, seed, scenario) = (layout.number, layout.seed, &layout.scenario);
            let wanted = driver.begin(&Episode { number, seed, scenario })?;
            self.horizons.begin(self.team.epoch(), seed)?;
            if let Some(wanted) = wanted
                && !self.horizons.await_version(&wanted, self.team.measured())?
            {
                return Ok(Outcome::Stopped);
            }
            let mut metrics = RunMetrics::new(scenario, self.team.params());
            let limits = Limits { max_ticks: self.max_ticks, until_arrival: false };
            let outcome = self.episode(&mut [&mut Driven(&mut *driver)], &mut metrics, limits)?;
            let came_to_its_end = matches!(outcome, Outcome::Completed | Outcome::TimedOut);
            if !came_to_its_end || !driver.another(&metrics)? {
                return Ok(outcome);
            }
            if let Err(interrupt) = self.team.next_episode() {
                return interrupt.outcome();
            }
        }
    }

    fn episode<'a>(
        &mut self,
        observers: &mut [&'a mut RunObserver<'a>],
        metrics: &mut RunMetrics,
        limits: Limits,
    ) -> Result<Outcome, RunError> {
        match play(&mut self.team, &mut self.horizons, observers, metrics, limits) {
            Ok(Ending::Over) => Ok(Outcome::Completed),
            Ok(Ending::OutOfTicks) => Ok(Outcome::TimedOut),
            Err(Halt::Team(interrupt)) => interrupt.outcome(),
            Err(Halt::Horizons(error)) => Err(error),
            Err(Halt::Observer(error)) => Err(error.into()),
        }
    }

    fn end(mut self, outcome: Result<Outcome, RunError>) -> Result<Ended, RunError> {
        let policy = self.horizons.end();
        let told = self.team.end(outcome.as_ref().ok());
        let outcome = outcome?; // what went wrong first is what counts
        told?;
        let changes = self.team.members().changes().to_vec();
        Ok(Ended { outcome, overruns: self.team.overruns(), changes, policy: policy? })
    }

    /// Where the run's shared files are.
    pub fn place(&self) -> &RuntimeDir {
        self.team.place()
    }
}

/// An episode driver as the observer that it is.
struct Driven<'a>(&'a mut dyn EpisodeDriver);

impl Observer<ProcessTeam, RunHorizons> for Driven<'_> {
    type Error = RecordError;

    fn tick(&mut self, seen: &RunTick<'_>) -> Result<Verdict, RecordError> {
        self.0.tick(seen)
    }
}
