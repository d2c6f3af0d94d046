//! Temporary.
use clap::Parser;
#[derive(Parser)]
struct Cli {
    #[command(flatten)]
    args: learner::train::command::Args,
}
fn main() -> anyhow::Result<()> {
    learner::train::command::run(&Cli::parse().args)
}
