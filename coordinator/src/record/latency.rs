//! `latency.csv`: how long every tick took, and every robot's step in it. Measured, so never compared.

use super::folder::{GrowingFile, RecordError};
use shared::step::Step;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Duration;

/// Name of the file in a run folder.
pub const FILE: &str = "latency.csv";

/// Writes the file tick by tick: the tick, its duration, then the time of one step per robot, all ns.
#[derive(Debug)]
pub struct LatencyWriter {
    file: GrowingFile,
    text: String,
}

impl LatencyWriter {
    /// Starts the file with the header `tick,tick_ns,0,1,...`.
    pub fn create(path: PathBuf, robots: usize) -> Result<Self, RecordError> {
        let mut file = GrowingFile::create(path)?;
        let header = (0..robots).fold(String::from("tick,tick_ns"), |line, robot| format!("{line},{robot}"));
        file.append(format!("{header}\n").as_bytes())?;
        Ok(Self { file, text: String::new() })
    }

    /// Appends one tick, which took `duration` as the coordinator sees it.
    pub fn tick(&mut self, tick: u64, duration: Duration, steps: &[Step]) -> Result<(), RecordError> {
        self.text.clear();
        let _ = write!(self.text, "{tick},{}", duration.as_nanos()); // writing to a String cannot fail
        for step in steps {
            let _ = write!(self.text, ",{}", step.step_ns);
        }
        self.text.push('\n');
        self.file.append(self.text.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::*;

    #[test]
    fn a_tick_is_one_line_of_nanoseconds() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(FILE);
        let mut writer = LatencyWriter::create(path.clone(), 2).unwrap();
        writer.tick(0, Duration::from_micros(5), &samples::steps(2, 0)).unwrap();
        assert_eq!(std::fs::read_to_string(path).unwrap(), "tick,tick_ns,0,1\n0,5000,1000,1000\n");
    }
}
