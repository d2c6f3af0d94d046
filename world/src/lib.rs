//! What stands in a robot's world, and the ways round it.
//!
//! Obstacles are written as discs, polygons, walls and occupancy maps ([`shape`], [`map`], [`mod@file`]), checked
//! ([`check`]), cut into convex pieces that answer every question about distance ([`shape::Piece`]) and walked
//! round on the shortest way ([`route`]). Pure: no clock, no randomness; only [`map`] reads files.

pub mod check;
pub mod draw;
pub mod file;
pub mod map;
pub mod route;
pub mod shape;
pub mod shipped;

/// A place or a displacement in the plane, m, world frame.
pub type Position = nalgebra::Vector2<f64>;
