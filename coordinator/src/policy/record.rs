//! `policy.csv`: which version acted at every tick. `shadow.csv`: what the shadow would have chosen.

use super::Source;
use crate::record::RecordError;
use crate::record::folder::GrowingFile;
use crate::record::horizons::HorizonsWriter;
use policy::encoding::hex;
use shared::messages::PolicyAnswer;
use std::fmt::Write;
use std::path::Path;
use vodca::horizon::Horizon;

const FILE: &str = "policy.csv";
const SHADOW_FILE: &str = "shadow.csv";

/// Writes both files tick by tick.
pub(super) struct PolicyRecord {
    acted: GrowingFile,
    shadow: Option<HorizonsWriter>,
    text: String,
}

impl PolicyRecord {
    pub(super) fn create(run: &Path, robots: usize, shadow: bool) -> Result<Self, RecordError> {
        let mut acted = GrowingFile::create(run.join(FILE))?;
        acted.append(b"tick,source,version,sha256\n")?;
        let shadow = shadow.then(|| HorizonsWriter::create(run.join(SHADOW_FILE), robots)).transpose()?;
        Ok(Self { acted, shadow, text: String::new() })
    }

    /// `source`: policy, held or default; version and sha256 only with policy.
    pub(super) fn tick(&mut self, tick: u64, source: Source, answer: Option<&PolicyAnswer>) -> Result<(), RecordError> {
        self.text.clear();
        // Writing to a String cannot fail.
        let _ = match (source, answer) {
            (Source::Policy, Some(answer)) => {
                writeln!(self.text, "{tick},policy,v{:06},{}", answer.version, hex(&answer.sha256))
            }
            (Source::Default, _) => writeln!(self.text, "{tick},default,,"),
            _ => writeln!(self.text, "{tick},held,,"),
        };
        self.acted.append(self.text.as_bytes())
    }

    pub(super) fn shadow(&mut self, tick: u64, horizons: &[Horizon]) -> Result<(), RecordError> {
        match &mut self.shadow {
            Some(shadow) => shadow.tick(tick, horizons.iter().copied()),
            None => Ok(()),
        }
    }

    pub(super) fn finish(self) -> Result<(), RecordError> {
        self.acted.sync()?;
        self.shadow.map_or(Ok(()), HorizonsWriter::finish)
    }
}
