//! Comparisons of controllers over scenarios and seeds, all in this process.
//!
//! An [`Experiment`] (scenarios x controllers x seeds) says which [`Job`]s there are, [`run_all`] makes a [`Run`] of
//! each, [`keep_best`] leaves one variant where a controller has several, and [`Comparison`] puts the rest together
//! by family and controller.

mod best;
mod controller;
mod experiment;
mod layouts;
mod run;
mod sample;
mod summary;
mod tables;

pub use best::{Counted, Tried, by_variant, keep_best};
pub use controller::{ControllerSpec, ControllerSpecError, ControllerSpecs, HorizonPart};
pub use experiment::{CompareError, Experiment, Job};
pub use layouts::{Entry, EntryError, expand};
pub use run::{Run, Runs, run_all};
pub use sample::{Median, Sample};
pub use summary::{BestOf, Comparison, Row, VERSION};
pub use tables::{by_family, by_run};
