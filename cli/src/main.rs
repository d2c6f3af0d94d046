//! The program behind `run.sh`.

use clap::Parser;
use cli::cli::Cli;
use cli::exit;
use std::io::IsTerminal;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    // Lines for people: level and message, coloured only where a terminal shows it.
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_max_level(tracing::Level::INFO)
        .with_ansi(std::io::stderr().is_terminal())
        .with_target(false)
        .without_time()
        .init();
    exit::report(cli.run())
}
