//! The models that act: the current one, the previous one for a rollback, and the switch between
//! two ticks. Never waits, never loads, never touches the disk: [`crate::loader`] does, in its thread.

use crate::actor::{Actor, Answer};
use crate::sample::{Choice, choose};
use policy::folder::{Serving, Version};
use std::mem;
use std::sync::mpsc::{Receiver, Sender, channel};
use vodca::Position;
use vodca::horizon::Horizon;

/// A model that is loaded, warm and checked.
pub struct Loaded {
    /// The model.
    pub actor: Actor,
    /// Its version in the watched folder.
    pub version: Version,
    /// SHA-256 of its file.
    pub sha256: String,
    /// First tick it answered.
    pub since_tick: Option<u64>,
}

/// What the loader asks for.
pub enum Order {
    /// Let this model act from the next tick on.
    Switch(Box<Loaded>),
    /// Let the previous model act again, under this version: its bytes are the same.
    Rollback {
        /// The version that was asked for.
        version: Version,
        /// SHA-256 of the model that is meant.
        sha256: String,
    },
}

/// What happened, for the loader to write down. Models come back with it, so that the serving thread
/// never spends time on freeing one.
pub enum Event {
    /// Another model acts from `tick` on.
    Switched {
        /// First tick.
        tick: u64,
        /// What acts.
        serving: Serving,
        /// What acted.
        previous: Option<Serving>,
        /// What is no longer needed.
        retired: Option<Box<Loaded>>,
    },
    /// A rollback was ordered to a model that is not there any more.
    Gone,
    /// The current model answered with numbers that are not finite, or not at all.
    Failed {
        /// At which tick.
        tick: u64,
        /// Which model.
        failed: Serving,
        /// What acts instead; `None`: nothing is left.
        serving: Option<Serving>,
        /// Why.
        reason: String,
    },
}

/// What a model chose for a robot: its action in [-1, 1] and the horizon made of it.
pub type Chosen = (f64, Horizon);

/// The models that act. Lives in the serving thread.
pub struct HotSwap {
    current: Option<Box<Loaded>>,
    previous: Option<Box<Loaded>>,
    orders: Receiver<Order>,
    events: Sender<Event>,
    answer: Answer,
    input: Vec<f32>,
}

impl Loaded {
    /// As STATUS.json tells it.
    pub fn serving(&self) -> Serving {
        Serving {
            version: self.version.to_string(),
            name: self.actor.contract().name.clone(),
            sha256: self.sha256.clone(),
            since_tick: self.since_tick,
        }
    }
}

impl HotSwap {
    /// Nothing acts before the first [`Order::Switch`].
    pub fn new(robots: usize, orders: Receiver<Order>, events: Sender<Event>) -> Self {
        let answer = Answer { mean: Vec::with_capacity(robots), log_std: Vec::with_capacity(robots) };
        Self { current: None, previous: None, orders, events, answer, input: vec![0.0; 2 * robots] }
    }

    /// One model for good, without a loader: a shadow.
    pub fn always(robots: usize, model: Loaded) -> Self {
        // Both far ends are gone at once: no orders come, no answers are read.
        let (orders, events) = (channel().1, channel().0);
        Self { current: Some(Box::new(model)), ..Self::new(robots, orders, events) }
    }

    /// What acts.
    pub fn current(&self) -> Option<&Loaded> {
        self.current.as_deref()
    }

    /// Carries out the orders that have come. Call it between two ticks; `tick` is the next one.
    pub fn between_ticks(&mut self, tick: u64) {
        while let Ok(order) = self.orders.try_recv() {
            let retired = match order {
                Order::Switch(new) => {
                    let old = self.current.replace(new);
                    mem::replace(&mut self.previous, old)
                }
                Order::Rollback { version, sha256 } => {
                    let is = |model: &Option<Box<Loaded>>| model.as_ref().is_some_and(|model| model.sha256 == sha256);
                    // A model that failed meanwhile may have put the wanted one in its place already.
                    if is(&self.previous) {
                        mem::swap(&mut self.current, &mut self.previous);
                    } else if !is(&self.current) {
                        self.tell(Event::Gone);
                        continue;
                    }
                    if let Some(current) = &mut self.current {
                        current.version = version;
                    }
                    None
                }
            };
            if let Some(current) = &mut self.current {
                current.since_tick = Some(tick);
                let (serving, previous) = (current.serving(), self.previous.as_deref().map(Loaded::serving));
                self.tell(Event::Switched { tick, serving, previous, retired });
            }
        }
    }

    /// Chooses the horizon of every robot; `false` when there is no model that can. A model that
    /// fails makes room for the previous one at once, and that one answers this very tick.
    pub fn choose(&mut self, tick: u64, positions: &[Position], choice: Choice, chosen: &mut Vec<Chosen>) -> bool {
        while let Some(mut acting) = self.current.take() {
            match self.ask(&mut acting, tick, positions, choice, chosen) {
                Ok(()) => {
                    self.current = Some(acting);
                    return true;
                }
                Err(reason) => {
                    self.current = self.previous.take();
                    if let Some(current) = &mut self.current {
                        current.since_tick = Some(tick);
                    }
                    let serving = self.current.as_deref().map(Loaded::serving);
                    self.tell(Event::Failed { tick, failed: acting.serving(), serving, reason });
                }
            }
        }
        false
    }

    fn ask(
        &mut self,
        acting: &mut Loaded,
        tick: u64,
        positions: &[Position],
        choice: Choice,
        chosen: &mut Vec<Chosen>,
    ) -> Result<(), String> {
        acting.actor.contract().normalise(positions, &mut self.input);
        acting.actor.infer(&self.input, &mut self.answer).map_err(|error| error.to_string())?;
        chosen.clear();
        for robot in 0..positions.len() {
            let Some(one) = choose(acting.actor.contract(), &self.answer, choice, robot, tick) else {
                return Err(format!("its answer for robot {robot} is not a finite number"));
            };
            chosen.push(one);
        }
        Ok(())
    }

    fn tell(&self, event: Event) {
        // A loader that has ended writes nothing down any more; acting goes on.
        let _ = self.events.send(event);
    }
}
