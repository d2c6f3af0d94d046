use crate::exit::{Ending, Outcome};
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: ./run.sh")]
pub struct Args {}
pub fn run(_: Args) -> Ending { Ok(Outcome::Done) }
