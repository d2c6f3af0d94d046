//! One way from a process to another and back: iceoryx2 beside the floors, in the same run.

use super::links::{End, Link, LinkKind, Message, link};
use super::partner::{Partner, PartnerArgs};
use super::row::{Results, Row};
use super::{BenchError, Extent, Options, cost};
use coordinator::latency::Latency;
use shared::os;
use shared::runtime_dir::RuntimeDir;

/// Passes over all links, so that what disturbs one for a while does not spoil one link alone.
const PASSES: usize = 20;
/// Rounds of a link in a pass; every round is two samples.
const ROUNDS: u64 = 1_000;

/// What a pass of a link is expected to take, s.
fn pass_seconds(options: &Options, kind: LinkKind) -> f64 {
    let round = if kind.floor() == LinkKind::PageSpin { cost::SPINNING_ROUND } else { cost::SLEEPING_ROUND };
    cost::LINK + 1.1 * options.pick(ROUNDS, 20) as f64 * round
}

/// What this part is expected to take, s.
pub(super) fn seconds(options: &Options) -> f64 {
    let pass: f64 = LinkKind::ALL.iter().map(|(kind, _)| pass_seconds(options, *kind)).sum();
    options.pick(PASSES, 2) as f64 * pass
}

/// Measures every link.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    extent.tell("hop");
    let rounds = extent.options.pick(ROUNDS, 20);
    let mut found: Vec<Latency> = LinkKind::ALL.iter().map(|_| Latency::new()).collect();
    for _ in 0..extent.options.pick(PASSES, 2) {
        for ((kind, _), latency) in LinkKind::ALL.into_iter().zip(&mut found) {
            measure(kind, rounds, latency)?;
            extent.advance(pass_seconds(extent.options, kind))?;
        }
    }
    for ((kind, name), latency) in LinkKind::ALL.into_iter().zip(&found) {
        let row = Row::new("hop", name, None, latency.clone());
        let floor = LinkKind::ALL.iter().position(|(other, _)| *other == kind.floor());
        results.row(match floor {
            Some(floor) => row.over(kind.floor().name(), &found[floor]),
            None => row,
        });
    }
    Ok(())
}

fn measure(kind: LinkKind, rounds: u64, latency: &mut Latency) -> Result<(), BenchError> {
    let place = OwnedPlace::create()?;
    let (mut link, events) = link(kind, &place.0, End::First)?;
    let RuntimeDir { prefix, root } = place.0.clone();
    let partner = Partner::start(PartnerArgs::Hop { link: kind, prefix, root, events: events.to_vec() })?;
    // The partner speaks first: whatever opening took is over then.
    link.receive()?;
    let warm_up = rounds / 10;
    for round in 0..warm_up + rounds {
        link.send(Message { stamp: os::now_ns(), ..Message::default() })?;
        let answer = link.receive()?;
        let back = os::now_ns().saturating_sub(answer.stamp);
        if round >= warm_up {
            latency.record_ns(answer.one_way);
            latency.record_ns(back);
        }
    }
    link.send(Message { last: 1, ..Message::default() })?;
    partner.wait()
}

/// The other end: answers every message, with how long it took.
pub(super) fn answer(link: &mut dyn Link) -> Result<(), BenchError> {
    link.send(Message::default())?;
    loop {
        let message = link.receive()?;
        let now = os::now_ns();
        if message.last == 1 {
            return Ok(());
        }
        let one_way = now.saturating_sub(message.stamp);
        link.send(Message { stamp: os::now_ns(), one_way, last: 0 })?;
    }
}

/// Shared files of a measurement, deleted when dropped.
pub(super) struct OwnedPlace(pub(super) RuntimeDir);

impl OwnedPlace {
    /// A place of this process.
    pub(super) fn create() -> Result<Self, BenchError> {
        Ok(Self(RuntimeDir::create()?))
    }
}

impl Drop for OwnedPlace {
    fn drop(&mut self) {
        self.0.remove();
    }
}
