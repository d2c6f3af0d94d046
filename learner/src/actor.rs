//! The actor: two hidden layers of ReLU and two heads, mean and log sigma of each robot's raw action.

use crate::network::{Network, Pass};
use crate::settings::Settings;
use crate::squashed::LogStdBounds;

/// pi_theta: observation `[2N]` to mean and log sigma, `[N]` each. Both heads are one layer of 2N
/// outputs, means first: one product instead of two.
#[derive(Clone, Debug, PartialEq)]
pub struct Actor {
    network: Network,
    bounds: LogStdBounds,
}

impl Actor {
    /// An actor with first weights from `seed`.
    pub fn new(observations: usize, actions: usize, settings: &Settings, seed: u64) -> Self {
        let network = Network::new(&widths(observations, actions, settings), seed, 0);
        Self { network, bounds: bounds(settings) }
    }

    /// An actor with these parameters; `None` when their number is wrong.
    pub fn from_parameters(
        observations: usize,
        actions: usize,
        settings: &Settings,
        parameters: Vec<f32>,
    ) -> Option<Self> {
        let network = Network::from_parameters(&widths(observations, actions, settings), parameters)?;
        Some(Self { network, bounds: bounds(settings) })
    }

    /// Its network; the output is N means, then N log sigmas not yet clipped.
    pub fn network(&self) -> &Network {
        &self.network
    }

    /// The same to change.
    pub fn network_mut(&mut self) -> &mut Network {
        &mut self.network
    }

    /// Bounds of log sigma.
    pub fn bounds(&self) -> LogStdBounds {
        self.bounds
    }

    /// Number of observation values.
    pub fn observations(&self) -> usize {
        self.network.inputs()
    }

    /// Number of robots, N.
    pub fn actions(&self) -> usize {
        self.network.outputs() / 2
    }

    /// Mean and clipped log sigma, `[N]` each, for one observation as the network takes it (scaled).
    pub fn answer(&self, observation: &[f32]) -> (Vec<f32>, Vec<f32>) {
        let mut pass = Pass::new(&self.network, 1);
        pass.input_mut().copy_from_slice(observation);
        self.network.forward(&mut pass);
        let (mean, log_std) = pass.output().split_at(self.actions());
        (mean.to_vec(), log_std.iter().map(|log_std| self.bounds.clip(*log_std)).collect())
    }
}

fn widths(observations: usize, actions: usize, settings: &Settings) -> [usize; 4] {
    [observations, settings.hidden, settings.hidden, 2 * actions]
}

fn bounds(settings: &Settings) -> LogStdBounds {
    LogStdBounds { low: settings.log_std_min, high: settings.log_std_max }
}
