//! `set_points.csv`: set-points that changed at run time. A run in which none does has no such file.
//!
//! A line per change: the first tick that is planned with it, whose it is, and where, m. Together with `horizons.csv` and
//! `membership.csv` it says all that is needed to repeat the run.

use super::folder::RecordError;
use super::on_demand::OnDemandFile;
use std::path::PathBuf;
use vodca::Position;
use vodca::tasks::Assignment;

/// Name of the file in a run folder.
pub const FILE: &str = "set_points.csv";
/// Its first line.
pub const HEADER: &str = "tick,robot,x,y";

/// Writes the file when there is something to write.
#[derive(Debug)]
pub struct SetPointsWriter(OnDemandFile);

impl SetPointsWriter {
    /// A file at `path` that does not exist before the first change.
    pub fn new(path: PathBuf) -> Self {
        Self(OnDemandFile::new(path, HEADER))
    }

    /// Appends what has changed with a tick.
    ///
    /// # Errors
    /// It cannot be written down.
    pub fn write(&mut self, assigned: &[Assignment]) -> Result<(), RecordError> {
        let line = |given: &Assignment| {
            let Assignment { tick, robot, set_point } = given;
            format!("{tick},{robot},{},{}\n", set_point.x, set_point.y)
        };
        self.0.append(&assigned.iter().map(line).collect::<String>())
    }
}

/// Reads the file again, for a team of `robots`; `Err`: the first line that means nothing, from 1. Ticks never go back.
pub fn read(text: &str, robots: usize) -> Result<Vec<Assignment>, usize> {
    let mut lines = text.split_terminator('\n').enumerate();
    if lines.next().is_none_or(|(_, line)| line != HEADER) {
        return Err(1);
    }
    let mut last = 0;
    lines
        .map(|(at, line)| {
            let given = assignment(line).filter(|given| given.robot < robots && given.tick >= last).ok_or(at + 1)?;
            last = given.tick;
            Ok(given)
        })
        .collect()
}

fn assignment(line: &str) -> Option<Assignment> {
    let fields: Vec<&str> = line.split(',').collect();
    let [tick, robot, x, y] = fields[..] else { return None };
    let metres = |text: &str| text.parse().ok().filter(|value: &f64| value.is_finite());
    let set_point = Position::new(metres(x)?, metres(y)?);
    Some(Assignment { tick: tick.parse().ok()?, robot: robot.parse().ok()?, set_point })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assignments_read_back_to_the_last_bit_and_without_any_there_is_no_file() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(FILE);
        let mut writer = SetPointsWriter::new(path.clone());
        writer.write(&[]).unwrap();
        assert!(!path.exists());
        let at = |tick, robot, x| Assignment { tick, robot, set_point: Position::new(x, -1.0 / 3.0) };
        let all = [at(4, 1, 0.1 + 0.2), at(4, 0, 1e-7), at(9, 1, -7.0)];
        writer.write(&all[..2]).unwrap();
        writer.write(&all[2..]).unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        assert_eq!(read(&text, 2).unwrap(), all);
        assert_eq!(read(&text, 1), Err(2));
        assert_eq!(read(&text.replace("9,1", "3,1"), 2), Err(4));
        assert_eq!(read(&text.replace("-7", "inf"), 2), Err(4));
        assert_eq!(read("tick\n", 2), Err(1));
    }
}
