//! `latency.csv`: how long every tick took, by part, and every robot's step in it. Measured, so never compared.

use super::folder::{GrowingFile, RecordError};
use crate::tick_parts::{PARTS, TickTimes};
use std::fmt::Write as _;
use std::path::PathBuf;
use vodca::step::Step;

/// Name of the file in a run folder.
pub const FILE: &str = "latency.csv";

/// Writes the file tick by tick, all times in ns: the tick's duration and lateness, the announcement,
/// the robot whose report came last with its [`PARTS`] (they make up the tick), then the time of one
/// step per robot. Cells of what was not measured are empty.
#[derive(Debug)]
pub struct LatencyWriter {
    file: GrowingFile,
    text: String,
}

impl LatencyWriter {
    /// Starts the file with its header.
    pub fn create(path: PathBuf, robots: usize) -> Result<Self, RecordError> {
        let mut file = GrowingFile::create(path)?;
        let parts = PARTS.map(|part| format!(",{part}_ns")).concat();
        let robots: String = (0..robots).map(|robot| format!(",{robot}")).collect();
        file.append(format!("tick,tick_ns,late_ns,announce_ns,last{parts}{robots}\n").as_bytes())?;
        Ok(Self { file, text: String::new() })
    }

    /// Appends one tick.
    pub fn tick(&mut self, tick: u64, times: &TickTimes<'_>, steps: &[Step]) -> Result<(), RecordError> {
        self.text.clear();
        let TickTimes { duration_ns, late_ns, announce_ns, .. } = times;
        let _ = write!(self.text, "{tick},{duration_ns},{late_ns},{announce_ns},"); // writing to a String cannot fail
        match times.last(steps) {
            Some((robot, parts)) => {
                let _ = write!(self.text, "{robot}");
                for part in parts {
                    let _ = write!(self.text, ",{part}");
                }
            }
            None => PARTS.iter().for_each(|_| self.text.push(',')),
        }
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
    use shared::messages::Stamps;

    #[test]
    fn a_tick_is_one_line_of_nanoseconds_with_as_many_cells_as_the_header() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(FILE);
        let mut writer = LatencyWriter::create(path.clone(), 2).unwrap();
        let stamps =
            |woken| Stamps { announced: 10, woken, read: 60, planned: 1_060, reported: 1_070, collected: 1_090 };
        let both = [stamps(40), stamps(50)];
        let measured = TickTimes { duration_ns: 5_000, late_ns: 7, announce_ns: 30, stamps: &both };
        writer.tick(0, &measured, &samples::steps(2, 0)).unwrap();
        writer.tick(1, &TickTimes { duration_ns: 6_000, ..TickTimes::default() }, &samples::steps(2, 1)).unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let header = "tick,tick_ns,late_ns,announce_ns,last,\
                      wake_ns,read_ns,detect_ns,solve_ns,check_ns,publish_ns,collect_ns,0,1";
        assert_eq!(lines[0], header);
        assert_eq!(lines[1], "0,5000,7,30,1,40,10,300,400,300,10,20,1000,1000");
        assert_eq!(lines[2], "1,6000,0,0,,,,,,,,,1000,1000");
    }
}
