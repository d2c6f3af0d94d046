//! Why a map cannot be used.

use crate::check::ShapeProblem;
use std::path::PathBuf;

/// Why a map cannot be used: the file, the key, the value and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// A file of the map cannot be read.
    #[error("cannot read map file {}: {source}; the path of a map is relative to the scenario, that of its image to the map", .file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// Not YAML.
    #[error("{}: line {line}: {message}; a map is described by lines `key: value`", .file.display())]
    Yaml {
        /// The file.
        file: PathBuf,
        /// Counted from 1.
        line: usize,
        /// The YAML reader's reason.
        message: String,
    },
    /// A key that every map needs.
    #[error("{}: `{key}` is missing; allowed: {allowed}", .file.display())]
    Missing {
        /// The file.
        file: PathBuf,
        /// The key.
        key: &'static str,
        /// What it may be.
        allowed: &'static str,
    },
    /// A value that cannot be used.
    #[error("{}: {key} = {value} is not allowed; allowed: {allowed}", .file.display())]
    Value {
        /// The file.
        file: PathBuf,
        /// The key.
        key: &'static str,
        /// As written.
        value: String,
        /// What it may be.
        allowed: &'static str,
    },
    /// An image that cannot be read.
    #[error("map image {}: {message}; allowed: PGM (P2 or P5) and PNG with at most {} pixels", .file.display(), super::image::MOST_PIXELS)]
    Image {
        /// The file.
        file: PathBuf,
        /// What is wrong and where.
        message: String,
    },
    /// A region that cannot be cut into convex pieces.
    #[error("map image {}: {source}", .file.display())]
    Shape {
        /// The file.
        file: PathBuf,
        /// Why not.
        source: ShapeProblem,
    },
}
