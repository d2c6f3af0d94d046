//! The only place that knows iceoryx2 (beside the derive on `messages.rs`): names, types and limits of
//! every service, and thin typed ports.
//!
//! A run has its own prefix (of shared-memory files) and its own short root folder (of sockets, whose
//! paths must stay below 108 bytes), see [`crate::runtime_dir`]; two runs can therefore not meet.
//! *Invariant*: the coordinator creates every service before a robot starts; robots only open. A
//! service whose creator died half-way never heals, only deleting the run's files helps.

use crate::messages::{Announcement, Plan, Report};
use crate::runtime_dir::RuntimeDir;
use iceoryx2::prelude::*;
use iceoryx2::service::builder::event::EventOpenError;
use iceoryx2::service::builder::publish_subscribe::PublishSubscribeOpenError as OpenError;
use iceoryx2::service::port_factory::{event, publish_subscribe};
use std::fmt::Debug;
use std::sync::Arc;
use std::time::{Duration, Instant};

mod events;
mod policy;
mod ports;
mod wake;

pub use policy::{PolicyAsker, PolicyPort};
pub use ports::{Announcements, Announcer, Receiver, Reporter, Reports, Sender};

use events::{EventListener, EventNotifier};
use wake::{ReportListener, ReportNotifier, TickListener, TickNotifier, WakePage};

type Ipc = ipc::Service;
type Channel<Payload, Header = ()> = publish_subscribe::PortFactory<Ipc, Payload, Header>;
type Alarm = event::PortFactory<Ipc>;
/// A robot's ports to the other robots.
pub type PlanPorts = (Sender<Plan>, Receiver<Plan>);

/// Ports beyond the team's own that a service has room for: observers are refused at the exact number.
const HEAD_ROOM: usize = 8;
/// Samples a reader can hold and a queue can keep: the tick that is read and the next one.
const DEPTH: usize = 2;
/// How long a robot tries to open a service that the coordinator is still making.
const OPEN_PATIENCE: Duration = Duration::from_secs(5);

/// Something of the exchange could not be made, opened or used.
#[derive(Debug, thiserror::Error)]
#[error("cannot {what}: {reason}; the run's files are under {place}: has the run ended, or is /dev/shm full?")]
pub struct ServiceError {
    /// What was attempted.
    pub what: String,
    /// What iceoryx2 or the system said.
    pub reason: String,
    /// Where this run's files are.
    pub place: String,
}

fn failed(place: &RuntimeDir, what: &str, which: &str, reason: impl Debug) -> ServiceError {
    ServiceError {
        what: format!("{what} {which}"),
        reason: format!("iceoryx2 says {reason:?}"),
        place: place.to_string(),
    }
}

/// Makes iceoryx2 install its signal handlers now rather than at the first need, so that ours can go
/// on top of them (see `stop.rs`), and keeps its log quiet: what matters is reported by our errors.
pub fn settle_signal_handlers() {
    set_log_level(LogLevel::Fatal);
    let _ = iceoryx2_bb_posix::signal::SignalHandler::last_signal();
}

/// The iceoryx2 configuration of a run.
fn config(place: &RuntimeDir) -> Result<Config, ServiceError> {
    let mut config = Config::default();
    config.global.prefix = FileName::new(place.prefix.as_bytes())
        .map_err(|error| failed(place, "use the prefix", &place.prefix, error))?;
    let root = Path::new(place.root.as_bytes()).map_err(|error| failed(place, "use the folder", &place.root, error))?;
    config.global.set_root_path(&root);
    // Each of these scans all of /dev/shm: at 50 robots 4.5 s of start instead of 0.8 s. Whoever ends
    // the run deletes all of its files instead.
    config.global.service.cleanup_dead_nodes_on_open = false;
    config.global.node.cleanup_dead_nodes_on_creation = false;
    config.global.node.cleanup_dead_nodes_on_destruction = false;
    Ok(config)
}

/// The same as text of an `iceoryx2.toml`, with which `iox2` and other bindings can look into the run.
pub fn config_text(place: &RuntimeDir) -> Result<String, ServiceError> {
    toml::to_string(&config(place)?).map_err(|error| failed(place, "write", "iceoryx2.toml", error))
}

