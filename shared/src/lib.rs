//! What every process of vodca shares.
//!
//! The maths modules ([`horizon`], [`random`], [`separation`], [`prediction`], [`metrics`]) import
//! nothing of the system; see ARCHITECTURE.md for the map.

pub mod exchange;
pub mod horizon;
pub mod horizon_source;
pub mod messages;
pub mod metrics;
pub mod os;
pub mod params;
pub mod place;
pub mod policy;
pub mod prediction;
pub mod random;
pub mod raw;
pub mod reward;
pub mod rollout;
pub mod scenario;
pub mod separation;
pub mod services;
pub mod step;
pub mod stop;
pub mod suggest;
pub mod team;
pub mod tensor_file;

/// A point in the plane, metres, world frame.
pub type Position = nalgebra::Vector2<f64>;

/// A control input (velocity of the single integrator), m/s, world frame.
pub type Input = nalgebra::Vector2<f64>;
