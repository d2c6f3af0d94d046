//! `run.mcap`: the run as a film for Foxglove, Lichtblick and Rerun. The only file that imports `mcap`.
//!
//! Its messages are those of `scene_messages.rs`. Log time is `tick * sample_time` from 0 and nothing measured goes in, so two equal runs give equal bytes.
//! Chunks are written whole every 25 ticks (5 s): a log cut at any byte reads in stream order
//! up to its last whole chunk.

use super::folder::RecordError;
use super::{scene, scene_messages};
use mcap::records::MessageHeader;
use mcap::{Compression, McapError, WriteOptions, Writer};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::PathBuf;
use vodca::Position;
use vodca::params::Params;
use vodca::scenario::Scenario;
use vodca::step::Step;

/// Name of the file in a run folder.
pub const FILE: &str = "run.mcap";
/// Ticks per chunk: 5 s of the run, what a cut log loses at most.
const TICKS_PER_CHUNK: u64 = 25;

/// Writes the log tick by tick.
pub struct LogWriter {
    path: PathBuf,
    writer: Writer<File>,
    /// In the order of [`scene_messages::channels`].
    channels: Vec<u16>,
    sample_time: f64,
}

impl LogWriter {
    /// Starts the log: schemas, channels and the layout.
    pub fn create(path: PathBuf, scenario: &Scenario, params: &Params) -> Result<Self, RecordError> {
        let file = match File::create(&path) {
            Ok(file) => file,
            Err(source) => return Err(RecordError::Write { path, source }),
        };
        match Self::start(path.clone(), file, scenario, params) {
            Ok(log) => Ok(log),
            Err(error) => Err(record_error(path, error)),
        }
    }

    fn start(path: PathBuf, file: File, scenario: &Scenario, params: &Params) -> Result<Self, McapError> {
        let mut writer = WriteOptions::new()
            .compression(Some(Compression::Lz4))
            .chunk_size(None)
            .disable_seeking(true) // a chunk reaches the file whole or not at all
            .library(concat!("vodca ", env!("CARGO_PKG_VERSION")))
            .create(file)?;
        let mut channels = Vec::new();
        for scene_messages::Channel { topic, schema, schema_encoding, description, encoding } in
            scene_messages::channels()
        {
            let schema = writer.add_schema(schema, schema_encoding, &description)?;
            channels.push(writer.add_channel(schema, topic, encoding, &BTreeMap::new())?);
        }
        let mut log = Self { path, writer, channels, sample_time: params.model.sample_time };
        log.put(scene_messages::LAYOUT, 0, &scene_messages::layout(scenario, params))?;
        Ok(log)
    }

    /// Appends one tick.
    pub fn tick(&mut self, scenario: &Scenario, params: &Params, tick: u64, steps: &[Step]) -> Result<(), RecordError> {
        let mut messages = scene_messages::tick(scenario, params, tick, steps).into_iter();
        messages
            .try_for_each(|(channel, data)| self.put(channel, tick, &data))
            .and_then(|()| if (tick + 1).is_multiple_of(TICKS_PER_CHUNK) { self.writer.flush() } else { Ok(()) })
            .map_err(|error| record_error(self.path.clone(), error))
    }

    /// Writes the index; without it a log still reads in stream order.
    pub fn finish(mut self) -> Result<(), RecordError> {
        match self.writer.finish() {
            Ok(_) => Ok(()),
            Err(error) => Err(record_error(self.path.clone(), error)),
        }
    }

    fn put(&mut self, channel: usize, tick: u64, data: &[u8]) -> Result<(), McapError> {
        let log_time = scene_messages::nanoseconds(self.sample_time, tick);
        let header = MessageHeader {
            channel_id: self.channels[channel],
            sequence: tick as u32,
            log_time,
            publish_time: log_time,
        };
        self.writer.write_to_known_channel(&header, data)
    }
}

