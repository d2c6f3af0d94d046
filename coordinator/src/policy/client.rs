//! A policy server for teams in this process: comparisons and evaluations ask the very program that
//! serves a team of processes, so that their answers are the product's.
//!
//! Other than in a run, a missing answer is never bridged: results must not depend on who was in time.

use super::found::FoundPolicy;
use super::server::{ServerError, ServerProcess, server_program};
use crate::own_runtime_dir::OwnRuntimeDir;
use policy::settings::{PolicySettings, SettingsError};
use shared::chaos::Chaos;
use shared::exchange::Kind;
use shared::messages::{MAX_ROBOTS, Observation, PolicyAnswer, answer};
use shared::os;
use shared::runtime_dir::{RuntimeDir, RuntimeDirError};
use shared::services::{PolicyAsker, ServiceError};
use shared::stop::StopFlag;
use shared::team::{Episodes, FIRST_EPOCH, PARAMS_FILE, SCENARIO_FILE, TeamError, TeamFile, VERSION};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use vodca::Position;
use vodca::horizon::Horizon;
use vodca::horizon_source::Horizons;
use vodca::params::Params;
use vodca::scenario::{Scenario, ScenarioError};

/// How often a waiting client looks whether the server lives.
const LOOK_AROUND: Duration = Duration::from_millis(20);
/// How long a server may take to load a model, and to answer: it hangs then.
const PATIENCE: Duration = Duration::from_secs(30);
/// The same once somebody has asked to stop.
const SHORT_PATIENCE: Duration = Duration::from_millis(500);
/// A model must not change under way; what the server sees anyway is answered with an error.
const POLL_MS: u64 = 10_000;

/// Why a policy gives no horizons.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// The place of the exchange.
    #[error(transparent)]
    RuntimeDir(#[from] RuntimeDirError),
    /// The exchange.
    #[error(transparent)]
    Exchange(#[from] ServiceError),
    /// The server's program is not there, or the system refused it.
    #[error(transparent)]
    Server(#[from] ServerError),
    /// The server ended or hung before it served, most often because the model may not act.
    #[error("policy {name} is not served: {said}; `./run.sh policy check {}` says more", file.display())]
    NotServed {
        /// The policy as given.
        name: String,
        /// The server's last words.
        said: String,
        /// The model.
        file: PathBuf,
    },
    /// What the server is told.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// What the server is told of the team.
    #[error(transparent)]
    Team(#[from] TeamError),
    /// A scenario that has no form as a file.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A file for the server.
    #[error("cannot write {} for the policy server: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Another number of robots.
    #[error("policy {name} is for {has} robots and {scenario} has {robots}; a policy fits one number of robots")]
    Robots {
        /// The policy as given.
        name: String,
        /// Robots of the policy.
        has: usize,
        /// Name of the scenario.
        scenario: String,
        /// Robots of the scenario.
        robots: usize,
    },
    /// The server ended, hung, or its model failed.
    #[error("policy {name} gave no horizons for tick {tick}: {reason}")]
    NoAnswer {
        /// The policy as given.
        name: String,
        /// k.
        tick: u64,
        /// What is known of it.
        reason: String,
    },
    /// Somebody published another version meanwhile.
    #[error("the file of policy {name} was changed while it was in use; start again with one that stays as it is")]
    Changed {
        /// The policy as given.
        name: String,
    },
}

/// A policy server of our own and the exchange with it. Ends both when dropped.
pub struct PolicyClient {
    // Dropped in this order: the process, the ports, the files.
    process: ServerProcess,
    asker: PolicyAsker,
    place: OwnRuntimeDir,
    policy: FoundPolicy,
    sha256: Option<[u8; 32]>,
    stop: StopFlag,
    horizons: Vec<Horizon>,
}

impl PolicyClient {
    /// Starts a server for `policy` and teams of the size of `scenario`'s, and waits until it serves.
    /// `stop` makes every wait short.
    ///
    /// # Errors
    /// Another number of robots, a model that may not act, or anything that the system refuses.
    pub fn start(
        policy: &FoundPolicy,
        scenario: &Scenario,
        params: &Params,
        stop: &StopFlag,
    ) -> Result<Self, ClientError> {
        policy.must_fit(scenario)?;
        let robots = scenario.robots.len();
        let program = server_program()?;
        os::raise_file_limit();
        let place = OwnRuntimeDir(RuntimeDir::create()?);
        let run = Path::new(&place.0.root).join("run");
        tell(&run, policy, scenario, params, &place.0)?;
        let asker = PolicyAsker::create(&place.0)?;
        let process = ServerProcess::start(&program, &run)?;
        let (policy, stop) = (policy.clone(), stop.clone());
        let mut client =
            Self { process, asker, place, policy, sha256: None, stop, horizons: Vec::with_capacity(robots) };
        client.gather()?;
        Ok(client)
    }

    /// The model that is asked.
    pub fn policy(&self) -> &FoundPolicy {
        &self.policy
    }

    fn gather(&mut self) -> Result<(), ClientError> {
        let begun = Instant::now();
        loop {
            while let Some(answer) = self.asker.receive()? {
                if answer.kind == answer::HELLO {
                    return Ok(());
                }
            }
            if let Err(error) = self.process.must_live(self.deadline(begun)) {
                let (name, file) = (self.policy.name.clone(), self.policy.model.clone());
                // Its log goes with this client: what it said must be in the message.
                let said = self.process.last_line().unwrap_or_else(|| error.to_string());
                return Err(ClientError::NotServed { name, said, file });
            }
            self.asker.wait(LOOK_AROUND)?;
        }
    }

    fn deadline(&self, begun: Instant) -> Instant {
        begun + if self.stop.is_set() { SHORT_PATIENCE } else { PATIENCE }
    }

    /// The policy as the source of a run's horizons, moved by `params.horizon.jitter` with draws of `seed`, as in a run
    /// of processes.
    pub fn horizons(&mut self, params: &Params, seed: u64) -> ClientHorizons<'_> {
        ClientHorizons { client: self, jitter: params.horizon.jitter, seed }
    }

    /// The policy's horizons (its mean, no jitter) for robots that are measured at `positions` (m), by robot.
    ///
    /// # Errors
    /// No answer for this very question, or one of another model than before.
    fn answer(&mut self, tick: u64, positions: &[Position]) -> Result<&[Horizon], ClientError> {
        let robots = self.policy.robots;
        let mut question = Observation {
            epoch: FIRST_EPOCH,
            tick,
            stamp: os::now_ns(),
            robots: robots as u64,
            positions: [[0.0; 2]; MAX_ROBOTS],
        };
        for (to, position) in question.positions.iter_mut().zip(positions) {
            *to = (*position).into();
        }
        self.asker.ask(question)?;
        let answer = self.await_answer(tick, question.stamp)?;
        if *self.sha256.get_or_insert(answer.sha256) != answer.sha256 {
            return Err(ClientError::Changed { name: self.policy.name.clone() });
        }
        self.horizons.clear();
        self.horizons.extend(answer.horizons(robots).into_iter().flatten());
        match self.horizons.len() == robots {
            true => Ok(&self.horizons),
            false => Err(self.no_answer(
                tick,
                "it is not a horizon in 1..=49 for every robot; is the policy server of another version?",
            )),
        }
    }

    fn await_answer(&mut self, tick: u64, stamp: u64) -> Result<PolicyAnswer, ClientError> {
        let begun = Instant::now();
        loop {
            // An answer belongs to the question that it names, whatever was asked before.
            while let Some(answer) = self.asker.receive()? {
                match answer.kind {
                    answer::HORIZONS if answer.asked == stamp => return Ok(answer),
                    answer::NONE if answer.asked == stamp => {
                        return Err(self.no_answer(tick, "its answer was not finite"));
                    }
                    _ => {}
                }
            }
            if self.process.has_ended() {
                return Err(self.no_answer(tick, "its server ended"));
            }
            if Instant::now() > self.deadline(begun) {
                return Err(self.no_answer(tick, "its server hangs"));
            }
            self.asker.wait(LOOK_AROUND)?;
        }
    }

    fn no_answer(&self, tick: u64, what: &str) -> ClientError {
        let said = self.process.last_line().map_or(String::new(), |line| format!(" (its last words: {line})"));
        ClientError::NoAnswer { name: self.policy.name.clone(), tick, reason: format!("{what}{said}") }
    }

    /// Where its shared files are.
    pub fn place(&self) -> &RuntimeDir {
        &self.place.0
    }
}

/// See [`PolicyClient::horizons`].
pub struct ClientHorizons<'a> {
    client: &'a mut PolicyClient,
    jitter: u64,
    seed: u64,
}

impl Horizons for ClientHorizons<'_> {
    type Error = ClientError;

    fn choose(&mut self, tick: u64, measured: &[Position], out: &mut [Horizon]) -> Result<(), ClientError> {
        let chosen = self.client.answer(tick, measured)?.iter().enumerate();
        for (to, (robot, horizon)) in out.iter_mut().zip(chosen) {
            *to = horizon.jittered(self.jitter, self.seed, robot, tick);
        }
        Ok(())
    }
}

