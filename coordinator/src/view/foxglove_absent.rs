//! In place of the Foxglove view in a build without the feature `foxglove`.

use super::ViewError;
use super::frame::Slot;
use std::convert::Infallible;
use std::sync::Arc;
use vodca::params::Params;
use vodca::scenario::Scenario;

/// There is none.
pub(super) struct FoxgloveView(Infallible);

impl FoxgloveView {
    /// Says how to get one.
    pub(super) fn open(_: u16, _: Arc<Slot>, _: &Scenario, _: &Params) -> Result<Self, ViewError> {
        Err(ViewError::NoFoxglove)
    }

    pub(super) fn address(&self) -> &str {
        match self.0 {}
    }

    pub(super) fn close(self) {
        match self.0 {}
    }
}
