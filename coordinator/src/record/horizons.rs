//! `horizons.csv`: the horizons that were used, in the format that `--horizon script:FILE` reads.

use super::folder::{GrowingFile, RecordError};
use std::fmt::Write as _;
use std::path::PathBuf;
use vodca::horizon::Horizon;

/// Name of the file in a run folder.
pub const FILE: &str = "horizons.csv";

/// Writes the file tick by tick: the tick, then one horizon per robot.
#[derive(Debug)]
pub struct HorizonsWriter {
    file: GrowingFile,
    text: String,
}

impl HorizonsWriter {
    /// Starts the file with the header `tick,0,1,...`.
    pub fn create(path: PathBuf, robots: usize) -> Result<Self, RecordError> {
        let mut file = GrowingFile::create(path)?;
        let header = (0..robots).fold(String::from("tick"), |line, robot| format!("{line},{robot}"));
        file.append(format!("{header}\n").as_bytes())?;
        Ok(Self { file, text: String::new() })
    }

    /// Appends one tick.
    pub fn tick(&mut self, tick: u64, horizons: impl Iterator<Item = Horizon>) -> Result<(), RecordError> {
        self.text.clear();
        let _ = write!(self.text, "{tick}"); // writing to a String cannot fail
        for horizon in horizons {
            let _ = write!(self.text, ",{horizon}");
        }
        self.text.push('\n');
        self.file.append(self.text.as_bytes())
    }

    /// Makes sure that everything is on the disk.
    pub fn finish(self) -> Result<(), RecordError> {
        self.file.sync()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_is_one_line() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(FILE);
        let mut writer = HorizonsWriter::create(path.clone(), 2).unwrap();
        writer.tick(0, [Horizon::MIN, Horizon::MAX].into_iter()).unwrap();
        writer.finish().unwrap();
        assert_eq!(std::fs::read_to_string(path).unwrap(), "tick,0,1\n0,1,49\n");
    }
}
