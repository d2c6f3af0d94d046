//! The coordinator: starts the team, keeps it in lock step, records and judges what it did.

pub mod clock;
pub mod launch;
pub mod roster;
pub mod run;
