//! How long a tick takes at full speed, by number of robots, form of the exchange and load, beside the floor
//! of the same number of processes. Both sleep until they are woken, and take turns within one run.

use super::floor::FloorTeam;
use super::row::{Results, Row, TICK_PARTS};
use super::teams::{Load, TeamSpec, drive};
use super::{BenchError, Extent, Options, cost};
use coordinator::latency::Latency;
use coordinator::run::RunTick;
use coordinator::tick_parts::{PARTS, parts};
use shared::exchange::Kind;

/// Sizes of teams.
const ROBOTS: [usize; 5] = [2, 14, 50, 100, 200];
/// Beyond this many robots a peer exchange, whose connections grow with their square, takes longer than anybody
/// waits for.
const MOST_PEERS: usize = 50;
/// Ticks that a row rests on.
const TICKS: u64 = 20_000;
/// Ticks of the product between two turns of the floor.
const TURN: u64 = 25;
/// The first ticks are left out: they touch memory for the first time.
pub(super) const WARM_UP: u64 = 5;
/// Name of the floor.
const FLOOR: &str = "futex floor, full speed";

const KINDS: [(Kind, &str); 2] = [(Kind::Peer, "peer"), (Kind::Relay, "relay")];

/// One team that is measured.
#[derive(Clone, Copy)]
struct Case {
    robots: usize,
    kind: (Kind, &'static str),
    load: (Load, &'static str),
    ticks: u64,
    /// Ticks of the floor in each of its turns: so many that all turns of a size together are enough for a row.
    floor_turn: u64,
}

impl Case {
    /// All teams of this size.
    fn of(options: &Options, robots: usize) -> Vec<Self> {
        let ticks = options.pick(TICKS, 30);
        let kinds = KINDS.into_iter().filter(|(kind, _)| *kind == Kind::Relay || robots <= MOST_PEERS);
        let all: Vec<_> = kinds.flat_map(|kind| Load::ALL.map(|load| (kind, load))).collect();
        let floor_turn = TURN.div_ceil(all.len() as u64);
        all.into_iter().map(|(kind, load)| Self { robots, kind, load, ticks, floor_turn }).collect()
    }

    /// What a turn of product and floor is expected to take, s.
    fn turn_seconds(&self) -> f64 {
        let product = cost::tick(self.kind.0, self.load.0, self.robots);
        TURN as f64 * product + self.floor_turn as f64 * cost::floor_tick(self.robots)
    }
}

/// What this part is expected to take, s.
pub(super) fn seconds(options: &Options) -> f64 {
    let of_case = |case: Case| case.ticks as f64 / TURN as f64 * case.turn_seconds() + cost::start(case.robots);
    let of_size = |robots| cost::start(robots) + Case::of(options, robots).into_iter().map(of_case).sum::<f64>();
    options.sizes(&ROBOTS, &[2, 3]).into_iter().map(of_size).sum()
}

/// Measures every combination.
pub(super) fn run(extent: &Extent<'_>, results: &mut Results) -> Result<(), BenchError> {
    extent.tell("exchange");
    for robots in extent.options.sizes(&ROBOTS, &[2, 3]) {
        let mut floor = FloorTeam::start(robots)?;
        extent.advance(cost::start(robots))?;
        let (mut all_floors, mut rows) = (Latency::new(), Vec::new());
        for case in Case::of(extent.options, robots) {
            measure(extent, &case, &mut floor, &mut all_floors, &mut rows)?;
            extent.advance(cost::start(robots))?;
        }
        results.row(Row::new("exchange", FLOOR, Some(robots), all_floors).as_floor());
        rows.into_iter().for_each(|row| results.row(row));
    }
    Ok(())
}

fn measure(
    extent: &Extent<'_>,
    case: &Case,
    floor: &mut FloorTeam,
    all_floors: &mut Latency,
    rows: &mut Vec<Row>,
) -> Result<(), BenchError> {
    let Case { robots, kind: (kind, kind_name), load: (load, load_name), ticks, floor_turn } = *case;
    let (mut latency, mut beside) = (Latency::new(), Latency::new());
    let mut by_part: [Latency; PARTS.len()] = Default::default();
    let scenario = format!("ring:{robots}");
    let spec = TeamSpec { scenario: &scenario, load, kind: Some(kind), real_time: false, ticks: WARM_UP + ticks };
    let mut observe = |number: u64, tick: &RunTick<'_>| {
        if number >= WARM_UP {
            let moments = tick.team.moments();
            latency.record_ns(moments.collected.saturating_sub(moments.announced));
            for (stamps, step) in tick.team.stamps().iter().zip(tick.steps) {
                by_part.iter_mut().zip(parts(stamps, step)).for_each(|(to, part)| to.record_ns(part));
            }
        }
        if number % TURN == TURN - 1 {
            floor.run(floor_turn, &mut beside)?;
            extent.advance(case.turn_seconds())?;
        }
        Ok(())
    };
    drive(&spec, extent.stop, &mut observe)?;
    all_floors.add(&beside);
    let name = format!("{kind_name}, {load_name}, full speed");
    rows.push(Row::new("exchange", name, Some(robots), latency).over(FLOOR, &beside));
    // Robots without a QP neither detect nor solve.
    let measured = PARTS.into_iter().zip(by_part).filter(|(_, latency)| latency.percentiles().max_us > 0.002);
    for (part, latency) in measured {
        rows.push(Row::new(TICK_PARTS, format!("{kind_name}, {load_name}: {part}"), Some(robots), latency));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_of_the_whole_benchmark_rests_on_twenty_thousand_ticks_the_floors_too() {
        let options = Options::whole(super::super::Part::Exchange);
        for robots in ROBOTS {
            let cases = Case::of(&options, robots);
            assert_eq!(cases.len(), if robots <= MOST_PEERS { 4 } else { 2 });
            assert!(cases.iter().all(|case| case.ticks >= 20_000), "{robots}");
            let floor: u64 = cases.iter().map(|case| (WARM_UP + case.ticks) / TURN * case.floor_turn).sum();
            assert!(floor >= 20_000, "{robots}: {floor}");
        }
    }
}
