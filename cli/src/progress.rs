//! Progress on the terminal; nothing when standard error is not one. The only file that imports `indicatif`.

use evaluation::bench::Watch;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::cell::RefCell;
use std::io::IsTerminal;

/// A line on standard error that is redrawn in place.
pub struct Progress(ProgressBar);

const STEPS: &str = "{bar:30} {pos}/{len} {msg}  {elapsed} (left {eta})";
const TICKS: &str = "tick {pos} of at most {len}  {msg}";

impl Progress {
    /// For `length` pieces of work.
    pub fn of_work(length: usize) -> Self {
        Self::new(length as u64, STEPS)
    }

    /// For a run of at most `max_ticks`.
    pub fn of_run(max_ticks: u64) -> Self {
        Self::new(max_ticks, TICKS)
    }

    /// Shows nothing.
    pub fn hidden() -> Self {
        Self(ProgressBar::hidden())
    }

    fn new(length: u64, template: &str) -> Self {
        // `stderr_with_hz` draws at most ten times a second.
        let visible = std::io::stderr().is_terminal();
        let target = if visible { ProgressDrawTarget::stderr_with_hz(10) } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(length), target);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self(bar)
    }

    /// What the pieces are.
    pub fn say(&self, what: &'static str) {
        self.0.set_message(what);
    }

    /// One piece of work is done.
    pub fn advance(&self) {
        self.0.inc(1);
    }

    /// `ticks` are done, `arrived` of `robots` have arrived, and nobody was nearer than `min_separation`
    /// (m, infinite when there is nothing to meet).
    pub fn tick(&self, ticks: u64, arrived: usize, robots: usize, min_separation: f64) {
        if self.0.is_hidden() {
            return;
        }
        let nearest =
            if min_separation.is_finite() { format!("  min separation {min_separation:.3} m") } else { String::new() };
        self.0.set_message(format!("arrived {arrived}/{robots}{nearest}"));
        self.0.set_position(ticks);
    }

    /// Takes the line away.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

/// Shows the parts of a benchmark one after the other.
pub struct Parts(RefCell<Progress>);

impl Parts {
    /// Nothing to show yet.
    pub fn new() -> Self {
        Self(RefCell::new(Progress::hidden()))
    }

    /// Takes the line away.
    pub fn finish(&self) {
        self.0.borrow().finish();
    }
}

impl Default for Parts {
    fn default() -> Self {
        Self::new()
    }
}

impl Watch for Parts {
    fn part(&self, name: &'static str, steps: usize) {
        self.finish();
        let progress = Progress::of_work(steps);
        progress.say(name);
        self.0.replace(progress);
    }

    fn step(&self) {
        self.0.borrow().advance();
    }
}
