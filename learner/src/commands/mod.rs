//! One command per file.

pub(crate) mod bench;
pub(crate) mod learn;
pub(crate) mod settings;
