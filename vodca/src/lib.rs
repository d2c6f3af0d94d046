//! Teams of robots that plan for themselves, as a library: no processes, no exchange, no clock that decides.

pub mod baseline;
pub mod conflict;
pub mod controller;
pub mod explain;
pub mod hearing;
pub mod horizon;
pub mod horizon_source;
pub mod layout;
pub mod metrics;
pub mod mpc;
pub mod params;
pub mod prediction;
pub mod random;
pub mod reference;
pub mod robot;
pub mod route;
pub mod safety;
pub mod scenario;
pub mod separation;
pub mod step;
pub mod suggest;
pub mod team;
pub mod vodca_controller;

/// A point in the plane, metres, world frame.
pub type Position = nalgebra::Vector2<f64>;

/// A control input (velocity of the single integrator), m/s, world frame.
pub type Input = nalgebra::Vector2<f64>;
