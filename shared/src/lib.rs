//! What every process of vodca shares.
//!
//! The maths modules ([`horizon`], [`random`], [`separation`], [`prediction`], [`metrics`]) import
//! nothing of the system; see ARCHITECTURE.md for the map.

pub mod horizon;
pub mod horizon_source;
pub mod metrics;
pub mod params;
pub mod prediction;
pub mod random;
pub mod scenario;
pub mod separation;
pub mod step;
pub mod suggest;

/// A point in the plane, metres, world frame.
pub type Position = nalgebra::Vector2<f64>;

/// A control input (velocity of the single integrator), m/s, world frame.
pub type Input = nalgebra::Vector2<f64>;
