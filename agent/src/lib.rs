//! One robot of the team: predicts, detects conflicts, solves its own MPC, publishes its plan.
pub mod controller;
pub mod mpc;
pub mod vodca;
