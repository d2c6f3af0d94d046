//! A file of a run folder that is there only once there is something in it.

use super::folder::{GrowingFile, RecordError};
use std::path::PathBuf;

/// Grows from its first line on; the header comes with that.
#[derive(Debug)]
pub(super) struct OnDemandFile {
    path: PathBuf,
    header: &'static str,
    file: Option<GrowingFile>,
}

impl OnDemandFile {
    /// A file at `path` that does not exist yet; `header` will be its first line.
    pub(super) fn new(path: PathBuf, header: &'static str) -> Self {
        Self { path, header, file: None }
    }

    /// Appends whole lines; no text makes no file.
    pub(super) fn append(&mut self, lines: &str) -> Result<(), RecordError> {
        if lines.is_empty() {
            return Ok(());
        }
        let file = match &mut self.file {
            Some(file) => file,
            none => {
                let file = none.insert(GrowingFile::create(self.path.clone())?);
                file.append(format!("{}\n", self.header).as_bytes())?;
                file
            }
        };
        file.append(lines.as_bytes())
    }
}
