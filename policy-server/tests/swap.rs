//! Promise: a new version takes over between two ticks, a bad one never does, and the one before is
//! kept for a rollback.
#![allow(clippy::unwrap_used)] // a panic is how a test fails

mod common;

use common::{constant_actor, contract, prober};
use policy::digest::sha256;
use policy::folder::{PolicyFolder, Status, Version};
use policy::onnx::ActorGraph;
use policy_server::actor::{Actor, BackEnd, Runtime};
use policy_server::hot_swap::{Event, HotSwap, Loaded, Order};
use policy_server::loader::{Loader, Watched};
use policy_server::sample::Choice;
use std::sync::mpsc::{self, Receiver, Sender};
use std::time::{Duration, Instant};
use vodca::Position;

const ROBOTS: usize = 2;
/// Only a watchdog: how long a machine under load may take for one swap.
const PATIENCE: Duration = Duration::from_secs(60);

/// Mean of the raw action that gives these horizons (robots all alike), in the middle of the step.
fn mean_for(steps: usize) -> f32 {
    ((steps as f64 - 1.5) / 24.0 - 1.0).atanh() as f32
}

fn actor(steps: usize) -> ActorGraph {
    constant_actor(ROBOTS, mean_for(steps))
}

/// A serving thread that is played by the test, and the real loader.
struct Bench {
    _place: tempfile::TempDir,
    folder: PolicyFolder,
    swap: HotSwap,
    tick: u64,
}

impl Bench {
    fn new(first: usize) -> Self {
        let place = tempfile::tempdir().unwrap();
        let folder = PolicyFolder::new(place.path().join("policy"));
        folder.publish(&actor(first).write(), &contract(ROBOTS), None).unwrap();
        Self::serve(place, folder)
    }

    fn serve(place: tempfile::TempDir, folder: PolicyFolder) -> Self {
        let (orders, ordered) = mpsc::channel();
        let (events, happened): (Sender<Event>, Receiver<Event>) = mpsc::channel();
        let watched =
            Watched { folder: folder.clone(), robots: ROBOTS, upstream: None, poll: Duration::from_millis(5) };
        let loader = Loader::start(watched, prober(), orders).unwrap();
        std::thread::spawn(move || loader.run(&happened));
        Self { _place: place, folder, swap: HotSwap::new(ROBOTS, ordered, events), tick: 0 }
    }

    /// One tick: the horizon of the robots.
    fn tick(&mut self) -> usize {
        let positions = [Position::zeros(); ROBOTS];
        let mut chosen = Vec::new();
        self.swap.between_ticks(self.tick);
        assert!(self.swap.choose(self.tick, &positions, Choice::Mean, &mut chosen));
        self.tick += 1;
        assert_eq!(chosen[0], chosen[1]);
        chosen[0].1.steps()
    }

