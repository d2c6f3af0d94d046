//! The subcommands: each file holds one command's arguments and its work.

pub mod agent;
pub mod bench;
pub mod compare;
pub mod evaluate;
pub mod faults;
pub mod figures;
pub mod former;
pub mod go;
pub mod golden;
pub mod length;
mod parameter_args;
pub mod params;
pub mod replay;
pub mod report;
pub mod results;
pub mod rollout;
pub mod run;
mod run_losses;
pub mod run_policy;
mod run_tasks;
pub mod scenario;
pub mod search;
pub mod verify;
