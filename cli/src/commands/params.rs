//! `params`: all parameters with value, unit, range and effect.

use super::parameter_args::ParameterArgs;
use crate::exit::{Ending, Failure, Outcome};
use crate::stdout;
use vodca::params::{Params, table};

/// Arguments of `params`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  ./run.sh params
  ./run.sh params --profile paper --set vodca.rows=each")]
pub struct Args {
    #[command(flatten)]
    parameters: ParameterArgs,
}

/// Prints the list.
pub fn run(args: Args) -> Ending {
    let params = Params::resolve(args.parameters.profile, "-", &toml::Table::new(), &args.parameters.set)
        .map_err(Failure::usage)?;
    stdout::text(table::listing(&params))?;
    Ok(Outcome::Done)
}
