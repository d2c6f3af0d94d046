//! The coordinator: starts the team, keeps it in lock step, records and judges what it did.
//!
//! Offline commands (sweep, compare, golden, replay) run whole teams in this process.

pub mod bench;
pub mod cli;
pub mod clock;
pub mod commands;
pub mod compare;
pub mod exit;
pub mod figures;
pub mod guarantee;
pub mod in_process;
pub mod latency;
pub mod launch;
mod own_place;
pub mod page;
pub mod parallel;
pub mod policy;
pub mod progress;
pub mod record;
pub mod report;
pub mod rollout;
pub mod roster;
pub mod run;
pub mod search;
pub mod session;
pub mod solver_check;
pub mod stdout;
pub mod summary;
pub mod team;
pub mod text_table;
pub mod tick_parts;
pub mod verify;
pub mod view;
