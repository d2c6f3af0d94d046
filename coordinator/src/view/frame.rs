//! One moment of a run, and the slot in which the newest one waits for the views.

use crate::policy::Acting;
use std::sync::{Arc, Condvar, Mutex, PoisonError, TryLockError};
use std::time::Duration;
use vodca::explain::Explainer;

/// One moment of a run.
#[derive(Clone, Debug)]
pub struct Frame {
    /// k.
    pub tick: u64,
    /// What every robot did in this tick, and why.
    pub explainer: Explainer,
    /// How long the tick took.
    pub duration: Duration,
    /// Robots that have arrived.
    pub arrived: usize,
    /// Smallest separation so far, m; infinite when there is nothing to meet.
    pub min_separation: f64,
    /// Fallbacks so far, over all robots.
    pub fallbacks: u64,
    /// Who does not take part, since when and why, a sentence each.
    pub absent: Vec<String>,
    /// Who chose the horizons, in a run with a policy.
    pub acting: Option<Acting>,
}

/// Holds the newest frame.
#[derive(Debug, Default)]
pub(super) struct Slot {
    held: Mutex<Held>,
    changed: Condvar,
}

#[derive(Clone, Debug, Default)]
struct Held {
    frame: Option<Arc<Frame>>,
    number: u64,
    ended: bool,
}

/// What a view got from the slot.
#[derive(Clone, Debug)]
pub(super) enum News {
    /// A frame that it has not seen, and its number.
    Frame(Arc<Frame>, u64),
    /// Nothing new in the time it waited.
    Nothing,
    /// The run has ended and it has seen the last frame.
    Ended,
}

impl Slot {
    /// Puts `frame` in place of the older one, unless a view is reading just now: then gives it back.
    pub(super) fn offer(&self, frame: Frame) -> Option<Frame> {
        let mut held = match self.held.try_lock() {
            Ok(held) => held,
            Err(TryLockError::Poisoned(held)) => held.into_inner(),
            Err(TryLockError::WouldBlock) => return Some(frame),
        };
        held.frame = Some(Arc::new(frame));
        held.number += 1;
        self.changed.notify_all();
        None
    }

    /// No frame will come any more but this one, if any.
    pub(super) fn end(&self, frame: Option<Frame>) {
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(frame) = frame {
            held.frame = Some(Arc::new(frame));
            held.number += 1;
        }
        held.ended = true;
        self.changed.notify_all();
    }

    /// Waits up to `patience` for a frame other than number `seen`.
    pub(super) fn wait(&self, seen: u64, patience: Duration) -> News {
        let held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        let stale = |held: &mut Held| held.number == seen && !held.ended;
        let (held, _) = self.changed.wait_timeout_while(held, patience, stale).unwrap_or_else(PoisonError::into_inner);
        match &held.frame {
            Some(frame) if held.number != seen => News::Frame(frame.clone(), held.number),
            _ if held.ended => News::Ended,
            _ => News::Nothing,
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::policy::Source;
    use crate::record::samples;
    use vodca::layout::Layout;
    use vodca::params::Params;

    pub(in crate::view) fn sample(tick: u64) -> Frame {
        sample_of(2, tick)
    }

    pub(in crate::view) fn sample_of(robots: usize, tick: u64) -> Frame {
        let params = Params::safe();
        let layout = Layout::of(&samples::scenario(robots), &params.model);
        let mut explainer = Explainer::new(Arc::new(params), Arc::new(layout));
        explainer.observe(tick, &samples::steps(robots, tick));
        Frame {
            tick,
            explainer,
            duration: Duration::from_micros(420),
            arrived: 1,
            min_separation: 1.75,
            fallbacks: 3,
            absent: vec!["robot-1 lost at tick 3: it was ended by signal 9".into()],
            acting: Some(Acting { source: Source::Policy, version: 2, sha256: [0xab; 32] }),
        }
    }

    #[test]
    fn a_slow_reader_loses_frames_and_gets_the_newest_and_the_last() {
        let slot = Slot::default();
        assert!(matches!(slot.wait(0, Duration::ZERO), News::Nothing));
        (0..10).for_each(|tick| assert!(slot.offer(sample(tick)).is_none()));
        let News::Frame(frame, number) = slot.wait(0, Duration::ZERO) else { panic!("there is a frame") };
        assert_eq!(frame.tick, 9);
        assert!(matches!(slot.wait(number, Duration::ZERO), News::Nothing));
        slot.end(Some(sample(10)));
        let News::Frame(frame, number) = slot.wait(number, Duration::ZERO) else { panic!("there is a last frame") };
        assert_eq!(frame.tick, 10);
        assert!(matches!(slot.wait(number, Duration::ZERO), News::Ended));
    }

    #[test]
    fn the_run_does_not_wait_for_a_reader_that_holds_the_slot() {
        let slot = Slot::default();
        let reader = slot.held.lock().unwrap();
        assert_eq!(slot.offer(sample(4)).map(|frame| frame.tick), Some(4));
        drop(reader);
        assert!(slot.offer(sample(5)).is_none());
    }
}
