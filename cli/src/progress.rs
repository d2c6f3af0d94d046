//! Progress on the terminal; nothing when standard error is not one. The only file that imports `indicatif`.

use evaluation::bench::Watch;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::cell::Cell;
use std::io::IsTerminal;
use std::time::Duration;

/// A line on standard error that is redrawn in place.
pub struct Progress(ProgressBar);

const STEPS: &str = "{bar:30} {pos}/{len} {msg}  {elapsed} (left {eta})";
const PARTS: &str = "{bar:30} {percent}% {msg}  {elapsed} (left {eta})";
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

/// How far a benchmark is: its parts, and what is left by what they were expected to take.
pub struct Parts {
    progress: Progress,
    /// Done so far, s.
    done: Cell<f64>,
}

impl Parts {
    /// Of a benchmark that is expected to take so long.
    pub fn expected(whole: Duration) -> Self {
        Self { progress: Progress::new(milliseconds(whole.as_secs_f64()), PARTS), done: Cell::new(0.0) }
    }

    /// Takes the line away.
    pub fn finish(&self) {
        self.progress.finish();
    }
}

/// The unit of the bar.
fn milliseconds(seconds: f64) -> u64 {
    (1e3 * seconds).round() as u64
}

impl Watch for Parts {
    fn part(&self, name: &'static str) {
        self.progress.say(name);
    }

    fn done(&self, seconds: f64) {
        self.done.set(self.done.get() + seconds);
        self.progress.0.set_position(milliseconds(self.done.get()));
    }
}
