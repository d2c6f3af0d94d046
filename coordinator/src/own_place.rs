//! A place of shared files that goes with its owner.

use shared::place::Place;

/// Deletes the shared files of its place when dropped.
#[derive(Debug)]
pub(crate) struct OwnPlace(pub(crate) Place);

impl Drop for OwnPlace {
    fn drop(&mut self) {
        self.0.remove();
    }
}
