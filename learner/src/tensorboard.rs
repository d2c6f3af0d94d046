//! Curves as TensorBoard reads them: an event file of scalars. The only file of this crate that imports
//! `crc32c` and `prost`.
//!
//! The file is a list of records (TFRecord): length as u64, its checksum, the bytes, their checksum,
//! all little-endian. Each record is an `Event` of `event.proto`.

use prost::Message;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// The curves cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write curves to {}: {source}; is the place writable, and is there space left?", path.display())]
pub struct CurvesError {
    path: PathBuf,
    source: io::Error,
}

/// One record: the version of the file, or a summary.
#[derive(Clone, PartialEq, Message)]
struct Event {
    /// s since 1970.
    #[prost(double, tag = "1")]
    wall_time: f64,
    #[prost(int64, optional, tag = "2")]
    step: Option<i64>,
    #[prost(string, optional, tag = "3")]
    file_version: Option<String>,
    #[prost(message, optional, tag = "5")]
    summary: Option<Summary>,
}

/// All scalars of a step.
#[derive(Clone, PartialEq, Message)]
struct Summary {
    #[prost(message, repeated, tag = "1")]
    value: Vec<Scalar>,
}

/// A `Summary.Value`.
#[derive(Clone, PartialEq, Message)]
struct Scalar {
    #[prost(string, tag = "1")]
    tag: String,
    #[prost(float, optional, tag = "2")]
    simple_value: Option<f32>,
}

/// An open event file.
#[derive(Debug)]
pub struct Curves {
    file: File,
    path: PathBuf,
}

impl Curves {
    /// A new event file in `folder`, which is made when it is not there. A resumed training writes a
    /// second file beside the first; TensorBoard joins them.
    pub fn create(folder: &Path) -> Result<Self, CurvesError> {
        let failed = |source| CurvesError { path: folder.to_owned(), source };
        std::fs::create_dir_all(folder).map_err(failed)?;
        let time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let name = format!("events.out.tfevents.{:010}.{:09}.vodca", time.as_secs(), time.subsec_nanos());
        let path = folder.join(name);
        let file = File::create_new(&path).map_err(failed)?;
        let mut curves = Self { file, path };
        let version = Some("brain.Event:2".into());
        let wall_time = time.as_secs_f64();
        curves.record(&Event { wall_time, step: Some(0), file_version: version, summary: None })?;
        Ok(curves)
    }

    /// Writes `scalars` (tag and value) at `step`. Values that are not finite are left out.
    pub fn scalars(&mut self, step: u64, scalars: &[(&str, f64)]) -> Result<(), CurvesError> {
        let wall_time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64();
        let finite = scalars.iter().filter(|(_, value)| value.is_finite());
        let scalar = |&(tag, value): &(&str, f64)| Scalar { tag: tag.into(), simple_value: Some(value as f32) };
        let summary = Some(Summary { value: finite.map(scalar).collect() });
        self.record(&Event { wall_time, step: Some(step as i64), file_version: None, summary })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn record(&mut self, event: &Event) -> Result<(), CurvesError> {
        // In one write: a crash leaves whole records.
        let written = self.file.write_all(&framed(&event.encode_to_vec()));
        written.map_err(|source| CurvesError { path: self.path.clone(), source })
    }
}

/// One record around `bytes`.
fn framed(bytes: &[u8]) -> Vec<u8> {
    let length = (bytes.len() as u64).to_le_bytes();
    let parts = [&length[..], &masked(&length).to_le_bytes(), bytes, &masked(bytes).to_le_bytes()];
    parts.concat()
}

/// TFRecord's checksum: CRC-32C, rotated and moved so that checksums of checksums differ.
fn masked(bytes: &[u8]) -> u32 {
    crc32c::crc32c(bytes).rotate_right(15).wrapping_add(0xa282_ead8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    #[test]
    fn a_record_is_framed_as_tfrecord_says() {
        // CRC-32C of "123456789" is 0xe3069283.
        assert_eq!(masked(b"123456789"), 0xe306_9283u32.rotate_right(15).wrapping_add(0xa282_ead8));
        let record = framed(b"abc");
        assert_eq!((record.len(), &record[..8], &record[12..15]), (19, &3u64.to_le_bytes()[..], &b"abc"[..]));
    }

    #[test]
    fn what_is_not_finite_leaves_no_point() {
        let place = tempfile::tempdir().unwrap();
        let mut curves = Curves::create(place.path()).unwrap();
        curves.scalars(7, &[("a", 1.5), ("b", f64::NAN), ("c", f64::INFINITY)]).unwrap();
        let bytes = std::fs::read(curves.path()).unwrap();
        let first = 16 + u64::from_le_bytes(bytes[..8].try_into().unwrap()) as usize;
        let event = Event::decode(&bytes[first + 12..bytes.len() - 4]).unwrap();
        assert_eq!(event.step, Some(7));
        assert_eq!(event.summary.unwrap().value, [Scalar { tag: "a".into(), simple_value: Some(1.5) }]);
    }

    #[test]
    fn tensorboard_reads_the_curves() {
        let place = tempfile::tempdir().unwrap();
        let mut curves = Curves::create(place.path()).unwrap();
        for step in 0..20u64 {
            curves.scalars(step * 100, &[("loss/critic", 1.0 / (step + 1) as f64), ("alpha", step as f64)]).unwrap();
        }
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/read_curves.py");
        let output = Command::new("python3").arg(script).arg(place.path()).output();
        let Ok(output) = output else { return eprintln!("skipped: there is no python3") };
        let said = String::from_utf8_lossy(&output.stdout);
        if said.starts_with("skipped") {
            return eprintln!("{said}");
        }
        assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(said.trim(), "20 points of loss/critic, the last at 1900: 0.05");
    }
}
