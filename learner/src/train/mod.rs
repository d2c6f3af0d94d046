//! Training: the whole loop from rollouts by real robot processes to a better actor in the policy server.
//!
//! A round: a session of robot processes plays episodes with the newest actor while the learner updates
//! on what was played before; then the round's transitions are remembered, the new actor is published,
//! and the sessions' policy servers swap it in. Which actor played what depends on the plan alone, not
//! on who was quicker, so a training can be repeated and resumed exactly.

pub mod command;
pub mod config;
pub mod curve;
pub mod score;
pub mod session;
pub mod state;

use crate::Learner;
use crate::export::{ExportError, export};
use crate::rollouts::{RolloutsError, remember_shard};
use config::TrainingConfig;
use curve::{Curve, CurveError, Point};
use policy::contract::{Contract, Observation};
use policy::digest::sha256_of;
use policy::folder::{FolderError, PolicyFolder, resolve};
use policy::rollout::{RolloutError, Shard};
use policy::session::{RoundOrder, RoundReport};
use score::Score;
use session::{Session, SessionError};
use shared::stop::StopFlag;
use state::{Best, Lock, State, StateError};
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use vodca::scenario::{Scenario, SetupError, set_up};

/// Versions of the actor that are kept beside the best one.
const VERSIONS: usize = 3;
/// Layouts of a family that are looked at for the bounds of its coordinates.
const LOOKED_AT: u64 = 50;
/// States whose answers an actor is checked against before it serves.
const REFERENCE_STATES: usize = 16;

