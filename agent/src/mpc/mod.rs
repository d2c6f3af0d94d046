//! The robot's quadratic program and the ladder of its solvers.
//!
//! [`problem`] states the program once; every solver builds what suits it. [`stacked`] is the
//! paper's formulation, which the tests compare against.

pub mod clarabel;
pub mod closed_form;
pub mod cross_check;
pub mod kkt;
pub mod ladder;
pub mod polish;
pub mod problem;
pub mod sample;
pub mod stacked;
pub mod structured;
