//! Options that several commands share: the parameters, and how a team of processes is run.

use shared::exchange::Kind;
use vodca::params::Profile;

/// Which parameters: a profile, and changes to it.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct ParameterArgs {
    /// Parameter set: safe, paper, orca or orca-rh
    #[arg(long, value_name = "NAME", default_value = "safe")]
    pub(super) profile: Profile,
    /// Change a parameter (repeatable), e.g. vodca.rows=each; `params` lists them
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
}

/// How a team of processes runs.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct TeamArgs {
    /// How plans are exchanged; left out: peer up to 20 robots, relay above
    #[arg(long)]
    exchange: Option<Exchange>,
    /// Last tick, instead of the scenario's
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub(super) max_ticks: Option<u64>,
}

impl TeamArgs {
    /// The exchange that was asked for.
    pub(super) fn exchange(&self) -> Option<Kind> {
        self.exchange.map(|exchange| match exchange {
            Exchange::Peer => Kind::Peer,
            Exchange::Relay => Kind::Relay,
        })
    }
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Exchange {
    /// Every robot to every robot
    Peer,
    /// Through the coordinator
    Relay,
}
