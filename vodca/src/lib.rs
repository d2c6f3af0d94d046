//! Teams of robots that plan for themselves, as a library: no processes, no exchange, no clock that decides.

pub mod baseline;
pub mod body;
pub mod conflict;
pub mod controller;
pub mod explain;
pub mod geometry;
pub mod hearing;
pub mod horizon;
pub mod horizon_source;
pub mod layout;
pub mod metrics;
pub mod mpc;
pub mod params;
pub mod play;
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

pub use team::Team;

/// A scenario by its name ([`scenario::Scenario::resolve`]: a file, `ex14_d`, `ring:16`) with the parameters of `profile`,
/// changed as `set` says (`"vodca.turn=0.2"`), checked together.
///
/// # Errors
/// What cannot be used, with its place and what is allowed.
pub fn set_up(
    scenario: &str,
    profile: params::Profile,
    set: &[&str],
) -> Result<(scenario::Scenario, params::Params), scenario::SetupError> {
    let set: Vec<String> = set.iter().map(|change| (*change).to_owned()).collect();
    scenario::set_up(Some(scenario), None, profile, &set)
}
