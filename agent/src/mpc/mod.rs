//! The robot's quadratic program and the ladder of its solvers.
pub mod problem;
