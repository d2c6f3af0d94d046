//! How long a tick takes, by number of robots, form of the exchange, load and pace, beside the floor of
//! the same number of processes. At full speed floor and product take turns within one run.

use super::floor::FloorTeam;
use super::row::{Results, Row, TICK_PARTS};
use super::teams::{Load, TeamSpec, drive};
use super::{BenchError, Extent};
use coordinator::latency::Latency;
use coordinator::run::RunTick;
use coordinator::tick_parts::{PARTS, parts};
use shared::exchange::Kind;
use std::time::Duration;

/// Sizes of teams.
const ROBOTS: [usize; 6] = [2, 14, 32, 50, 100, 200];
/// Beyond this many robots a peer exchange has more connections than a machine has patience for.
const MOST_PEERS: usize = 100;
/// Ticks of the product between two turns of the floor, and of the floor.
const TURN: u64 = 25;
/// The first ticks are left out: they touch memory for the first time.
const WARM_UP: u64 = 5;
/// The pace of real time.
const SAMPLE_TIME: Duration = Duration::from_millis(200);

const KINDS: [(Kind, &str); 2] = [(Kind::Peer, "peer"), (Kind::Relay, "relay")];

/// Measures every combination.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    let sizes = extent.sizes(&ROBOTS, &[2, 3]);
    let teams = |robots: &usize| if *robots > MOST_PEERS { 1 } else { 2 };
    extent.tell("exchange", sizes.iter().map(teams).sum::<usize>() * Load::ALL.len() * 2 + sizes.len());
    for &robots in &sizes {
        let mut floor = FloorTeam::start(robots)?;
        full_speed(extent, robots, &mut floor, results)?;
        real_time(extent, robots, &mut floor, results)?;
    }
    Ok(())
}

fn combinations(robots: usize) -> impl Iterator<Item = ((Kind, &'static str), (Load, &'static str))> {
    let kinds = KINDS.into_iter().filter(move |(kind, _)| *kind == Kind::Relay || robots <= MOST_PEERS);
    kinds.flat_map(|kind| Load::ALL.map(|load| (kind, load)))
}

fn full_speed(
    extent: &Extent<'_>,
    robots: usize,
    floor: &mut FloorTeam,
    results: &mut Results,
) -> Result<(), BenchError> {
    // Large teams take long, and a run of robots with a QP ends when they have arrived.
    let ticks = extent.pick(if robots > 50 { 300 } else { 1_000 }, 30);
    let mut all_floors = Latency::new();
    let scenario = format!("ring:{robots}");
    let mut rows = Vec::new();
    for ((kind, kind_name), (load, load_name)) in combinations(robots) {
        let (mut latency, mut beside) = (Latency::new(), Latency::new());
        let mut by_part: [Latency; PARTS.len()] = Default::default();
        let spec = TeamSpec { scenario: &scenario, load, kind: Some(kind), real_time: false, ticks };
        let mut observe = |tick: &RunTick<'_>| {
            if tick.tick >= WARM_UP {
                latency.record_ns(tick.team.moments().collected.saturating_sub(tick.team.moments().announced));
                for (stamps, step) in tick.team.stamps().iter().zip(tick.steps) {
                    by_part.iter_mut().zip(parts(stamps, step)).for_each(|(to, part)| to.record_ns(part));
                }
            }
            if tick.tick % TURN == TURN - 1 { floor.run(TURN, None, &mut beside) } else { Ok(()) }
        };
        drive(&spec, extent.stop, &mut observe)?;
        let name = format!("{kind_name}, {load_name}, full speed");
        all_floors.add(&beside);
        rows.push(Row::new("exchange", &name, Some(robots), latency).over(Some(beside.percentiles().p50_us)));
        if load != Load::Paper {
            // Robots without a QP neither detect nor solve.
            let measured = PARTS.into_iter().zip(by_part).filter(|(_, latency)| latency.percentiles().max_us > 0.002);
            for (part, latency) in measured {
                let name = format!("{kind_name}, {load_name}: {part}");
                rows.push(Row::new(TICK_PARTS, name, Some(robots), latency));
            }
        }
        extent.advance()?;
    }
    results.row(Row::new("exchange", "futex floor, full speed", Some(robots), all_floors));
    rows.into_iter().for_each(|row| results.row(row));
    Ok(())
}

fn real_time(
    extent: &Extent<'_>,
    robots: usize,
    floor: &mut FloorTeam,
    results: &mut Results,
) -> Result<(), BenchError> {
    let ticks = extent.pick(40, 3);
    let mut beside = Latency::new();
    floor.run(ticks, Some(extent.pick(SAMPLE_TIME, Duration::from_millis(1))), &mut beside)?;
    let p50 = beside.percentiles().p50_us;
    results.row(Row::new("exchange", "futex floor, real time", Some(robots), beside));
    extent.advance()?;
    let scenario = format!("ring:{robots}");
    for ((kind, kind_name), (load, load_name)) in combinations(robots) {
        let mut latency = Latency::new();
        let spec = TeamSpec { scenario: &scenario, load, kind: Some(kind), real_time: true, ticks };
        let mut observe = |tick: &RunTick<'_>| {
            latency.record_ns(tick.team.moments().collected.saturating_sub(tick.team.moments().announced));
            Ok(())
        };
        drive(&spec, extent.stop, &mut observe)?;
        let name = format!("{kind_name}, {load_name}, real time");
        results.row(Row::new("exchange", name, Some(robots), latency).over(Some(p50)));
        extent.advance()?;
    }
    Ok(())
}
