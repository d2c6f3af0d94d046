//! Progress on the terminal; nothing when standard error is not one. The only file that imports `indicatif`.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;

/// A line on standard error that is redrawn in place.
pub struct Progress(ProgressBar);

impl Progress {
    /// For `updates` updates, of which `done` are done.
    pub fn new(updates: u64, done: u64) -> Self {
        let visible = std::io::stderr().is_terminal();
        let target = if visible { ProgressDrawTarget::stderr_with_hz(10) } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(updates), target);
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} updates {msg}  {elapsed} (left {eta})") {
            bar.set_style(style);
        }
        bar.set_position(done);
        bar.reset_eta();
        Self(bar)
    }

    /// `done` updates are done, at `speed` updates per second with this `loss` of the critics.
    pub fn show(&self, done: u64, speed: f64, loss: f64) {
        self.0.set_position(done);
        self.0.set_message(format!("{speed:.0}/s  critic loss {loss:.4}"));
    }

    /// Takes the line away.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