/// All services of a run, as one process sees them.
#[derive(Debug)]
pub struct Services {
    place: RuntimeDir,
    announcements: Channel<[Plan], Announcement>,
    reports: Channel<Report>,
    plans: Option<Channel<Plan>>,
    wake: Arc<WakePage>,
    node: Node<Ipc>,
}

/// Whether services are made or opened.
#[derive(Clone, Copy)]
enum Role {
    Create,
    Open,
}

impl Services {
    /// Makes every service of a run of `robots` robots; `peer`: also the one on which robots hear each other.
    pub fn create(place: &RuntimeDir, robots: usize, peer: bool) -> Result<Self, ServiceError> {
        Self::new(place, robots, peer, Role::Create)
    }

    /// Opens them.
    pub fn open(place: &RuntimeDir, robots: usize, peer: bool) -> Result<Self, ServiceError> {
        Self::new(place, robots, peer, Role::Open)
    }

    fn new(place: &RuntimeDir, robots: usize, peer: bool, role: Role) -> Result<Self, ServiceError> {
        let maker = Maker::new(place, robots, role)?;
        Ok(Self {
            announcements: maker.announcements("vodca/announcements")?,
            reports: maker.channel("vodca/reports", maker.everyone, maker.few)?,
            plans: if peer { Some(maker.channel("vodca/plans", maker.everyone, maker.everyone)?) } else { None },
            wake: Arc::new(WakePage::new(place, robots, role)?),
            node: maker.node,
            place: place.clone(),
        })
    }

    /// A life for this process as robot `robot`, from 1: no two processes get the same.
    pub fn next_life(&self, robot: usize) -> u32 {
        self.wake.next_life(robot)
    }

    /// Frees what processes held that were killed: their ports would take up the room of those who come after them.
    /// What cannot be freed now is tried again with the next call.
    pub fn clean_up_after_dead(&self) {
        let _ = self.node.try_cleanup_dead_nodes();
    }

    /// The coordinator's voice. `frame`: most plans an announcement carries.
    pub fn announcer(&self, frame: usize) -> Result<Announcer, ServiceError> {
        let publisher = self.announcements.publisher_builder().initial_max_slice_len(frame.max(1)).create();
        Ok(Announcer {
            publisher: publisher.map_err(|error| failed(&self.place, "publish on", "vodca/announcements", error))?,
            notifier: TickNotifier::new(&self.wake),
            place: self.place.clone(),
        })
    }

    /// A robot's listener for the coordinator.
    pub fn announcements(&self) -> Result<Announcements, ServiceError> {
        let subscriber = self.announcements.subscriber_builder().create();
        Ok(Announcements {
            subscriber: subscriber
                .map_err(|error| failed(&self.place, "subscribe to", "vodca/announcements", error))?,
            listener: TickListener::new(&self.wake),
            place: self.place.clone(),
        })
    }

    /// A robot's voice to the coordinator.
    pub fn reporter(&self) -> Result<Reporter, ServiceError> {
        Ok(Reporter { sender: Sender::new(&self.reports, &self.place)?, notifier: ReportNotifier::new(&self.wake) })
    }

    /// The coordinator's listener.
    pub fn reports(&self) -> Result<Reports, ServiceError> {
        Ok(Reports { receiver: Receiver::new(&self.reports, &self.place)?, listener: ReportListener::new(&self.wake) })
    }

    /// A robot's voice to the others and its listener for them; `None` in a relayed exchange.
    pub fn plans(&self) -> Result<Option<PlanPorts>, ServiceError> {
        let Some(service) = &self.plans else { return Ok(None) };
        let receiver = Receiver::new(service, &self.place)?;
        Ok(Some((Sender::new(service, &self.place)?, receiver)))
    }
}

/// Makes or opens services: the one place of all limits. The creator fixes them.
struct Maker<'a> {
    node: Node<Ipc>,
    place: &'a RuntimeDir,
    role: Role,
    /// Every robot, the coordinator, and head-room.
    everyone: usize,
    /// The coordinator and head-room.
    few: usize,
}

