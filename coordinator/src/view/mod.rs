//! Views of a run while it goes on: in the terminal, in a browser, in Foxglove.
//!
//! *Invariant*: a view never holds the run up. The run leaves its newest frame in a slot, at most twenty
//! times a second and only if no reader has the slot just then; views take frames out at their own pace.

mod browser;
#[cfg_attr(not(feature = "foxglove"), path = "foxglove_absent.rs")]
mod foxglove;
mod frame;
mod terminal;
mod viewers;

use crate::horizons::RunHorizons;
use crate::record::RecordError;
use crate::run::RunTick;
use crate::summary::Absence;
use crate::team::ProcessTeam;
use crate::tick_parts::TickTimes;
use browser::BrowserView;
use foxglove::FoxgloveView;
pub use frame::Frame;
use frame::Slot;
use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::time::{Duration, Instant};
use terminal::TerminalView;
use vodca::explain::Explainer;
use vodca::layout::Layout;
use vodca::params::Params;
use vodca::play::{Observer, Tick, Verdict};
use vodca::scenario::Scenario;
use vodca::step::{Status, Step};

/// Time between two frames: no eye sees more, and the run pays for none beyond.
const FRAME_TIME: Duration = Duration::from_millis(50);

/// Which views are wanted.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// In this terminal.
    pub terminal: bool,
    /// In a browser, from this port of the loopback interface; 0: any free one.
    pub browser: Option<u16>,
    /// In Foxglove or Lichtblick, from this port of the loopback interface; 0: any free one.
    pub foxglove: Option<u16>,
    /// Where the horizons come from, to be shown.
    pub horizons: String,
}

/// Why a view cannot be shown.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// Nothing to draw on.
    #[error("--tui needs a terminal and standard output is none; leave it out, or use --live and a browser")]
    NoTerminal,
    /// The terminal refused.
    #[error("cannot draw in this terminal: {0}; leave --tui out, or use --live and a browser")]
    Terminal(#[source] io::Error),
    /// The port is taken or not ours.
    #[error("cannot serve on 127.0.0.1:{port}: {reason}; give another port, or none for any free one")]
    Port {
        /// The port asked for.
        port: u16,
        /// What the system said.
        reason: String,
    },
    /// Built without it.
    #[error("this build has no Foxglove view; `./run.sh` builds it when --foxglove is given (`--features foxglove`)")]
    #[cfg_attr(feature = "foxglove", allow(dead_code))] // the other build says it
    NoFoxglove,
}

/// The views of one run.
pub struct Views {
    slot: Arc<Slot>,
    terminal: Option<TerminalView>,
    browser: Option<BrowserView>,
    foxglove: Option<FoxgloveView>,
    explainer: Explainer,
    scenario: Scenario,
    fallbacks: u64,
    next: Instant,
    last: Option<Frame>,
}

impl Views {
    /// Opens what is wanted; [`Self::addresses`] says where it can be seen.
    pub fn open(wanted: Wanted, scenario: &Scenario, params: &Params) -> Result<Self, ViewError> {
        let slot = Arc::new(Slot::default());
        let browser = match wanted.browser {
            Some(port) => Some(BrowserView::open(port, slot.clone(), scenario, params, &wanted.horizons)?),
            None => None,
        };
        let foxglove = match wanted.foxglove {
            Some(port) => Some(FoxgloveView::open(port, slot.clone(), scenario, params)?),
            None => None,
        };
        let terminal = match wanted.terminal {
            true if !io::stdout().is_terminal() => return Err(ViewError::NoTerminal),
            true => Some(TerminalView::open(slot.clone(), scenario, params, &wanted.horizons)?),
            false => None,
        };
        Ok(Self {
            slot,
            terminal,
            browser,
            foxglove,
            explainer: Explainer::new(Arc::new(params.clone()), Arc::new(Layout::of(scenario, &params.model))),
            scenario: scenario.clone(),
            fallbacks: 0,
            next: Instant::now(),
            last: None,
        })
    }

    /// Takes in a tick.
    fn show(&mut self, seen: &RunTick<'_>) {
        if self.terminal.is_none() && self.browser.is_none() && self.foxglove.is_none() {
            return;
        }
        let Tick { tick, steps, metrics, .. } = *seen;
        let fell_back = |step: &&Step| matches!(step.status, Status::Shifted | Status::Stopped);
        self.fallbacks += steps.iter().filter(fell_back).count() as u64;
        self.explainer.observe(tick, steps);
        if Instant::now() >= self.next || metrics.settled() {
            self.next = Instant::now() + FRAME_TIME;
            let frame = Frame {
                tick,
                explainer: self.explainer.clone(),
                duration: Duration::from_nanos(TickTimes::from(seen.team).duration_ns),
                arrived: metrics.arrived(),
                min_separation: metrics.min_separation(),
                fallbacks: self.fallbacks,
                absent: absent(seen, &self.scenario),
                acting: seen.horizons.acting(),
            };
            self.last = self.slot.offer(frame);
        }
    }

    /// Where a browser and Foxglove find the run: what it is called, and its address.
    pub fn addresses(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let browser = self.browser.as_ref().map(|view| ("live view", view.address()));
        browser.into_iter().chain(self.foxglove.as_ref().map(|view| ("foxglove", view.address())))
    }

    /// The run has ended: shows the last frame and gives the terminal back.
    pub fn close(&mut self) {
        self.slot.end(self.last.take());
        self.terminal = None;
        if let Some(browser) = self.browser.take() {
            browser.close();
        }
        if let Some(foxglove) = self.foxglove.take() {
            foxglove.close();
        }
    }
}

/// Who does not take part now.
fn absent(seen: &RunTick<'_>, scenario: &Scenario) -> Vec<String> {
    let all = Absence::all(seen.team.members().changes(), scenario);
    all.iter().filter(|absence| absence.until.is_none()).map(Absence::to_string).collect()
}

impl Observer<ProcessTeam, RunHorizons> for Views {
    type Error = RecordError;

    fn tick(&mut self, seen: &RunTick<'_>) -> Result<Verdict, RecordError> {
        self.show(seen);
        Ok(Verdict::Continue)
    }
}
