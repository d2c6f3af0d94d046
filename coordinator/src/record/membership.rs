//! `membership.csv`: who did not take part in which ticks, and why. A run in which everybody always does has no such file.
//!
//! A line per change: the first tick that a robot misses (`late`, `lost`) or in which it takes part again (`back`), which
//! of its processes that is about, and how it came about. Together with `horizons.csv` it says all that is needed to
//! repeat the run.

use super::folder::RecordError;
use super::on_demand::OnDemandFile;
use crate::members::Change;
use std::path::PathBuf;
use vodca::membership::State;

/// Name of the file in a run folder.
pub const FILE: &str = "membership.csv";
/// Its first line.
pub const HEADER: &str = "tick,robot,state,life,why";

/// Writes the file when there is something to write.
#[derive(Debug)]
pub struct MembershipWriter {
    file: OnDemandFile,
    written: usize,
}

impl MembershipWriter {
    /// A file at `path` that does not exist before the first change.
    pub fn new(path: PathBuf) -> Self {
        Self { file: OnDemandFile::new(path, HEADER), written: 0 }
    }

    /// Appends what is new among `changes`, which are all of the run.
    pub fn write(&mut self, changes: &[Change]) -> Result<(), RecordError> {
        let new = changes.get(self.written..).unwrap_or_default();
        let mut text = String::new();
        for Change { tick, robot, state, life, why } in new {
            let why = why.replace('"', "\"\"").replace(['\n', '\r'], " ");
            text += &format!("{tick},{robot},{},{life},\"{why}\"\n", word(*state));
        }
        self.written = changes.len();
        self.file.append(&text)
    }
}

/// The word of a state in files.
pub fn word(state: State) -> &'static str {
    match state {
        State::Expected => "expected",
        State::Driving => "driving",
        State::Late => "late",
        State::Lost => "lost",
        State::Back => "back",
    }
}

/// Reads the file again, but for the reasons; `Err`: the first line that means nothing, from 1.
pub fn read(text: &str) -> Result<Vec<Change>, usize> {
    let mut lines = text.split_terminator('\n').enumerate();
    if lines.next().is_none_or(|(_, line)| line != HEADER) {
        return Err(1);
    }
    lines.map(|(at, line)| change(line).ok_or(at + 1)).collect()
}

fn change(line: &str) -> Option<Change> {
    let mut fields = line.splitn(5, ',');
    let (tick, robot) = (fields.next()?.parse().ok()?, fields.next()?.parse().ok()?);
    let state = fields.next()?;
    let state = State::ALL.into_iter().find(|known| word(*known) == state)?;
    let life = fields.next()?.parse().ok()?;
    let why = fields.next()?.strip_prefix('"')?.strip_suffix('"')?.replace("\"\"", "\"");
    Some(Change { tick, robot, state, life, why })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_read_back_and_without_any_there_is_no_file() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(FILE);
        let mut writer = MembershipWriter::new(path.clone());
        writer.write(&[]).unwrap();
        assert!(!path.exists());
        let why = "was ended by signal 9, saying \"no, not me\"".to_string();
        let mut changes = vec![Change { tick: 41, robot: 3, state: State::Lost, life: 1, why }];
        writer.write(&changes).unwrap();
        changes.push(Change { tick: 44, robot: 3, state: State::Back, life: 2, why: "two\nlines".into() });
        writer.write(&changes).unwrap();
        writer.write(&changes).unwrap();
        changes[1].why = "two lines".into();
        let text = std::fs::read_to_string(path).unwrap();
        assert_eq!(read(&text), Ok(changes), "{text}");
        assert_eq!(read(&text.replace("lost", "found")), Err(2));
        assert_eq!(read("tick\n"), Err(1));
    }
}
