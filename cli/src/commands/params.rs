//! `params`: all parameters with value, unit, range and effect.

use crate::exit::{Ending, Failure, Outcome};
use crate::stdout;
use vodca::params::{Params, Profile, table};

/// Arguments of `params`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh params
  ./run.sh params --profile paper --set vodca.rows=each")]
pub struct Args {
    /// Parameter set: safe, paper, orca or orca-rh
    #[arg(long, default_value = "safe")]
    profile: Profile,
    /// Change a parameter (repeatable)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Prints the list.
pub fn run(args: Args) -> Ending {
    let params = Params::resolve(args.profile, "-", &toml::Table::new(), &args.set).map_err(Failure::usage)?;
    stdout::text(table::listing(&params))?;
    Ok(Outcome::Done)
}
