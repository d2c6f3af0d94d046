//! The shipped hall: robots between its stations and the places beside its shelves.

use super::walls::MAX_TICKS;
use super::{scenario, shuffled, stream};
use crate::scenario::Scenario;

pub(super) const WAREHOUSE: &str = "warehouse:N:SEED";

/// `robots` of the map's places as starts, as many as set-points; nobody starts where it wants to be.
pub(super) fn warehouse(robots: usize, seed: u64) -> Result<Scenario, String> {
    let (shapes, places) = world::shipped::warehouse().map_err(|error| error.to_string())?;
    if robots > places.len() {
        return Err(format!("{robots} robots are too many for its {} places", places.len()));
    }
    let mut generator = stream(seed, WAREHOUSE, robots, 0);
    let starts = &shuffled(places.len(), &mut generator)[..robots];
    let mut ends = shuffled(places.len(), &mut generator);
    for robot in 0..robots {
        if ends[robot] == starts[robot] {
            let other = (robot + 1) % ends.len();
            ends.swap(robot, other);
        }
    }
    let at = |place: &usize| places[*place].position.0;
    let pairs = starts.iter().map(at).zip(ends.iter().map(at));
    Ok(Scenario { shapes, ..scenario(format!("warehouse:{robots}:{seed}"), seed, MAX_TICKS, pairs, []) })
}
