//! Waking by events of iceoryx2: between the coordinator and the policy server.

use super::{Alarm, Ipc, ServiceError, failed};
use crate::runtime_dir::RuntimeDir;
use iceoryx2::port::listener::{Listener, ListenerWaitError};
use iceoryx2::port::notifier::Notifier;
use iceoryx2::prelude::*;
use std::time::Duration;

/// Wakes who listens, by an event of iceoryx2.
#[derive(Debug)]
pub(super) struct EventNotifier {
    notifier: Notifier<Ipc>,
    place: RuntimeDir,
}

impl EventNotifier {
    pub(super) fn new(event: &Alarm, place: &RuntimeDir) -> Result<Self, ServiceError> {
        let notifier = event.notifier_builder().create();
        let notifier = notifier.map_err(|error| failed(place, "ring", event.name().as_str(), error))?;
        Ok(Self { notifier, place: place.clone() })
    }

    pub(super) fn ring(&self) -> Result<(), ServiceError> {
        self.notifier.notify().map(|_| ()).map_err(|error| failed(&self.place, "wake", "the others", error))
    }
}

/// Listens to such events.
#[derive(Debug)]
pub(super) struct EventListener {
    listener: Listener<Ipc>,
    place: RuntimeDir,
}

impl EventListener {
    pub(super) fn new(event: &Alarm, place: &RuntimeDir) -> Result<Self, ServiceError> {
        let listener = event.listener_builder().create();
        let listener = listener.map_err(|error| failed(place, "listen to", event.name().as_str(), error))?;
        Ok(Self { listener, place: place.clone() })
    }

    pub(super) fn wait(&self, limit: Duration) -> Result<(), ServiceError> {
        match self.listener.timed_wait(|_| {}, limit) {
            Ok(_) | Err(ListenerWaitError::InterruptSignal) => Ok(()),
            Err(error) => Err(failed(&self.place, "wait for", "the others", error)),
        }
    }
}
