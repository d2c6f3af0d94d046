//! The program `vodca`: one file per command, the only crate that prints.

pub mod cli;
pub mod commands;
pub mod exit;
pub mod needs;
pub mod progress;
pub mod report;
pub mod stdout;
mod whole_file;
