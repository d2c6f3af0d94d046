//! Where a robot's horizon of a tick comes from.

use shared::team::{POLICY, Setup};
use vodca::horizon::Horizon;
use vodca::horizon_source::{HorizonSource, HorizonSourceError, HorizonSpec};

/// The source of one robot's horizons.
pub(crate) struct Horizons {
    source: HorizonSource,
    /// Whether horizons come with the announcements instead.
    policy: bool,
}

impl Horizons {
    /// The source that the run's folder names.
    pub(crate) fn new(setup: &Setup) -> Result<Self, HorizonSourceError> {
        let policy = setup.team.horizons == POLICY;
        // Of a policy's answers only the jitter is ours; any table will do.
        let spec = if policy { HorizonSpec::Random(None) } else { setup.team.horizons.parse()? };
        let source = HorizonSource::new(&spec, setup.team.robots, setup.team.seed, setup.params.horizon.jitter)?;
        Ok(Self { source, policy })
    }

    /// N_i^k; `announced` came with the announcement of this very tick and wins. `None`: it had to and did not.
    pub(crate) fn at(&self, announced: Option<Horizon>, robot: usize, tick: u64) -> Option<Horizon> {
        match announced {
            Some(horizon) => Some(self.source.jitter(horizon, robot, tick)),
            None if self.policy => None,
            None => Some(self.source.horizon(robot, tick)),
        }
    }
}
