//! The robot's quadratic program and the ladder of its solvers.
//!
//! [`problem`] states the program once; every solver builds what suits it. [`ladder`] asks
//! [`closed_form`], then [`structured`], then [`clarabel`] (whose answers [`polish`] makes exact).
//! [`kkt`] judges any answer from the problem alone, [`stacked`] is the paper's formulation, and
//! [`sample`] makes random problems: all three serve tests and comparisons as well.

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
