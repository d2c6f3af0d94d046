//! Teams in this process: comparisons, searches, checks and repetitions of recorded runs, reference
//! cases, benchmarks, figures and pages.

pub mod bench;
pub mod compare;
pub mod faults;
pub mod figures;
pub mod golden;
pub mod in_process;
pub mod page;
pub mod parallel;
pub mod range;
pub mod replay;
pub mod results;
mod roll;
#[cfg(test)]
pub(crate) mod samples;
pub mod search;
pub mod sentence;
pub mod text_table;
pub mod verify;
