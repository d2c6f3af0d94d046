//! The ways by which a message of the size of a plan gets from one process to another.

use super::iceoryx_links::{Busy, EventFirst, EventSecond, TeamFirst, TeamSecond};
use super::system::{EventFd, PLAN_WORDS, PlanPage, wait_until};
use super::{BenchError, failed};
use shared::raw::futex_wake;
use shared::runtime_dir::RuntimeDir;
use shared::services::{PolicyAsker, PolicyPort, Services};
use std::os::unix::net::UnixDatagram;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// How long the other side may take.
pub(super) const PATIENCE: Duration = Duration::from_secs(5);

/// A kind of link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum LinkKind {
    /// Shared page, the reader looks without pause
    PageSpin,
    /// Shared page and futex
    Futex,
    /// Shared page and eventfd
    Eventfd,
    /// Unix datagram socket
    Datagram,
    /// iceoryx2 publish-subscribe, the reader looks without pause
    IceoryxBusy,
    /// iceoryx2 publish-subscribe and a futex, as the team
    IceoryxTeam,
    /// iceoryx2 publish-subscribe and event, as the policy server
    IceoryxEvent,
}

impl LinkKind {
    /// All of them with their names in tables, floors first.
    pub(super) const ALL: [(LinkKind, &'static str); 7] = [
        (Self::PageSpin, "shared page, busy"),
        (Self::Futex, "futex"),
        (Self::Eventfd, "eventfd"),
        (Self::Datagram, "unix datagram"),
        (Self::IceoryxBusy, "iceoryx2, busy"),
        (Self::IceoryxTeam, "iceoryx2, futex"),
        (Self::IceoryxEvent, "iceoryx2, event"),
    ];

    /// The floor it is compared with: the same way of waiting, spinning or sleeping, without a middleware.
    pub(super) fn floor(self) -> LinkKind {
        if matches!(self, Self::PageSpin | Self::IceoryxBusy) { Self::PageSpin } else { Self::Futex }
    }

    /// Its name in tables.
    pub(super) fn name(self) -> &'static str {
        Self::ALL.iter().find(|(kind, _)| *kind == self).map_or("", |(_, name)| name)
    }
}

/// What is sent; with it go so many zeros that the size is that of a [`Plan`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Message {
    /// When it was sent, ns.
    pub(super) stamp: u64,
    /// How long the message before took in the other direction, ns.
    pub(super) one_way: u64,
    /// 1: the last one.
    pub(super) last: u64,
}

/// One end of a link.
pub(super) trait Link {
    /// Sends `message` to the other end.
    fn send(&mut self, message: Message) -> Result<(), BenchError>;
    /// The next message from the other end.
    fn receive(&mut self) -> Result<Message, BenchError>;
}

/// Which end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// Makes what is shared and speaks first.
    First,
    /// Opens it; the numbers of the eventfds to wait for and to signal.
    Second([i32; 2]),
}

/// An end of a link of this kind; files lie in `place`. The numbers are those of the second end.
pub(super) fn link(kind: LinkKind, place: &RuntimeDir, end: End) -> Result<(Box<dyn Link>, [i32; 2]), BenchError> {
    let page = || {
        let path = PathBuf::from(format!("/dev/shm/{}page", place.prefix));
        match end {
            End::First => PlanPage::create(&path, 2, 2).map_err(failed("make a shared page")),
            End::Second(_) => PlanPage::open(&path, 2, 2).map_err(failed("open a shared page")),
        }
    };
    let me = usize::from(end != End::First);
    let mut numbers = [0; 2];
    let link: Box<dyn Link> = match kind {
        LinkKind::PageSpin => Box::new(Paged { page: page()?, me, seen: 0, waiting: Waiting::Spin }),
        LinkKind::Futex => Box::new(Paged { page: page()?, me, seen: 0, waiting: Waiting::Futex }),
        LinkKind::Eventfd => {
            let (ours, theirs) = match end {
                End::First => (
                    EventFd::new().map_err(failed("make an eventfd"))?,
                    EventFd::new().map_err(failed("make an eventfd"))?,
                ),
                End::Second([ours, theirs]) => (EventFd::inherited(ours), EventFd::inherited(theirs)),
            };
            numbers = [theirs.number(), ours.number()];
            Box::new(Paged { page: page()?, me, seen: 0, waiting: Waiting::Event { ours, theirs } })
        }
        LinkKind::Datagram => Box::new(Datagram::new(Path::new(&place.root), me)?),
        LinkKind::IceoryxBusy => {
            let services = services(place, end)?;
            let ports = services.plans()?.ok_or(BenchError::Silent { who: "the service of plans" })?;
            Box::new(Busy::new(ports, me as u16, services))
        }
        LinkKind::IceoryxEvent => match end {
            End::First => Box::new(EventFirst(PolicyAsker::create(place)?)),
            End::Second(_) => Box::new(EventSecond(PolicyPort::open(place)?)),
        },
        LinkKind::IceoryxTeam => {
            let services = services(place, end)?;
            match end {
                End::First => {
                    let (to, from) = (services.announcer(0)?, services.reports()?);
                    Box::new(TeamFirst::new(to, from, services))
                }
                End::Second(_) => Box::new(TeamSecond::new(services.reporter()?, services.announcements()?)),
            }
        }
    };
    Ok((link, numbers))
}