    /// Ticks until the robots get `steps`; before that they only ever get `before`.
    fn tick_until(&mut self, steps: usize, before: usize) {
        let start = Instant::now();
        loop {
            let got = self.tick();
            if got == steps {
                return;
            }
            assert_eq!(got, before);
            assert!(start.elapsed() < PATIENCE, "no swap: {:?}", self.folder.read_status());
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    /// Ticks until the status is as `wanted`; the robots get `steps` all the time.
    fn tick_until_status(&mut self, steps: usize, wanted: impl Fn(&Status) -> bool) -> Status {
        let start = Instant::now();
        loop {
            assert_eq!(self.tick(), steps);
            let status = self.folder.read_status().unwrap().unwrap();
            if wanted(&status) {
                return status;
            }
            assert!(start.elapsed() < PATIENCE, "{status:?}");
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

#[test]
fn a_published_version_takes_over_and_a_rollback_brings_the_old_one_back() {
    let mut bench = Bench::new(10);
    assert_eq!(bench.tick(), 10);
    let second = bench.folder.publish(&actor(30).write(), &contract(ROBOTS), None).unwrap();
    bench.tick_until(30, 10);
    let status = bench.tick_until_status(30, |status| status.previous.is_some());
    assert_eq!(status.serving.unwrap().version, second.to_string());
    assert_eq!(status.previous.unwrap().version, "v000001");
    bench.folder.set_current(Version(1)).unwrap();
    bench.tick_until(10, 30);
    let status = bench.tick_until_status(10, |status| status.serving.as_ref().unwrap().version == "v000001");
    assert_eq!(status.previous.unwrap().version, second.to_string());
}

#[test]
fn a_bad_version_never_acts_is_not_tried_again_and_a_later_good_one_does() {
    let mut bench = Bench::new(10);
    let mut bad = actor(20);
    bad.mean.weight[0] = f32::NAN;
    bench.folder.publish(&bad.write(), &contract(ROBOTS), None).unwrap();
    let status = bench.tick_until_status(10, |status| !status.rejected.is_empty());
    assert!(status.rejected[0].error.contains("not a finite number"), "{status:?}");
    for _ in 0..100 {
        assert_eq!(bench.tick(), 10);
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(bench.folder.read_status().unwrap().unwrap().rejected.len(), 1);
    bench.folder.publish(&actor(40).write(), &contract(ROBOTS), None).unwrap();
    bench.tick_until(40, 10);
}

#[test]
fn a_half_written_model_is_refused_and_acts_once_it_is_whole() {
    let mut bench = Bench::new(10);
    let whole = actor(25).write();
    let version = bench.folder.add(&whole, &contract(ROBOTS), None).unwrap();
    let model = bench.folder.model(version);
    std::fs::write(&model, &whole[..whole.len() / 2]).unwrap();
    bench.folder.set_current(version).unwrap();
    let status = bench.tick_until_status(10, |status| !status.rejected.is_empty());
    assert!(status.rejected[0].error.contains("still being written"), "{status:?}");
    std::fs::write(&model, &whole).unwrap();
    bench.tick_until(25, 10);
}

#[test]
fn a_restarted_server_starts_with_the_newest_version_that_may_act() {
    let bench = Bench::new(10);
    bench.folder.publish(&actor(33).write(), &contract(ROBOTS), None).unwrap();
    let bad = bench.folder.publish(b"no model", &contract(ROBOTS), None).unwrap();
    assert_eq!(bench.folder.current().unwrap(), Some(bad));
    let Bench { _place: place, folder, swap, .. } = bench;
    drop(swap); // The first server ends.
    let mut again = Bench::serve(place, folder);
    assert_eq!(again.tick(), 33);
}

#[test]
fn numbers_that_are_not_finite_bring_the_previous_model_back_within_the_tick() {
    let runtime = Runtime::start(&BackEnd::Embedded).unwrap();
    let load = |graph: ActorGraph, version| {
        let bytes = graph.write();
        let actor = Actor::load(&runtime, &bytes, &contract(ROBOTS)).unwrap();
        Box::new(Loaded { actor, version: Version(version), sha256: sha256(&bytes), since_tick: None })
    };
    // Fine near the origin, where it was checked; overflows far out.
    let mut fragile = actor(30);
    fragile.hidden[0] = common::dense(2 * ROBOTS, 8, 1e36, 0.0);
    fragile.mean = common::dense(8, ROBOTS, 1e30, mean_for(30));
    let (orders, ordered) = mpsc::channel();
    let (events, happened) = mpsc::channel();
    let mut swap = HotSwap::new(ROBOTS, ordered, events);
    orders.send(Order::Switch(load(actor(10), 1))).unwrap();
    orders.send(Order::Switch(load(fragile, 2))).unwrap();
    swap.between_ticks(0);
    let mut answers = Vec::new();
    let mut at = |x: f64, tick: u64, swap: &mut HotSwap| {
        let chosen = swap.choose(tick, &[Position::new(x, x); ROBOTS], Choice::Mean, &mut answers);
        chosen.then(|| answers[0].1.steps())
    };
    assert_eq!(at(0.0, 0, &mut swap), Some(30));
    assert_eq!(at(1000.0, 1, &mut swap), Some(10), "the very tick is answered by the previous model");
    assert_eq!(at(0.0, 2, &mut swap), Some(10));
    let failed = happened.try_iter().find_map(|event| match event {
        Event::Failed { tick, failed, serving, .. } => Some((tick, failed.version, serving.unwrap().version)),
        Event::Switched { .. } | Event::Gone => None,
    });
    assert_eq!(failed, Some((1, "v000002".into(), "v000001".into())));
    // A rollback to the model that has just failed leaves the good one acting; one to a stranger, too.
    for digest in [sha256(b"failed"), sha256(&actor(10).write())] {
        orders.send(Order::Rollback { version: Version(7), sha256: digest }).unwrap();
        swap.between_ticks(3);
        assert_eq!(at(0.0, 3, &mut swap), Some(10));
    }
    assert!(happened.try_iter().any(|event| matches!(event, Event::Gone)));
    // And when nothing is left, that is said instead of a horizon.
    let mut alone = HotSwap::new(ROBOTS, mpsc::channel().1, mpsc::channel().0);
    assert_eq!(at(0.0, 3, &mut alone), None);
}
