//! A place of shared files that goes with its owner.

use shared::runtime_dir::RuntimeDir;

/// Deletes the shared files of its place when dropped.
#[derive(Debug)]
pub(crate) struct OwnRuntimeDir(pub(crate) RuntimeDir);

impl Drop for OwnRuntimeDir {
    fn drop(&mut self) {
        self.0.remove();
    }
}
