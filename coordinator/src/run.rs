//! What a run of a team of processes is told, what it hands out and how it can end; [`crate::team`] runs it.

use crate::clock::Overruns;
use crate::launch::{self, Agents, LaunchError};
use crate::policy::{Acting, PolicyError, PolicyOptions, PolicySummary};
use crate::record::RecordError;
use crate::roster::PeerLost;
use shared::exchange::Kind;
use shared::messages::{MAX_ROBOTS, Stamps};
use shared::place::PlaceError;
use shared::services::ServiceError;
use shared::team::{Episodes, TeamError};
use std::path::{Path, PathBuf};
use std::time::Duration;
use vodca::Position;
use vodca::scenario::{Scenario, ScenarioError};
use vodca::step::Step;

/// The usual [`Options::tick_deadline`]: a robot that hangs ends the run within 2 s, ending included.
pub const TICK_DEADLINE: Duration = Duration::from_millis(1200);
/// How long no further robot may come during the start.
pub const STALL: Duration = Duration::from_secs(3);

/// What one run is told beyond its scenario and parameters.
#[derive(Clone, Debug)]
pub struct Options {
    /// The run's folder; `scenario.toml` and `params.toml` are in it already.
    pub run: PathBuf,
    /// How robots come to life.
    pub agents: Agents,
    /// The form of the exchange.
    pub exchange: Kind,
    /// SPEC of the horizons' source, or [`shared::team::POLICY`].
    pub horizons: String,
    /// The policy that chooses them; then `horizons` is [`shared::team::POLICY`].
    pub policy: Option<PolicyOptions>,
    /// Seed of everything random in the first episode.
    pub seed: u64,
    /// What differs between episodes.
    pub episodes: Episodes,
    /// One tick per sample time rather than as fast as possible.
    pub real_time: bool,
    /// K, the most ticks.
    pub max_ticks: u64,
    /// How long a tick may take before a robot that has not answered is lost.
    pub tick_deadline: Duration,
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
            horizons: "fixed:20".into(),
            policy: None,
            seed: scenario.seed,
            episodes: Episodes::default(),
            real_time: false,
            max_ticks: scenario.max_ticks,
            tick_deadline: TICK_DEADLINE,
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
    Place(#[from] PlaceError),
    /// A file in its folder.
    #[error(transparent)]
    Team(#[from] TeamError),
    /// The layout of an episode.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
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
    /// The observer had seen enough ([`Verdict::Over`]).
    Completed,
    /// All ticks were used up.
    TimedOut,
    /// Somebody asked for it.
    Stopped,
    /// A robot ended or fell silent.
    PeerLost(PeerLost),
}

/// What the observer of a tick wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The next tick.
    Continue,
    /// The end: everybody has arrived, or the episode is over for another reason.
    Over,
}

/// Sees every tick that everybody has finished and decides what comes next.
pub type Observer<'a> = dyn FnMut(&Tick<'_>) -> Result<Verdict, RecordError> + 'a;

/// Plays episode after episode with one team of processes.
pub trait Director {
    /// An episode begins. Gives the SHA-256 of the policy that must act in it, if that matters.
    fn begin(&mut self, episode: &Episode<'_>) -> Result<Option<[u8; 32]>, RecordError>;
    /// A tick that everybody has finished.
    fn tick(&mut self, tick: &Tick<'_>) -> Result<Verdict, RecordError>;
    /// The episode has come to its end; `true`: another one.
    fn another(&mut self, outcome: &Outcome) -> Result<bool, RecordError>;
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

/// One tick, finished.
#[derive(Debug)]
pub struct Tick<'a> {
    /// k.
    pub tick: u64,
    /// What every robot did, by robot number.
    pub steps: &'a [Step],
    /// Where every robot measured itself at the start of the tick, m.
    pub measured: &'a [Position],
    /// What the policy chose, in [-1, 1], by robot; empty when it chose nothing for this very tick.
    pub actions: &'a [f32],
    /// When what happened to every robot, by robot number.
    pub stamps: &'a [Stamps],
    /// When a policy was asked for the tick's horizons, ns of the monotonic clock; without a policy when
    /// the tick could have been announced.
    pub asked: u64,
    /// When the tick was announced, ns of the monotonic clock.
    pub announced: u64,
    /// When everybody had been woken, ns.
    pub rung: u64,
    /// When the last report had come, ns.
    pub collected: u64,
    /// How late it was announced (real time only), ns.
    pub late: u64,
    /// Who chose the horizons, in a run with a policy.
    pub acting: Option<Acting>,
}

/// How a run went.
#[derive(Clone, Debug, PartialEq)]
pub struct Ended {
    /// How it ended.
    pub outcome: Outcome,
    /// Ticks that were finished by everybody.
    pub ticks: u64,
    /// Ticks that began late (real time only).
    pub overruns: Overruns,
    /// What the policy did.
    pub policy: Option<PolicySummary>,
}
