//! Start positions moved at random: families of similar episodes for training and evaluation.

use super::{Problem, Scenario, ScenarioError};
use crate::Position;
use crate::random::{self, Use};
use world::shape::Obstacles;

/// Draws per robot before the spread counts as too large.
const ATTEMPTS: usize = 10_000;
/// Layouts of a family: enough that no two episodes need share one, few enough to type.
const LAYOUTS: u64 = 1_000_000;

impl Scenario {
    /// The layout of the episode with `seed`: this one, or of `family` (a generated layout less its seed, `box:8:3`)
    /// the one of that seed, with every start moved by up to `spread` metres per axis ([`Self::jittered`]).
    ///
    /// # Errors
    /// A layout that cannot be made, or that has no room for moved starts.
    pub fn of_episode(
        &self,
        family: Option<&str>,
        spread: f64,
        min_separation: f64,
        seed: u64,
    ) -> Result<Self, ScenarioError> {
        let mut layout = match family {
            Some(family) => {
                let spec = format!("{family}:{}", seed % LAYOUTS);
                Scenario { max_ticks: self.max_ticks, ..Scenario::resolve(Some(&spec), None)? }
            }
            None => self.clone(),
        };
        layout.seed = seed;
        if spread == 0.0 { Ok(layout) } else { layout.jittered(spread, min_separation, seed) }
    }

    /// This scenario with every start moved by a uniform draw from `-spread..=spread` metres per axis.
    /// A draw that overlaps an obstacle or a robot moved before is repeated; where `allow_close_start`
    /// is set only coinciding starts are. The same `seed` gives the same starts.
    ///
    /// # Errors
    /// [`Problem::NoJitteredStart`] when some robot finds no place.
    pub fn jittered(&self, spread: f64, min_separation: f64, seed: u64) -> Result<Self, ScenarioError> {
        let mut moved = self.clone();
        let radius = |given: Option<f64>| given.unwrap_or(min_separation / 2.0);
        let shapes = Obstacles::new(self.shapes.clone());
        for i in 0..self.robots.len() {
            let own = &self.robots[i];
            let clear = |start: Position| {
                let free = |centre: Position, other: Option<f64>| {
                    let needed = if self.allow_close_start { 1e-6 } else { radius(own.radius) + radius(other) };
                    (start - centre).norm() >= needed
                };
                moved.robots[..i].iter().all(|robot| free(robot.start, robot.radius))
                    && self.obstacles.iter().all(|obstacle| free(obstacle.position, obstacle.radius))
                    && shapes.nearest(start, if self.allow_close_start { 1e-6 } else { radius(own.radius) }).is_none()
            };
            let mut generator = random::stream(seed, Use::StartJitter, i as u64, 0);
            let mut draw = || spread * (2.0 * random::unit(&mut generator) - 1.0);
            let start = (0..ATTEMPTS).map(|_| own.start + Position::new(draw(), draw())).find(|&start| clear(start));
            moved.robots[i].start =
                start.ok_or_else(|| self.invalid(Problem::NoJitteredStart { robot: own.name.clone(), spread }))?;
        }
        Ok(moved)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_start_moves_within_the_spread_and_stays_valid() {
        let scenario = Scenario::resolve(Some("rand48o0_s0"), None).unwrap();
        for seed in 0..20 {
            let moved = scenario.jittered(0.4, 1.5, seed).unwrap();
            moved.validate_distances(1.5).unwrap();
            for (before, after) in scenario.robots.iter().zip(&moved.robots) {
                let offset = after.start - before.start;
                assert!(offset.amax() <= 0.4 && offset.amax() > 0.0);
                assert_eq!(before.set_point, after.set_point);
            }
        }
    }

    #[test]
    fn the_seed_decides() {
        let scenario = Scenario::resolve(Some("two_setpoint"), None).unwrap();
        let starts = |seed| scenario.jittered(0.5, 1.5, seed).unwrap();
        assert_eq!(starts(1), starts(1));
        assert_ne!(starts(1), starts(2));
        assert_eq!(scenario.jittered(0.0, 1.5, 3).unwrap(), scenario);
    }

    #[test]
    fn no_place_within_the_spread_is_an_error_not_an_endless_search() {
        let scenario = Scenario::resolve(Some("ring:8"), None).unwrap();
        let message = scenario.jittered(0.1, 9.0, 1).unwrap_err().to_string();
        assert_eq!(
            message,
            "scenario ring:8: no start within 0.1 m of robot-1's keeps its distances; use a smaller spread"
        );
    }
}
