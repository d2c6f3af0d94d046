//! The coordinator: starts the team, keeps it in lock step, records and judges what it did.

pub mod latency;
pub mod record;
