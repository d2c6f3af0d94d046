//! Horizons from a policy server: asks it before every tick, waits within bounds, and bridges its
//! absence. A run never ends because of it.

pub mod client;
mod fallback;
pub mod found;
mod record;
mod server;
mod summary;

pub use self::server::{ServerError, server_program};
pub use self::summary::{PolicySummary, ShadowSummary, VersionSummary};

use self::fallback::Bridge;
use self::record::PolicyRecord;
use self::server::ServerProcess;
use self::summary::Tally;
use crate::record::RecordError;
use policy::encoding::hex;
use policy::settings::{PolicySettings, SettingsError};
use shared::messages::{MAX_ROBOTS, Observation, PolicyAnswer, answer};
use shared::os;
use shared::runtime_dir::RuntimeDir;
use shared::services::{PolicyAsker, ServiceError};
use shared::stop::StopFlag;
use shared::team::FIRST_EPOCH;
use std::fmt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use vodca::Position;
use vodca::horizon::Horizon;

/// How often a waiting coordinator looks whether the server lives.
const LOOK_AROUND: Duration = Duration::from_millis(20);
/// How long a policy that must act may take to do so.
const SWAP_PATIENCE: Duration = Duration::from_secs(20);
/// How often it is asked for.
const SWAP_LOOK: Duration = Duration::from_millis(2);

/// How a run uses a policy.
#[derive(Clone, Debug)]
pub struct PolicyOptions {
    /// The server's program.
    pub program: PathBuf,
    /// What goes into `policy.toml`.
    pub settings: PolicySettings,
    /// Write down which version acted at every tick.
    pub record: bool,
    /// How long a tick waits for its answer.
    pub wait: Duration,
    /// Ticks in a row for which robots keep their last horizon when none comes.
    pub hold: u64,
    /// The horizon after that.
    pub default: Horizon,
}

/// Why a run with a policy cannot start, or its record cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum PolicyError {
    /// The server does not start.
    #[error(transparent)]
    Server(#[from] ServerError),
    /// `policy.toml`.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The exchange.
    #[error(transparent)]
    Exchange(#[from] ServiceError),
    /// The policy that must act does not.
    #[error(
        "the policy with SHA-256 {wanted} did not take over within {} s; `STATUS.json` and the policy server's log in \
         the run's folder say why", patience.as_secs()
    )]
    NotSwapped {
        /// Which one.
        wanted: String,
        /// How long it was waited for.
        patience: Duration,
    },
    /// `policy.csv` or `shadow.csv`.
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// Where the horizons of a tick came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The policy, for this very tick.
    Policy,
    /// The newest answer, kept.
    Held,
    /// The configured default.
    Default,
}

/// Who chose the horizons of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acting {
    /// Whether it was the policy.
    pub source: Source,
    /// Its version in the run's folder; 0 unless it was the policy.
    pub version: u32,
    /// SHA-256 of its file; zeros unless it was the policy.
    pub sha256: [u8; 32],
}

impl fmt::Display for Acting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.source {
            Source::Policy => write!(f, "v{:06} (sha256 {})", self.version, hex(&self.sha256[..6])),
            Source::Held => f.write_str("no answer, horizons held"),
            Source::Default => f.write_str("no answer, default horizon"),
        }
    }
}

/// The policy server of a run, as the coordinator sees it.
pub struct PolicySource {
    // Dropped in this order: the process before the ports.
    process: ServerProcess,
    asker: PolicyAsker,
    options: PolicyOptions,
    robots: usize,
    epoch: u64,
    /// Whether waiting makes sense. A server that missed a tick is not waited for until it answers again.
    present: bool,
    /// Whether a server started by hand has taken the place of ours.
    successor: bool,
    bridge: Bridge,
    record: Option<PolicyRecord>,
    tally: Tally,
    /// Of the newest tick; empty when the policy did not choose its horizons.
    actions: Vec<f32>,
    acting: Option<Acting>,
}

impl PolicySource {
    /// Makes the services, writes `policy.toml` and starts the server. `team.toml` must be there.
    pub fn start(options: PolicyOptions, place: &RuntimeDir, run: &Path, robots: usize) -> Result<Self, PolicyError> {
        let asker = PolicyAsker::create(place)?;
        options.settings.write(run)?;
        Ok(Self {
            process: ServerProcess::start(&options.program, run)?,
            asker,
            robots,
            epoch: FIRST_EPOCH,
            present: false,
            successor: false,
            bridge: Bridge::new(robots, options.hold, options.default),
            record: match options.record {
                true => Some(PolicyRecord::create(run, robots, options.settings.shadow.is_some())?),
                false => None,
            },
            tally: Tally::new(options.settings.policy.clone(), options.settings.shadow.clone()),
            actions: Vec::with_capacity(robots),
            acting: None,
            options,
        })
    }

    /// Waits until the server has loaded the policy. A policy that cannot act at the start ends the run
    /// before it begins. `false`: somebody asked to stop.
    pub fn gather(&mut self, deadline: Instant, stop: &StopFlag) -> Result<bool, PolicyError> {
        loop {
            while self.asker.receive()?.is_some() {
                self.present = true;
            }
            if self.present {
                return Ok(true);
            }
            if stop.is_set() {
                return Ok(false);
            }
            self.process.must_live(deadline)?;
            self.asker.wait(LOOK_AROUND)?;
        }
    }

