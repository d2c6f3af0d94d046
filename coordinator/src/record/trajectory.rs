//! `trajectory.csv`: what every robot did in every tick, in text that reads back to the same numbers.
//!
//! One row per tick and robot: position at the start of the tick (m), the input applied during it (m/s),
//! the horizon, the QP's rows, and how the plan came about. Then one row per robot with the final position
//! and nothing else. Two runs are equal when these files are equal byte for byte.
//! Numbers are the shortest decimal text that reads back to the same `f64`.

use super::folder::{GrowingFile, RecordError};
use std::fmt::Write as _;
use std::path::PathBuf;
use vodca::Position;
use vodca::step::Step;

/// Name of the file in a run folder.
pub const FILE: &str = "trajectory.csv";
/// Its first line.
pub const HEADER: &str = "tick,robot,x,y,ux,uy,horizon,rows,level,status";

/// Writes the file tick by tick.
#[derive(Debug)]
pub struct TrajectoryWriter {
    file: GrowingFile,
    text: String,
}

impl TrajectoryWriter {
    /// Starts the file with its header.
    pub fn create(path: PathBuf) -> Result<Self, RecordError> {
        let mut file = GrowingFile::create(path)?;
        file.append(format!("{HEADER}\n").as_bytes())?;
        Ok(Self { file, text: String::new() })
    }

    /// Appends one tick: all robots' rows in one piece, so that a cut run ends at a whole tick.
    pub fn tick(&mut self, tick: u64, steps: &[Step]) -> Result<(), RecordError> {
        self.text.clear();
        push_tick(&mut self.text, tick, steps);
        self.file.append(self.text.as_bytes())
    }

    /// Appends the final positions, reached at the start of tick `tick` (which was not planned any more).
    pub fn finish(mut self, tick: u64, positions: &[Position]) -> Result<(), RecordError> {
        self.text.clear();
        push_end(&mut self.text, tick, positions);
        self.file.append(self.text.as_bytes())?;
        self.file.sync()
    }
}

/// Appends the rows of one tick to `text`.
pub fn push_tick(text: &mut String, tick: u64, steps: &[Step]) {
    for (robot, step) in steps.iter().enumerate() {
        let (x, y) = (step.position.x, step.position.y);
        let (ux, uy) = (step.input.x, step.input.y);
        let (level, status) = (step.level.word(), step.status.word());
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{tick},{robot},{x},{y},{ux},{uy},{},{},{level},{status}", step.horizon, step.rows);
    }
}

/// Appends the last rows to `text`.
pub fn push_end(text: &mut String, tick: u64, positions: &[Position]) {
    for (robot, position) in positions.iter().enumerate() {
        let _ = writeln!(text, "{tick},{robot},{},{},,,,,,", position.x, position.y);
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_file_has_a_header_a_row_per_tick_and_robot_and_last_rows() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(FILE);
        let mut writer = TrajectoryWriter::create(path.clone()).unwrap();
        let steps = samples::steps(2, 0);
        writer.tick(0, &steps).unwrap();
        // Readable while the run goes on.
        assert_eq!(std::fs::read_to_string(&path).unwrap().lines().count(), 3);
        writer.finish(1, &[steps[0].next_position, steps[1].next_position]).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "tick,robot,x,y,ux,uy,horizon,rows,level,status");
        assert_eq!(lines[1], "0,0,0,0,1.5,0.25,3,0,closed_form,solved");
        assert_eq!(lines[4], "1,1,10.3,0.05,,,,,,");
        assert!(text.ends_with('\n') && lines.len() == 5);
    }

    proptest! {
        #[test]
        fn every_number_reads_back_to_the_same_bits(x in any::<f64>(), y in -1e9f64..1e9, ux in -1.5f64..1.5) {
            let mut steps = samples::steps(1, 0);
            steps[0].position = Position::new(x, y);
            steps[0].input.x = ux;
            let mut text = String::new();
            push_tick(&mut text, 7, &steps);
            let fields: Vec<&str> = text.trim_end().split(',').collect();
            for (field, value) in [(2, x), (3, y), (4, ux)] {
                let back: f64 = fields[field].parse().unwrap();
                prop_assert!(back.to_bits() == value.to_bits() || back.is_nan() && value.is_nan());
            }
        }
    }
}
