//! Who chooses the horizons of a run of processes: a table, or a policy server.

use crate::policy::{Acting, PolicyError, PolicyOptions, PolicySource, PolicySummary};
use crate::run::RunError;
use crate::team::ProcessTeam;
use shared::stop::StopFlag;
use std::path::Path;
use std::time::Instant;
use vodca::Position;
use vodca::horizon::Horizon;
use vodca::horizon_source::{HorizonSource, HorizonSourceError, HorizonSpec, Horizons};
use vodca::play::Playable;

/// Chooses the horizons of every robot at every tick; they travel with the announcement of the tick.
pub struct RunHorizons {
    source: Source,
    robots: usize,
    seed: u64,
    /// `horizon.jitter`: how far every horizon but a script's is moved, steps.
    jitter: u64,
}

enum Source {
    Table { spec: HorizonSpec, table: HorizonSource },
    Policy { source: Box<PolicySource>, stop: StopFlag },
    Ended,
}

impl RunHorizons {
    /// Those of a table; see [`HorizonSource`].
    pub(crate) fn table(spec: &HorizonSpec, robots: usize, seed: u64, jitter: u64) -> Result<Self, HorizonSourceError> {
        let table = HorizonSource::new(spec, robots, seed, jitter)?;
        Ok(Self { source: Source::Table { spec: spec.clone(), table }, robots, seed, jitter })
    }

    /// Those of a policy, whose server is started.
    pub(crate) fn policy(
        options: PolicyOptions,
        team: &ProcessTeam,
        run: &Path,
        jitter: u64,
        stop: &StopFlag,
    ) -> Result<Self, PolicyError> {
        let (robots, seed) = (team.measured().len(), team.seed());
        let source = Box::new(PolicySource::start(options, team.place(), run, robots)?);
        Ok(Self { source: Source::Policy { source, stop: stop.clone() }, robots, seed, jitter })
    }

    /// Waits until a policy's server has loaded it; `false`: somebody asked to stop.
    pub(crate) fn gather(&mut self, until: Instant) -> Result<bool, PolicyError> {
        match &mut self.source {
            Source::Policy { source, stop } => source.gather(until, stop),
            _ => Ok(true),
        }
    }

    /// The next ticks belong to the episode with `epoch` and `seed`.
    pub(crate) fn begin(&mut self, epoch: u64, seed: u64) -> Result<(), HorizonSourceError> {
        self.seed = seed;
        match &mut self.source {
            Source::Table { spec, table } => *table = HorizonSource::new(spec, self.robots, seed, self.jitter)?,
            Source::Policy { source, .. } => source.next_episode(epoch),
            Source::Ended => {}
        }
        Ok(())
    }

    /// Waits until the policy with the SHA-256 `wanted` acts; `false`: somebody asked to stop.
    pub(crate) fn await_version(&mut self, wanted: &[u8; 32], measured: &[Position]) -> Result<bool, PolicyError> {
        match &mut self.source {
            Source::Policy { source, stop } => source.await_version(wanted, measured, stop),
            _ => Ok(true),
        }
    }

    /// Who chose the horizons of the newest tick, in a run with a policy.
    pub fn acting(&self) -> Option<Acting> {
        match &self.source {
            Source::Policy { source, .. } => source.acting(),
            _ => None,
        }
    }

    /// Ends the policy server, if there is one, and says what the policy did.
    pub(crate) fn end(&mut self) -> Result<Option<PolicySummary>, PolicyError> {
        match std::mem::replace(&mut self.source, Source::Ended) {
            Source::Policy { source, .. } => source.end().map(Some),
            _ => Ok(None),
        }
    }
}

impl Horizons for RunHorizons {
    type Error = RunError;

    fn choose(&mut self, tick: u64, measured: &[Position], out: &mut [Horizon]) -> Result<(), RunError> {
        match &mut self.source {
            Source::Table { table, .. } => match table.choose(tick, measured, out) {
                Ok(()) => {}
                Err(never) => match never {},
            },
            Source::Policy { source, stop } => {
                let chosen = source.choose(tick, measured, stop)?.iter().enumerate();
                for (to, (robot, horizon)) in out.iter_mut().zip(chosen) {
                    *to = horizon.jittered(self.jitter, self.seed, robot, tick);
                }
            }
            Source::Ended => {}
        }
        Ok(())
    }

    fn actions(&self) -> &[f32] {
        match &self.source {
            Source::Policy { source, .. } => source.actions(),
            _ => &[],
        }
    }
}