/// Why training cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum TrainError {
    /// The scenario or the parameters.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A session of robots.
    #[error(transparent)]
    Session(#[from] SessionError),
    /// What it recorded.
    #[error(transparent)]
    Shard(#[from] RolloutError),
    /// Rollouts that do not fit the training.
    #[error(transparent)]
    Rollouts(#[from] RolloutsError),
    /// The actor.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// The policies folder.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The state of the training.
    #[error(transparent)]
    State(#[from] StateError),
    /// The curves.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The profile's name.
    #[error(transparent)]
    Profile(#[from] vodca::params::UnknownProfile),
}

/// How much is trained.
#[derive(Clone, Copy, Debug, Default)]
pub struct Budget {
    /// Most training episodes.
    pub episodes: Option<u64>,
    /// Most updates.
    pub updates: Option<u64>,
    /// Most wall time of this call.
    pub time: Option<Duration>,
}

/// What a watcher is told after every round.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Rounds, episodes, ticks so far.
    pub state: &'a State,
    /// Updates so far.
    pub updates: u64,
    /// This round.
    pub point: &'a Point,
}

/// A training under way.
pub struct Trainer {
    plan: TrainingConfig,
    out: PathBuf,
    learner: Learner,
    contract: Contract,
    folder: PolicyFolder,
    /// SHA-256 of the newest published actor.
    published: [u8; 32],
    state: State,
    rollouts: Session,
    evaluation: Session,
    curve: Curve,
    /// Positions the actor was seen at, for its reference set.
    reference: Vec<Vec<f64>>,
    /// Nobody else trains in `out` meanwhile.
    _lock: Lock,
}

impl Trainer {
    /// Begins a training in the folder `out`, which must be new or empty: plays the warm-up, starts
    /// the sessions and leaves the first checkpoint. `None`: somebody asked to stop before.
    pub fn begin(plan: TrainingConfig, out: &Path, stop: &StopFlag) -> Result<Option<Self>, TrainError> {
        let scenario = layouts(&plan)?; // first: a plan that cannot be used leaves no folder
        let lock = state::prepare(out, &plan)?;
        let robots = scenario[0].robots.len();
        let learner = Learner::new(2 * robots, robots, plan.settings.clone(), plan.seed);
        let mut trainer = Self::start(plan, out, learner, State::default(), &scenario, lock)?;
        let arguments = [trainer.rollout_arguments(0), ["--horizon".into(), "random".into()].into()].concat();
        let mut warm_up = Session::start(&arguments, &out.join("warm-up"))?;
        warm_up.order(&order(0, trainer.plan.warm_up_episodes, None))?;
        let Some(round) = warm_up.answer(stop)? else { return Ok(None) };
        trainer.take(&round)?;
        trainer.checkpoint()?; // whatever ends the first rounds, the warm-up need not be played again
        Ok(Some(trainer))
    }

    /// Goes on where the newest checkpoint in `out` stands.
    pub fn resume(out: &Path) -> Result<Self, TrainError> {
        let lock = Lock::take(out)?;
        let (plan, learner, state) = state::load(out)?;
        let scenario = layouts(&plan)?;
        Self::start(plan, out, learner, state, &scenario, lock)
    }

    fn start(
        plan: TrainingConfig,
        out: &Path,
        learner: Learner,
        state: State,
        layouts: &[Scenario],
        lock: Lock,
    ) -> Result<Self, TrainError> {
        let contract = contract(&plan, layouts);
        let folder = PolicyFolder::new(out.join("policy"));
        let reference = state.reference.clone();
        export(learner.actor(), &contract, &reference, &folder)?;
        let published = digest_of(&folder)?;
        let sessions = out.join("sessions");
        let run = state::number_of_sessions(&sessions);
        let policy = ["--policy".to_owned(), folder.root().display().to_string(), "--policy-poll".into(), "10".into()];
        // Episodes of the rollouts go on; the warm-up's had a seed of their own.
        let mut arguments = rollout_arguments(&plan, 1);
        arguments.extend(policy.clone());
        arguments.extend(["--stochastic".into(), "--first".into(), state.episodes.to_string()]);
        let rollouts = Session::start(&arguments, &sessions.join(format!("{run:03}-rollouts")))?;
        let mut arguments = plan.session_arguments();
        arguments.extend(policy);
        arguments.extend(["--discard".into(), "--after-arrival".into(), "0".into()]);
        arguments.extend(["--cycle".into(), plan.evaluation_episodes.to_string()]);
        arguments.extend(["--start-jitter".into(), plan.evaluation_jitter.to_string()]);
        arguments.extend(["--seed".into(), vodca::random::episode_seed(plan.seed, 3).to_string()]);
        let evaluation = Session::start(&arguments, &sessions.join(format!("{run:03}-evaluation")))?;
        let curve = Curve::open(out, state.round)?;
        Ok(Self {
            plan,
            out: out.to_owned(),
            learner,
            contract,
            folder,
            published,
            state,
            rollouts,
            evaluation,
            curve,
            reference,
            _lock: lock,
        })
    }

    fn rollout_arguments(&self, stream: u64) -> Vec<String> {
        rollout_arguments(&self.plan, stream)
    }

    /// Trains until the budget is spent or somebody asks to stop, and leaves a checkpoint. `watch` is told of
    /// every round.
    pub fn train(
        &mut self,
        budget: &Budget,
        stop: &StopFlag,
        watch: &mut dyn FnMut(&Progress<'_>),
    ) -> Result<(), TrainError> {
        let start = Instant::now();
        let spent = |trainer: &Self| {
            budget.episodes.is_some_and(|most| trainer.state.episodes >= most)
                || budget.updates.is_some_and(|most| trainer.learner.updates() >= most)
                || budget.time.is_some_and(|most| start.elapsed() >= most)
        };
        while !spent(self) && !stop.is_set() {
            let point = self.round()?;
            self.curve.add(&point)?;
            watch(&Progress { state: &self.state, updates: self.learner.updates(), point: &point });
            if self.state.round.is_multiple_of(self.plan.checkpoint_every) {
                self.checkpoint()?;
            }
        }
        self.checkpoint()
    }

    /// One round, to its end: only there can a training be resumed exactly.
    fn round(&mut self) -> Result<Point, TrainError> {
        let start = Instant::now();
        let number = self.state.round;
        self.rollouts.order(&order(number, self.plan.round_episodes, Some(self.published)))?;
        let owed = (self.state.ticks_of_last_round as f64 * self.plan.updates_per_tick + self.state.owed).max(0.0);
        let updates = owed.floor() as u64;
        self.state.owed = owed - updates as f64;
        let mut losses = None;
        for _ in 0..updates {
            losses = Some(self.learner.update());
        }
        let learnt = start.elapsed();
        // A round is finished even when a stop was asked for: rounds are short.
        let round = self.rollouts.whole_answer()?;
        self.take(&round)?;
        self.state.episodes += self.plan.round_episodes;
        self.state.round += 1;
        self.publish()?;
        let evaluation = match self.state.round.is_multiple_of(self.plan.evaluate_every) {
            true => Some(self.evaluate()?),
            false => None,
        };
        Ok(Point::new(
            number,
            &self.state,
            self.learner.updates(),
            (updates, learnt),
            &round,
            losses,
            evaluation,
            start.elapsed(),
        ))
    }

    /// Remembers what was played, and removes its shard.
    fn take(&mut self, round: &RoundReport) -> Result<(), TrainError> {
        self.state.ticks_of_last_round = round.ticks();
        self.state.ticks += round.ticks();
        let Some(path) = &round.shard else { return Ok(()) };
        let shard = Shard::read(path)?;
        remember_shard(&mut self.learner, &self.contract, &self.plan.reward, path, &shard)?;
        let every = (shard.rows() / REFERENCE_STATES).max(1);
        self.reference = (0..shard.rows())
            .step_by(every)
            .map(|row| shard.row(row).observation.iter().map(|metres| f64::from(*metres)).collect())
            .collect();
        let _ = std::fs::remove_file(path); // a file left behind harms nothing
        Ok(())
    }

    /// Hands the actor to the policy servers.
    fn publish(&mut self) -> Result<(), TrainError> {
        export(self.learner.actor(), &self.contract, &self.reference, &self.folder)?;
        self.published = digest_of(&self.folder)?;
        self.folder.prune(VERSIONS)?;
        for session in [&self.rollouts, &self.evaluation] {
            PolicyFolder::new(session.policy_folder()).prune(VERSIONS)?;
        }
        Ok(())
    }

    /// Plays the evaluation with the newest actor; keeps it when it is the best so far.
    fn evaluate(&mut self) -> Result<Score, TrainError> {
        self.evaluation.order(&order(self.state.round, self.plan.evaluation_episodes, Some(self.published)))?;
        let round = self.evaluation.whole_answer()?;
        let score = Score::of(&round.episodes);
        let better = self.state.best.as_ref().is_none_or(|best| score.beats(&best.score, self.plan.most_ticks));
        if better {
            let best = PolicyFolder::new(self.out.join("best"));
            export(self.learner.actor(), &self.contract, &self.reference, &best)?;
            best.prune(1)?;
            self.state.best = Some(Best { score, round: self.state.round, updates: self.learner.updates() });
        }
        Ok(score)
    }

    fn checkpoint(&mut self) -> Result<(), TrainError> {
        self.state.reference.clone_from(&self.reference);
        Ok(state::save(&self.out, &self.learner, &self.state)?)
    }

    /// How far it has come.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The learner.
    pub fn learner(&self) -> &Learner {
        &self.learner
    }
}

fn rollout_arguments(plan: &TrainingConfig, stream: u64) -> Vec<String> {
    let mut arguments = plan.session_arguments();
    arguments.extend(["--start-jitter".into(), plan.start_jitter.to_string()]);
    arguments.extend(["--seed".into(), vodca::random::episode_seed(plan.seed, 1 + stream).to_string()]);
    if plan.after_arrival >= 0 {
        arguments.extend(["--after-arrival".into(), plan.after_arrival.to_string()]);
    }
    arguments
}

/// The layout, or some of the family's.
fn layouts(plan: &TrainingConfig) -> Result<Vec<Scenario>, TrainError> {
    let profile = plan.profile.parse()?;
    let one = |spec: &str| Ok::<_, TrainError>(set_up(Some(spec), None, profile, &plan.set)?.0);
    match plan.scenario.strip_suffix(":any") {
        Some(family) => (0..LOOKED_AT).map(|seed| one(&format!("{family}:{seed}"))).collect(),
        None => Ok(vec![one(&plan.scenario)?]),
    }
}

/// Positions scaled to [-1, 1] over everything that stands in the layouts.
fn contract(plan: &TrainingConfig, layouts: &[Scenario]) -> Contract {
    let mut contract = Contract::standard(layouts[0].robots.len(), true);
    contract.observation = Observation::over_layouts(layouts);
    contract.name = Some(plan.scenario.clone());
    contract.producer = Some(format!("vodca learner {}", env!("CARGO_PKG_VERSION")));
    contract.trained_from = Some(format!("{} {} seed {}", plan.scenario, plan.profile, plan.seed));
    contract
}

/// Of no episodes there is no order; a plan allows none.
fn order(round: u64, episodes: u64, policy: Option<[u8; 32]>) -> RoundOrder {
    RoundOrder { round, episodes: NonZeroU64::new(episodes).unwrap_or(NonZeroU64::MIN), policy }
}

fn digest_of(folder: &PolicyFolder) -> Result<[u8; 32], TrainError> {
    let path = resolve(folder.root())?;
    let bytes = std::fs::read(&path).map_err(|source| FolderError::Io {
        action: "read",
        path: path.display().to_string(),
        source,
    })?;
    Ok(sha256_of(&bytes))
}
