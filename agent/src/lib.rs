//! One robot of the team as a process: waits for ticks, hears the others, plans, moves, tells.
//!
//! [`run::run`] is the whole of it. The program `agent` runs it with simulated bodies; a robot of your own runs it
//! with its own [`vodca::body::Body`] (see `examples/own_body.rs`).

mod error;
mod part;
pub mod run;
