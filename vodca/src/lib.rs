//! Variable-horizon model predictive control of a team of robots, with collision constraints only where two plans
//! conflict (VODCA) and a separation that holds by construction. No processes, no exchange, no clock that decides.
//!
//! # The problem
//!
//! Robot i of n is a point in the plane, `x_i` in m, driven by a velocity `u_i` in m/s that is constant within a tick of
//! `h` seconds:
//!
//! ```text
//! x_i[k+1] = x_i[k] + h u_i[k],      |u_i[k]| <= u_max per axis
//! ```
//!
//! At tick k it plans `N = N_i^k` steps ahead, 1 <= N <= 49, a number that is chosen anew for every robot and tick, by
//! solving
//!
//! ```text
//! minimise    sum_{l=1..N}   q |x[l] - r[l]|^2  +  sum_{l=0..N-1} w |u[l] - v[l]|^2  +  sum_c (rho1 e_c + rho2/2 e_c^2)
//! subject to  x[0] = measured position,   x[l+1] = x[l] + h u[l],   |u[l]| <= u_max per axis
//!             b_c . x[p_c] >= o_c - e_c,  e_c >= 0        one row per conflict c (VODCA)
//!             n_j . (x[1] - x[0]) >= a_j                  the cell: one hard row per near robot or obstacle j
//! ```
//!
//! | symbol | shape, unit | what | where |
//! |---|---|---|---|
//! | `x[l]`, `u[l]` | 2, m; 2, m/s | predicted state, input | [`prediction::Prediction`] |
//! | `N` | 1..=49 steps | prediction horizon | [`horizon::Horizon`] |
//! | `r[l]`, `v[l]` | 2, m; 2, m/s | reference: the set-point itself (paper), or a walk to it at full speed | [`mod@reference`] |
//! | `q`, `w` | 1/m^2; s^2/m^2 | weights, Q = q I and W = w I | [`params::Mpc`] |
//! | `b_c`, `o_c`, `p_c` | 2, unit vector; m; 1..=N | collision row: normal, offset, step | [`mpc::problem::Row`] |
//! | `e_c`, `rho1`, `rho2` | m; 1/m; 1/m^2 | slack of a soft row and its price | [`mpc::problem::SlackPrice`] |
//! | `n_j`, `a_j` | 2, unit vector; m | cell row: normal, least move along it | [`safety::cell::CellRow`] |
//!
//! **Collision rows.** Robot i holds its plan of tick k-1 against the plan of tick k-1 of robot j (or an obstacle at rest)
//! over the steps that both predict, l = 1..min(N_i, N_j). The first step closer than the separation owed, `k_c`, is a
//! conflict. With the distance d there and `o_l` the other's state, the row is the half plane
//! `b . x[p] >= r_min + b . o_l` with `b = (x^_i[k_c] - o_l) / d`, `p = min(k_c, N)`: a horizon that has become shorter than
//! the conflict is far away is no reason to forget it. Without a conflict there is no row, and mostly no QP.
//!
//! **Cells.** With d = |p_i - p_j| between the positions that everybody broadcast and n from j to i, both robots keep
//! `n . move >= (r_s - d) / 2` within this tick. The two rows added keep n . (x_i - x_j) >= r_s at the end of the tick and,
//! being linear, in between; standing still always satisfies them. [`safety::last_check`] applies them to whatever a
//! solver answered, so the separation `r_s` depends on no horizon, plan, policy or solver.
//!
//! # A tick
//!
//! [`vodca_controller::VodcaController`] ticks one robot: who goes first and which way ([`right_of_way`]), conflicts
//! and rows ([`conflict`]), reference, cell, QP ([`mpc::ladder`]: closed form, then a structured active-set solver, then
//! Clarabel), last check, and the plan that the others will see: the bounded inputs rolled out by the model. Nothing is
//! allocated in a steady tick. [`Team`] ticks all robots and lets nobody see a plan of the same tick (Jacobi);
//! [`play::play`] runs it with horizons and observers; [`body::Body`] is what a robot outside the simulator implements.
//!
//! ```
//! use vodca::{Team, horizon::Horizon, params::Profile};
//!
//! let (scenario, params) = vodca::set_up("ring:4", Profile::Safe, &[])?;
//! let mut team = Team::new(&scenario, &params, 7);
//! let steps = team.step(&[Horizon::new(20)?; 4]);
//! assert!(steps.iter().all(|step| step.input.amax() <= params.model.max_speed));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The paper is Gupta, Kumar, Tripathy and Shah, *RL-based variable horizon model predictive control of multi-robot systems
//! using versatile on-demand collision avoidance*; profile [`params::Profile::Paper`] is its method, the rest is ours.

pub mod baseline;
pub mod body;
pub mod bounds;
pub mod chains;
pub mod conflict;
pub mod controller;
pub mod explain;
pub mod filling;
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
pub mod right_of_way;
pub mod robot;
pub mod route;
pub mod safety;
pub mod scenario;
pub mod separation;
pub mod standing;
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
