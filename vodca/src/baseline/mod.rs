//! Baselines that run in the same agents, with the same record and metrics.

pub mod half_planes;
pub mod orca;
