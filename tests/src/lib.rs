//! Helpers for tests of whole runs.
