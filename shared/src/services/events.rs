//! Waking by events of iceoryx2: between the coordinator and the policy server.

use super::{Alarm, Ipc, ServiceError, failed};
use crate::place::Place;
use iceoryx2::port::listener::{Listener, ListenerWaitError};
use iceoryx2::port::notifier::Notifier;
use iceoryx2::prelude::*;
use std::time::Duration;

/// Wakes who listens, by an event of iceoryx2.
#[derive(Debug)]
pub(super) struct Bell {
    notifier: Notifier<Ipc>,
    place: Place,
}

impl Bell {
    pub(super) fn new(bell: &Alarm, place: &Place) -> Result<Self, ServiceError> {
        let notifier = bell.notifier_builder().create();
        let notifier = notifier.map_err(|error| failed(place, "ring", bell.name().as_str(), error))?;
        Ok(Self { notifier, place: place.clone() })
    }

    pub(super) fn ring(&self) -> Result<(), ServiceError> {
        self.notifier.notify().map(|_| ()).map_err(|error| failed(&self.place, "wake", "the others", error))
    }
}

/// Listens to such events.
#[derive(Debug)]
pub(super) struct Ear {
    listener: Listener<Ipc>,
    place: Place,
}

impl Ear {
    pub(super) fn new(bell: &Alarm, place: &Place) -> Result<Self, ServiceError> {
        let listener = bell.listener_builder().create();
        let listener = listener.map_err(|error| failed(place, "listen to", bell.name().as_str(), error))?;
        Ok(Self { listener, place: place.clone() })
    }

    pub(super) fn wait(&self, limit: Duration) -> Result<(), ServiceError> {
        match self.listener.timed_wait(|_| {}, limit) {
            Ok(_) | Err(ListenerWaitError::InterruptSignal) => Ok(()),
            Err(error) => Err(failed(&self.place, "wait for", "the others", error)),
        }
    }
}
