//! The program behind `run.sh`.

use clap::Parser;
use coordinator::cli::Cli;
use coordinator::exit;
use std::process::ExitCode;
use tracing_subscriber::EnvFilter;

fn main() -> ExitCode {
    let cli = Cli::parse();
    tracing_subscriber::fmt().with_writer(std::io::stderr).with_env_filter(EnvFilter::new("info")).init();
    exit::report(cli.run())
}
