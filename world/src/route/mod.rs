//! The shortest ways round everything that stands.
//!
//! A robot of clearance c (what its centre owes to every shape, m) may be where every piece is at least c away:
//! outside the shapes inflated by c, whose corners are round. A shortest way there is made of straight lines
//! that touch inflated corners and of arcs on them. [`Roadmap`] takes polygons round the arcs, from outside, and
//! keeps the straight lines between their corners that a taut string could take (the tangent visibility graph,
//! Lozano-Perez and Wesley 1979): computed once for a map and a clearance, and shared. [`Route`] holds, for one
//! set-point, what is left from every corner (Dijkstra 1959) and answers where to go from anywhere.
//!
//! # How much longer than the shortest
//!
//! Tangents of the polygons are at most [`ARC`] apart, so a corner is at most 1 / cos([`ARC`] / 2), 1.0196,
//! times as far from the vertex it goes round as the arc is (c for polygons, c plus its radius for a disc).
//! Growing all arcs by a factor s makes a way that stays open at most s times as long: its length L grows with
//! the radius r of its arcs by their angles, dL/dr = sum of |angles| <= L / r. Hence a way is at most
//! 1.0196 times the shortest one that also keeps 1.0196 times the clearance, and never shorter than the shortest
//! by more than what may be cut ([`CUT`]). A gap that is less than 1.02 times too wide to be closed may count
//! as closed.

mod corners;
mod reach;
mod roadmap;
mod walk;
mod ways;

pub use corners::Corner;
pub use reach::{Gap, Unreachable};
pub use roadmap::Roadmap;
pub use walk::Walk;
pub use ways::{Aim, Route};

use std::f64::consts::PI;

/// Between the tangents of the polygon that is walked round an arc, at most: sixteen corners round a disc.
pub const ARC: f64 = PI / 8.0;
/// By how much a way may cut into what is owed, as a share of the clearance: robots slide along it.
pub const CUT: f64 = 1e-3;
/// Rounding allowance on distances, m, for clearances next to nothing.
const ROUNDING: f64 = 1e-9;
/// Who is this share of its clearance too near is sliding along a shape, not lost in it.
const SLIDING: f64 = 0.05;
/// A place nearer to a corner than this has reached it, m.
const REACHED: f64 = 1e-6;

/// A distance from which a piece counts as owed its clearance on a way already found, m.
fn least_on_the_way(clearance: f64) -> f64 {
    clearance * (1.0 - CUT) - ROUNDING
}

/// The same while ways are looked for: stricter, so that whoever follows one is never told that it is closed.
fn least_in_search(clearance: f64) -> f64 {
    clearance * (1.0 - CUT / 2.0)
}

#[cfg(test)]
mod tests;