/// Reads the plans out of the log's `/scene`: `each(plans)` is called once per tick, in order, with every
/// robot's x^[0..=N|k], m. A log that was cut gives the ticks up to its last whole chunk; one that is no
/// log at all gives none.
pub fn read_plans(log: &[u8], mut each: impl FnMut(Vec<Vec<Position>>)) {
    let options = mcap::read::Options::IgnoreEndMagic.into();
    let Ok(stream) = mcap::read::MessageStream::new_with_options(log, options) else { return };
    for message in stream.map_while(Result::ok).filter(|message| message.channel.topic == "/scene") {
        each(scene::plans(&message.data));
    }
}

fn record_error(path: PathBuf, error: McapError) -> RecordError {
    match error {
        McapError::Io(source) => RecordError::Write { path, source },
        other => RecordError::Encode { path, what: "a log record", reason: other.to_string() },
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use super::*;
    use serde_json::json;

    fn record(path: PathBuf, ticks: u64) -> Vec<u8> {
        let (scenario, params) = (samples::scenario(3), Params::paper());
        let mut log = LogWriter::create(path.clone(), &scenario, &params).unwrap();
        for tick in 0..ticks {
            log.tick(&scenario, &params, tick, &samples::steps(3, tick)).unwrap();
        }
        log.finish().unwrap();
        std::fs::read(path).unwrap()
    }

    #[test]
    fn a_log_reads_back_with_time_from_zero() {
        let place = tempfile::tempdir().unwrap();
        let bytes = record(place.path().join(FILE), 60);
        let messages: Vec<_> = mcap::read::MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
        assert_eq!(messages.len(), 1 + 3 * 60);
        assert_eq!(messages[0].channel.topic, "/layout");
        assert_eq!(messages[0].log_time, 0);
        let last = messages.last().unwrap();
        assert_eq!((last.channel.topic.as_str(), last.log_time), ("/team", 59 * 200_000_000));
        let values: serde_json::Value = serde_json::from_slice(&last.data).unwrap();
        assert_eq!((&values["tick"], &values["robots"][2]["horizon"]), (&json!(59), &json!(3)));
    }

    #[test]
    fn plans_read_back_to_the_same_numbers() {
        let place = tempfile::tempdir().unwrap();
        let bytes = record(place.path().join(FILE), 30);
        let mut ticks = Vec::new();
        read_plans(&bytes, |plans| ticks.push(plans));
        assert_eq!(ticks.len(), 30);
        for (tick, plans) in ticks.iter().enumerate() {
            let steps = samples::steps(3, tick as u64);
            assert!(plans.iter().zip(&steps).all(|(plan, step)| plan == step.plan.states()) && plans.len() == 3);
        }
        read_plans(b"no log", |_| panic!("nothing to read"));
    }

    #[test]
    fn equal_runs_give_equal_bytes() {
        let place = tempfile::tempdir().unwrap();
        assert!(record(place.path().join("a"), 60) == record(place.path().join("b"), 60));
    }

    #[test]
    fn a_cut_log_reads_up_to_its_last_whole_chunk() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(FILE);
        let (scenario, params) = (samples::scenario(3), Params::paper());
        let mut log = LogWriter::create(path.clone(), &scenario, &params).unwrap();
        for tick in 0..60 {
            log.tick(&scenario, &params, tick, &samples::steps(3, tick)).unwrap();
        }
        let cut = std::fs::read(&path).unwrap(); // no finish(): as after a kill
        let options = mcap::read::Options::IgnoreEndMagic.into();
        let readable = |bytes: &[u8]| {
            let stream = mcap::read::MessageStream::new_with_options(bytes, options).unwrap();
            stream.take_while(Result::is_ok).count()
        };
        assert_eq!(readable(&cut), 1 + 3 * 50);
        assert_eq!(readable(&cut[..cut.len() * 3 / 4]), 1 + 3 * 25);
    }

    #[test]
    fn a_full_disk_is_one_clear_error() {
        let (scenario, params) = (samples::scenario(3), Params::paper());
        let outcome = LogWriter::create(PathBuf::from("/dev/full"), &scenario, &params)
            .and_then(|mut log| (0..200).try_for_each(|k| log.tick(&scenario, &params, k, &samples::steps(3, k))));
        let message = outcome.unwrap_err().to_string();
        assert!(message.contains("/dev/full"), "{message}");
    }
}