impl<'a> Maker<'a> {
    fn new(place: &'a RuntimeDir, robots: usize, role: Role) -> Result<Self, ServiceError> {
        // Signals are ours (`stop.rs`).
        let node = NodeBuilder::new()
            .config(&config(place)?)
            .signal_handling_mode(SignalHandlingMode::Disabled)
            .create::<Ipc>()
            .map_err(|error| failed(place, "join", "the run", error))?;
        Ok(Self { node, place, role, everyone: robots + 1 + HEAD_ROOM, few: 1 + HEAD_ROOM })
    }

    fn announcements(&self, name: &str) -> Result<Channel<[Plan], Announcement>, ServiceError> {
        self.make(name, still_being_made, |name| {
            let builder = self.node.service_builder(name).publish_subscribe::<[Plan]>().user_header::<Announcement>();
            match self.role {
                Role::Open => builder.open().map_err(Trouble::Open),
                Role::Create => builder
                    .max_publishers(self.few)
                    .max_subscribers(self.everyone)
                    .max_nodes(self.everyone)
                    .history_size(1)
                    .subscriber_max_buffer_size(DEPTH)
                    .subscriber_max_borrowed_samples(DEPTH)
                    .enable_safe_overflow(true)
                    .create()
                    .map_err(|error| Trouble::Create(format!("{error:?}"))),
            }
        })
    }

    fn channel<Payload: Debug + ZeroCopySend + Copy + 'static>(
        &self,
        name: &str,
        publishers: usize,
        subscribers: usize,
    ) -> Result<Channel<Payload>, ServiceError> {
        self.make(name, still_being_made, |name| {
            let builder = self.node.service_builder(name).publish_subscribe::<Payload>();
            match self.role {
                Role::Open => builder.open().map_err(Trouble::Open),
                Role::Create => builder
                    .max_publishers(publishers)
                    .max_subscribers(subscribers)
                    .max_nodes(self.everyone)
                    .history_size(1)
                    .subscriber_max_buffer_size(DEPTH)
                    .subscriber_max_borrowed_samples(DEPTH)
                    .enable_safe_overflow(true)
                    .create()
                    .map_err(|error| Trouble::Create(format!("{error:?}"))),
            }
        })
    }

    fn notifier(&self, name: &str, notifiers: usize, listeners: usize) -> Result<Alarm, ServiceError> {
        let again =
            |error: &EventOpenError| matches!(error, EventOpenError::DoesNotExist | EventOpenError::HangsInCreation);
        self.make(name, again, |name| {
            let builder = self.node.service_builder(name).event();
            match self.role {
                Role::Open => builder.open().map_err(Trouble::Open),
                Role::Create => builder
                    .max_notifiers(notifiers)
                    .max_listeners(listeners)
                    .max_nodes(self.everyone)
                    .event_id_max_value(1)
                    .create()
                    .map_err(|error| Trouble::Create(format!("{error:?}"))),
            }
        })
    }

    /// Calls `attempt` until it gives a service, or fails for a reason that waiting does not mend.
    fn make<T, E: Debug>(
        &self,
        name: &str,
        again: impl Fn(&E) -> bool,
        attempt: impl Fn(&ServiceName) -> Result<T, Trouble<E>>,
    ) -> Result<T, ServiceError> {
        let service = ServiceName::new(name).map_err(|error| failed(self.place, "name the service", name, error))?;
        let start = Instant::now();
        loop {
            match attempt(&service) {
                Ok(made) => return Ok(made),
                Err(Trouble::Create(reason)) => return Err(failed(self.place, "make the service", name, reason)),
                Err(Trouble::Open(error)) if again(&error) && start.elapsed() < OPEN_PATIENCE => {
                    std::thread::sleep(Duration::from_millis(20));
                }
                Err(Trouble::Open(error)) => return Err(failed(self.place, "open the service", name, error)),
            }
        }
    }
}

enum Trouble<E> {
    Create(String),
    Open(E),
}

fn still_being_made(error: &OpenError) -> bool {
    matches!(error, OpenError::DoesNotExist | OpenError::HangsInCreation)
}
