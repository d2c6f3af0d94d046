//! One robot of the team: predicts, detects conflicts, solves its own MPC, publishes its plan.
pub mod baseline;
pub mod controller;
pub mod filling;
pub mod golden;
pub mod hearing;
mod horizons;
pub mod layout;
pub mod mpc;
pub mod reference;
pub mod robot;
pub mod route;
pub mod run;
pub mod safety;
pub mod standing;
pub mod team;
pub mod vodca;
pub mod vodca_controller;