fn services(place: &RuntimeDir, end: End) -> Result<Services, BenchError> {
    Ok(match end {
        End::First => Services::create(place, 2, true)?,
        End::Second(_) => Services::open(place, 2, true)?,
    })
}

enum Waiting {
    Spin,
    Futex,
    Event { ours: EventFd, theirs: EventFd },
}

/// A slot and a counter per direction in a shared page.
struct Paged {
    page: PlanPage,
    me: usize,
    seen: u32,
    waiting: Waiting,
}

/// Writes a whole slot.
pub(super) fn write_slot(slot: &[AtomicU64; PLAN_WORDS], words: &[u64; PLAN_WORDS]) {
    slot.iter().zip(words).for_each(|(to, from)| to.store(*from, Ordering::Relaxed));
}

/// Reads a whole slot.
pub(super) fn read_slot(slot: &[AtomicU64; PLAN_WORDS], words: &mut [u64; PLAN_WORDS]) {
    slot.iter().zip(words).for_each(|(from, to)| *to = from.load(Ordering::Relaxed));
}

impl Link for Paged {
    fn send(&mut self, message: Message) -> Result<(), BenchError> {
        let mut words = [0; PLAN_WORDS];
        words[..3].copy_from_slice(&[message.stamp, message.one_way, message.last]);
        write_slot(self.page.slot(self.me), &words);
        let word = self.page.word(self.me);
        word.fetch_add(1, Ordering::Release);
        match &self.waiting {
            Waiting::Spin => Ok(()),
            Waiting::Futex => {
                futex_wake(word, 1);
                Ok(())
            }
            Waiting::Event { theirs, .. } => theirs.signal().map_err(failed("signal an eventfd")),
        }
    }

    fn receive(&mut self) -> Result<Message, BenchError> {
        let (word, seen) = (self.page.word(1 - self.me), self.seen);
        let there = match &self.waiting {
            Waiting::Spin => spin_until(|| (word.load(Ordering::Acquire) != seen).then_some(())).is_some(),
            Waiting::Futex => wait_until(word, PATIENCE, |value| value != seen).is_some(),
            Waiting::Event { ours, .. } => ours.wait(PATIENCE).map_err(failed("wait for an eventfd"))?,
        };
        if !there {
            return Err(BenchError::Silent { who: "the other end of a link" });
        }
        self.seen = word.load(Ordering::Acquire);
        let mut words = [0; PLAN_WORDS];
        read_slot(self.page.slot(1 - self.me), &mut words);
        Ok(Message { stamp: words[0], one_way: words[1], last: words[2] })
    }
}

/// Looks without pause until there is something, for [`PATIENCE`] at most.
pub(super) fn spin_until<T>(mut look: impl FnMut() -> Option<T>) -> Option<T> {
    let start = Instant::now();
    for turn in 1u64.. {
        if let Some(found) = look() {
            return Some(found);
        }
        std::hint::spin_loop();
        if turn % 4096 == 0 && start.elapsed() > PATIENCE {
            break;
        }
    }
    None
}

struct Datagram {
    socket: UnixDatagram,
    other: PathBuf,
}

impl Datagram {
    fn new(folder: &Path, me: usize) -> Result<Self, BenchError> {
        let path = |end: usize| folder.join(format!("bench-{end}"));
        let socket = UnixDatagram::bind(path(me)).map_err(failed("make a datagram socket"))?;
        socket.set_read_timeout(Some(PATIENCE)).map_err(failed("make a datagram socket"))?;
        Ok(Self { socket, other: path(1 - me) })
    }
}

impl Link for Datagram {
    fn send(&mut self, message: Message) -> Result<(), BenchError> {
        let mut bytes = [0u8; PLAN_WORDS * 8];
        for (to, word) in bytes.chunks_exact_mut(8).zip([message.stamp, message.one_way, message.last]) {
            to.copy_from_slice(&word.to_le_bytes());
        }
        let sent = self.socket.send_to(&bytes, &self.other);
        sent.map(|_| ()).map_err(failed("send a datagram"))
    }

    fn receive(&mut self) -> Result<Message, BenchError> {
        let mut bytes = [0u8; PLAN_WORDS * 8];
        let received = self.socket.recv(&mut bytes);
        received.map_err(failed("receive a datagram"))?;
        let word = |index: usize| bytes.as_chunks::<8>().0.get(index).map_or(0, |bytes| u64::from_le_bytes(*bytes));
        Ok(Message { stamp: word(0), one_way: word(1), last: word(2) })
    }
}
