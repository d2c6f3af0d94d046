//! Versatile on-demand collision avoidance (paper, section III-C): from predictions of tick `k - 1`
//! to collision rows of tick `k`. No IPC, no solver.

pub mod back_off;
pub mod detection;
pub mod memory;
pub mod rows;
pub mod traffic;

pub use detection::{Conflict, Hazard, PredictedMotion};