    /// The horizons of `tick`, by robot, for robots measured at `positions`.
    pub fn choose(&mut self, tick: u64, positions: &[Position], stop: &StopFlag) -> Result<&[Horizon], PolicyError> {
        let question = self.question(tick, positions);
        // What fails between the two processes is a missing answer and not the end of the run.
        let answer = match self.asker.ask(question) {
            Ok(()) => self.await_answer(tick, stop)?,
            Err(error) => {
                tracing::warn!("tick {tick}: {error}");
                None
            }
        };
        let horizons = answer.as_ref().and_then(|answer| answer.horizons(self.robots));
        if let (Some(answer), Some(_)) = (&answer, &horizons) {
            self.tally.answered(answer, os::now_ns());
        }
        self.actions.clear();
        if let (Some(answer), Some(_)) = (&answer, &horizons) {
            self.actions.extend_from_slice(&answer.actions[..self.robots]);
        }
        let source = self.bridge.take(horizons);
        self.tally.tick(tick, source, answer.as_ref());
        let acted = answer.as_ref().filter(|_| source == Source::Policy);
        self.acting = Some(Acting {
            source,
            version: acted.map_or(0, |answer| answer.version),
            sha256: acted.map_or([0; 32], |answer| answer.sha256),
        });
        if let Some(record) = &mut self.record {
            record.tick(tick, source, answer.as_ref())?;
        }
        Ok(self.bridge.horizons())
    }

    /// What the policy chose for the newest tick, in [-1, 1], by robot; empty when it chose nothing.
    pub fn actions(&self) -> &[f32] {
        &self.actions
    }

    /// The next questions belong to the episode `epoch`.
    pub fn next_episode(&mut self, epoch: u64) {
        self.epoch = epoch;
        self.bridge = Bridge::new(self.robots, self.options.hold, self.options.default);
    }

    /// Waits until the policy with the SHA-256 `wanted` acts, by asking about `positions`; `false`:
    /// somebody asked to stop.
    pub fn await_version(
        &mut self,
        wanted: &[u8; 32],
        positions: &[Position],
        stop: &StopFlag,
    ) -> Result<bool, PolicyError> {
        let deadline = Instant::now() + SWAP_PATIENCE;
        while !stop.is_set() {
            self.asker.ask(self.question(0, positions))?;
            if let Some(answer) = self.await_answer(0, stop)?
                && answer.sha256 == *wanted
            {
                return Ok(true);
            }
            if Instant::now() > deadline {
                return Err(PolicyError::NotSwapped { wanted: hex(wanted), patience: SWAP_PATIENCE });
            }
            std::thread::sleep(SWAP_LOOK);
        }
        Ok(false)
    }

    /// The observation of robots measured at `positions`.
    fn question(&self, tick: u64, positions: &[Position]) -> Observation {
        let mut question = Observation {
            epoch: self.epoch,
            tick,
            stamp: 0,
            robots: self.robots as u64,
            positions: [[0.0; 2]; MAX_ROBOTS],
        };
        for (to, position) in question.positions.iter_mut().zip(positions) {
            *to = (*position).into();
        }
        question.stamp = os::now_ns();
        question
    }

    /// Who chose the horizons of the newest tick; `None` before the first.
    pub fn acting(&self) -> Option<Acting> {
        self.acting
    }

    /// The answer for `tick`; `None`: it did not come in time.
    fn await_answer(&mut self, tick: u64, stop: &StopFlag) -> Result<Option<PolicyAnswer>, PolicyError> {
        let deadline = Instant::now() + self.options.wait;
        loop {
            while let Some(answer) = self.asker.receive()? {
                self.present = true;
                if answer.epoch != self.epoch && answer.kind != answer::HELLO {
                    continue;
                }
                match answer.kind {
                    answer::SHADOW => self.shadow(&answer)?,
                    answer::HORIZONS | answer::NONE if answer.tick == tick => {
                        return Ok(Some(answer).filter(|answer| answer.kind == answer::HORIZONS));
                    }
                    answer::HORIZONS => self.tally.too_late(),
                    answer::HELLO => self.successor = self.process.has_ended(),
                    _ => {}
                }
            }
            let left = deadline.saturating_duration_since(Instant::now());
            let dead = !self.successor && self.process.has_ended();
            if !self.present || left.is_zero() || stop.is_set() || dead {
                if self.present && !stop.is_set() {
                    let again = match dead {
                        true => "; it has ended, `./run.sh policy serve --run RUN` starts another",
                        false => "",
                    };
                    tracing::warn!(
                        "the policy server gave no answer for tick {tick}; robots keep their horizons{again}"
                    );
                    self.present = false;
                }
                return Ok(None);
            }
            self.asker.wait(left.min(LOOK_AROUND))?;
        }
    }

    fn shadow(&mut self, answer: &PolicyAnswer) -> Result<(), PolicyError> {
        let Some(horizons) = answer.horizons(self.robots) else { return Ok(()) };
        self.tally.shadow(answer, &horizons, self.bridge.horizons());
        match &mut self.record {
            Some(record) => Ok(record.shadow(answer.tick, &horizons)?),
            None => Ok(()),
        }
    }

    /// Ends the server and says how it went.
    pub fn end(mut self) -> Result<PolicySummary, PolicyError> {
        // The shadow's answer for the last tick may still be there.
        while let Some(answer) = self.asker.receive()? {
            if answer.epoch == self.epoch && answer.kind == answer::SHADOW {
                self.shadow(&answer)?;
            }
        }
        self.process.end();
        if let Some(record) = self.record {
            record.finish()?;
        }
        Ok(self.tally.summary())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_acts_is_told_in_a_few_words() {
        let acting = |source| Acting { source, version: 17, sha256: [0xab; 32] };
        assert_eq!(acting(Source::Policy).to_string(), "v000017 (sha256 abababababab)");
        assert_eq!(acting(Source::Held).to_string(), "no answer, horizons held");
        assert_eq!(acting(Source::Default).to_string(), "no answer, default horizon");
    }
}
