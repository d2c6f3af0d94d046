//! Thin typed ports: what a process says and hears.

use super::{Channel, Ipc, ReportListener, ReportNotifier, ServiceError, TickListener, TickNotifier, failed};
use crate::messages::{Announcement, Plan, Report};
use crate::runtime_dir::RuntimeDir;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::port::update_connections::UpdateConnections;
use iceoryx2::prelude::*;
use iceoryx2::sample::Sample;
use std::fmt::Debug;
use std::time::Duration;

/// Publishes one type.
#[derive(Debug)]
pub struct Sender<Payload: Debug + ZeroCopySend + 'static> {
    publisher: Publisher<Ipc, Payload, ()>,
    place: RuntimeDir,
}

impl<Payload: Debug + ZeroCopySend + Copy + 'static> Sender<Payload> {
    pub(super) fn new(service: &Channel<Payload>, place: &RuntimeDir) -> Result<Self, ServiceError> {
        let publisher = service.publisher_builder().create();
        let publisher = publisher.map_err(|error| failed(place, "publish on", service.name().as_str(), error))?;
        Ok(Self { publisher, place: place.clone() })
    }

    /// Connects to every reader there is now; sending does that as well.
    pub fn connect(&self) -> Result<(), ServiceError> {
        self.publisher.update_connections().map_err(|error| failed(&self.place, "connect", "to the others", error))
    }

    /// Hands `payload` to every reader; a reader that has two unread ones loses the older.
    pub fn send(&self, payload: Payload) -> Result<(), ServiceError> {
        let sent = self.publisher.loan_uninit().map(|sample| sample.write_payload(payload).send());
        match sent {
            Ok(Ok(_)) => Ok(()),
            Ok(Err(error)) => Err(failed(&self.place, "send", "a payload", error)),
            Err(error) => Err(failed(&self.place, "loan", "a payload", error)),
        }
    }
}

/// Reads one type.
#[derive(Debug)]
pub struct Receiver<Payload: Debug + ZeroCopySend + 'static> {
    subscriber: Subscriber<Ipc, Payload, ()>,
    place: RuntimeDir,
}

impl<Payload: Debug + ZeroCopySend + Copy + 'static> Receiver<Payload> {
    pub(super) fn new(service: &Channel<Payload>, place: &RuntimeDir) -> Result<Self, ServiceError> {
        let subscriber = service.subscriber_builder().create();
        let subscriber = subscriber.map_err(|error| failed(place, "subscribe to", service.name().as_str(), error))?;
        Ok(Self { subscriber, place: place.clone() })
    }

    /// The next unread payload, in place; `None`: nothing there.
    pub fn receive(&self) -> Result<Option<Sample<Ipc, Payload, ()>>, ServiceError> {
        self.subscriber.receive().map_err(|error| failed(&self.place, "receive", "a payload", error))
    }
}

/// Publishes announcements and wakes whoever waits for them.
#[derive(Debug)]
pub struct Announcer {
    pub(super) publisher: Publisher<Ipc, [Plan], Announcement>,
    pub(super) notifier: TickNotifier,
    pub(super) place: RuntimeDir,
}

impl Announcer {
    /// Publishes `announcement` with `plans`, then wakes every robot.
    pub fn announce(&self, announcement: &Announcement, plans: &[Plan]) -> Result<(), ServiceError> {
        // A slice of none is not a payload: there is always one, and `plans` says how many count.
        let mut sample = (self.publisher.loan_slice_uninit(plans.len().max(1)))
            .map_err(|error| failed(&self.place, "loan", "an announcement", error))?;
        *sample.user_header_mut() = *announcement;
        let sample =
            if plans.is_empty() { sample.write_from_fn(|_| Plan::EMPTY) } else { sample.write_from_slice(plans) };
        sample.send().map_err(|error| failed(&self.place, "send", "an announcement", error))?;
        self.notifier.ring();
        Ok(())
    }
}

/// Receives announcements.
#[derive(Debug)]
pub struct Announcements {
    pub(super) subscriber: Subscriber<Ipc, [Plan], Announcement>,
    pub(super) listener: TickListener,
    pub(super) place: RuntimeDir,
}

impl Announcements {
    /// The next unread announcement handed to `read` with its plans; `None`: nothing there.
    pub fn receive<T>(&self, read: impl FnOnce(&Announcement, &[Plan]) -> T) -> Result<Option<T>, ServiceError> {
        self.listener.look();
        let sample =
            self.subscriber.receive().map_err(|error| failed(&self.place, "receive", "an announcement", error))?;
        Ok(sample.map(|sample| {
            let announcement = sample.user_header();
            let count = (announcement.plans as usize).min(sample.payload().len());
            read(announcement, &sample.payload()[..count])
        }))
    }

    /// Waits until something was announced since the last [`Self::receive`], a signal came, or `limit` has
    /// passed.
    pub fn wait(&self, limit: Duration) {
        self.listener.wait(limit);
    }
}

/// Publishes reports and wakes the coordinator.
#[derive(Debug)]
pub struct Reporter {
    pub(super) sender: Sender<Report>,
    pub(super) notifier: ReportNotifier,
}

impl Reporter {
    /// Publishes `report`, then wakes the coordinator.
    pub fn report(&self, report: Report) -> Result<(), ServiceError> {
        self.sender.send(report)?;
        self.notifier.ring();
        Ok(())
    }
}

/// Receives reports.
#[derive(Debug)]
pub struct Reports {
    pub(super) receiver: Receiver<Report>,
    pub(super) listener: ReportListener,
}

impl Reports {
    /// The next unread report, in place; `None`: nothing there.
    pub fn receive(&self) -> Result<Option<Sample<Ipc, Report, ()>>, ServiceError> {
        self.receiver.receive()
    }

    /// Takes note of what was reported so far: what [`Self::wait`] waits for comes after it.
    pub fn look(&self) {
        self.listener.look();
    }

    /// Nobody need wake this process before `reports` more were sent: it will be busy, or wait.
    pub fn expect(&self, reports: usize) {
        self.listener.expect(reports);
    }

    /// Waits until `reports` more were sent since the last [`Self::look`], a signal came, or `limit` has
    /// passed.
    pub fn wait(&self, reports: usize, limit: Duration) {
        self.listener.wait(reports, limit);
    }
}
