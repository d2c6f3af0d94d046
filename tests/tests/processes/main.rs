//! Whole runs, one file per promise.

mod bench;
mod by_hand;
mod check_solver;
mod crash;
mod fence;
mod full_disk;
mod golden;
mod hang;
mod interrupt;
mod leftovers;
mod limits;
mod same_bytes;
mod slow_viewer;
mod two_runs;
