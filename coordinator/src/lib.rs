//! Runs a team of processes in lock step, records it and shows it. Prints nothing.

pub mod clock;
mod destinations;
pub mod guarantee;
pub mod horizons;
pub mod latency;
pub mod launch;
pub mod members;
pub mod orders;
mod own_runtime_dir;
pub mod page;
pub mod policy;
pub mod record;
pub mod rollout;
pub mod roster;
pub mod run;
pub mod session;
pub mod solver_check;
pub mod summary;
pub mod team;
pub mod tick_parts;
pub mod view;
