//! Teams of robots that plan for themselves, as a library: no processes, no exchange, no clock that decides.
//!
//! # The problem
//!
//! Robot i moves in the plane. At tick k it is at `x_i[k]` (m), and its input `u_i[k]` (m/s) is held for `h` seconds:
//!
//! ```text
//! x_i[k+1] = x_i[k] + h u_i[k],     |u_i[k]| <= 1.5 m/s per axis
//! ```
//!
//! It plans over its own horizon `N = N_i^k`, 1..=49 steps, which may be another one at every tick:
//!
//! ```text
//! min   sum_{l=1..N} q |x[l] - x^d[l]|^2  +  sum_{l=0..N-1} w |u[l] - u^d[l]|^2  +  sum_rows (rho1 e + rho2/2 e^2)
//! s.t.  x[l+1] = x[l] + h u[l],     x[0] = where it measures itself,     |u[l]| <= 1.5 per axis
//!       b . x[p] >= c - e,  e >= 0        a collision row for each conflict
//!       n . (x[1] - x[0]) >= (r_s - d)/2  a cell row for each neighbour, hard
//! ```
//!
//! and applies `u[0]`. The reference `x^d, u^d` is the set-point itself (profile `paper`) or a walk
//! at full speed along the robot's way, round obstacles and who stands (`safe`).
//!
//! *VODCA rows.* Let `y_i[l]` and `y_j[l]` be the plans that robots i and j published at tick k - 1. The first step with
//! `|y_i[l] - y_j[l]| < r`, `r` the separation owed, is a *conflict*; without one there is no row. With
//! `b = R(theta) (y_i - y_j) / |y_i - y_j|` there, turned left by `theta`, the row is `b . x[p] >= r + b . y_j`: the half
//! plane that touches the circle around the other. The step p is that of the conflict or the one before, as
//! [`params`] say, and `e` is the slack of rows that are not hard.
//!
//! *Cells.* With `d = |p_i - p_j|` and `n = (p_i - p_j) / d` of the positions that everybody broadcast, both robots of a
//! pair owe half of what `d` has above `r_s`. Standing still always satisfies that; the two rows add up to a separation of
//! at least `r_s` at the end of the tick and, moves being straight, throughout it. After any outcome of any solver
//! [`safety::filter`] replaces a first move that would leave the cell.
//!
//! # A tick
//!
//! [`Team::step`] (or [`play::play`], which also chooses horizons and tells observers) lets every robot, from the plans of
//! tick k - 1 alone: find conflicts ([`conflict`]), choose its [`mod@reference`], bound its cell ([`safety`]), solve
//! ([`mpc`]: closed form, structured solver, Clarabel), check, publish its [`prediction`], move its [`body`] and
//! measure itself for tick k + 1.
//!
//! # Shapes and units
//!
//! | what | type | unit |
//! |---|---|---|
//! | position, set-point `x` | [`Position`], world frame | m |
//! | input `u` | [`Input`], world frame | m/s |
//! | horizon `N` | [`horizon::Horizon`], one per robot and tick | steps |
//! | plan | [`prediction::Prediction`], N + 1 positions; `state(0)`: where it planned, `state(1)`: where it will be | m |
//! | what a robot did | [`step::Step`], one per robot and tick, by robot number | |
//! | `h`, bounds, weights, `r`, `theta` | [`params::Params`], each with unit, range and effect | |
//!
//! # In five lines
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use vodca::{Team, horizon::Horizon, params::Profile};
//!
//! let (scenario, params) = vodca::set_up("ex14_d", Profile::Safe, &[])?;
//! let mut team = Team::new(&scenario, &params, 7);
//! let horizons = vec![Horizon::new(20)?; scenario.robots.len()];
//! let steps = team.step(&horizons);
//! assert!(steps.iter().all(|step| step.input.amax() <= 1.5));
//! # Ok(())
//! # }
//! ```
//!
//! A controller of your own implements [`controller::Controller`], a robot of your own [`body::Body`], a choice of
//! horizons [`horizon_source::Horizons`], and whatever watches a run [`play::Observer`].

pub mod baseline;
pub mod body;
pub mod conflict;
pub mod controller;
pub mod explain;
pub mod geometry;
pub mod horizon;
pub mod horizon_source;
pub mod layout;
pub mod local_observation;
pub mod membership;
pub mod metrics;
pub mod mpc;
pub mod neighbour_estimates;
pub mod obstacles;
pub mod params;
pub mod play;
pub mod prediction;
pub mod random;
pub mod reference;
pub mod robot;
pub mod safety;
pub mod scenario;
pub mod separation;
pub mod step;
pub mod suggest;
pub mod task_list;
pub mod tasks;
pub mod team;
pub mod vodca_controller;
pub mod way;

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
