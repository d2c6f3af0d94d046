//! One robot of the team as a process.
mod horizons;
pub mod run;
