//! The separation that holds by construction (ARCHITECTURE, rules 5 and 6): cells that robots may not leave
//! within a tick, and the safety filter after any solver outcome.

pub mod cell;
pub mod filter;

pub use cell::Cell;