impl FoundPolicy {
    /// An error when `scenario` has another number of robots.
    pub fn must_fit(&self, scenario: &Scenario) -> Result<(), ClientError> {
        let (has, robots) = (self.robots, scenario.robots.len());
        let (name, scenario) = (self.name.clone(), scenario.name.clone());
        if has == robots { Ok(()) } else { Err(ClientError::Robots { name, has, scenario, robots }) }
    }
}

/// Writes what the server reads of a run into the folder `run`.
fn tell(
    run: &Path,
    policy: &FoundPolicy,
    scenario: &Scenario,
    params: &Params,
    place: &RuntimeDir,
) -> Result<(), ClientError> {
    let write = |name: &str, text: &str| {
        let path = run.join(name);
        std::fs::write(&path, text).map_err(|source| ClientError::File { path, source })
    };
    std::fs::create_dir(run).map_err(|source| ClientError::File { path: run.to_owned(), source })?;
    write(SCENARIO_FILE, &scenario.to_toml()?)?;
    write(PARAMS_FILE, &params.to_toml())?;
    let team = TeamFile {
        version: VERSION,
        robots: scenario.robots.len(),
        exchange: Kind::Peer,
        seed: scenario.seed,
        episodes: Episodes::default(),
        start_patience: PATIENCE.as_secs_f64(),
        silence_limit: PATIENCE.as_secs_f64(),
        chaos: Chaos::default(),
        place: place.clone(),
    };
    team.write(run)?;
    let settings = PolicySettings {
        version: 1,
        policy: policy.model.clone(),
        shadow: None,
        sample_seed: None,
        onnxruntime: None,
        poll_ms: POLL_MS,
    };
    Ok(settings.write(run)?)
}
