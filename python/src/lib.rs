//! What the Python package `vodca` is made of in Rust. Everything that people use is in `package/vodca`, which hands over
//! to the classes and functions here; what they do is the product's own code.

mod arrays;
mod controller;
mod environments;
mod error;
mod export;
mod horizons;
mod parameters;
mod parity;
mod run;
mod scenario;
mod slot;
mod values;
mod workers;

use pyo3::prelude::*;

/// The module `vodca._native`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::controller::{Controller, Decision, Plan};
    #[pymodule_export]
    use crate::environments::Environments;
    #[pymodule_export]
    use crate::error::Error;
    #[pymodule_export]
    use crate::export::{publish_layers, publish_model};
    #[pymodule_export]
    use crate::parameters::{effective, parameters};
    #[pymodule_export]
    use crate::run::{Run, read, run};
    #[pymodule_export]
    use crate::scenario::{Scenario, names};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
