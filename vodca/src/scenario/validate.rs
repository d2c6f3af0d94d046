//! What a layout must satisfy before it is run.

use super::{MAX_COORDINATE, MAX_ROBOTS, MAX_SPEED, Problem, Scenario, ScenarioError};
use crate::Position;
use std::sync::Arc;
use world::check::{self, PlaceProblem};
use world::route::{Roadmap, Route, Unreachable};
use world::shape::Obstacles;

/// Rounding allowance on distances, m: layouts that touch on purpose are accepted.
const TOLERANCE: f64 = 1e-9;

/// Nearer than this, two centres have no direction between them.
const COINCIDENT: f64 = 1e-9;

/// Longest run; keeps records within what a disk holds.
const MAX_TICKS: u64 = 1_000_000;

impl Scenario {
    /// Checks everything that does not depend on parameters: counts, numbers, radii, names.
    /// [`Scenario::resolve`] and [`Scenario::from_toml`] have done it.
    pub fn validate(&self) -> Result<(), ScenarioError> {
        self.find_problem().map_err(|problem| self.invalid(problem))
    }

    /// Checks all distances at the start and at the set-points for discs of radius
    /// `min_separation / 2` (or their own): robots and obstacles must not overlap.
    pub fn validate_distances(&self, min_separation: f64) -> Result<(), ScenarioError> {
        self.find_overlap(min_separation).map_err(|problem| self.invalid(problem))
    }

    /// Checks that a way leads every robot to its set-point past all that stands, for its own radius, as if it were
    /// alone. Takes a roadmap for each radius.
    pub fn validate_ways(&self, min_separation: f64) -> Result<(), ScenarioError> {
        self.find_closed_way(min_separation).map_err(|problem| self.invalid(problem))
    }

    /// This layout with other set-points, by robot number, m; checked as a layout is before a run, but for the starts,
    /// where nobody may be any more.
    ///
    /// # Errors
    /// A set-point that cannot be, be filled beside the others, or be reached.
    pub fn with_set_points(
        &self,
        set_points: &[(usize, Position)],
        min_separation: f64,
    ) -> Result<Self, ScenarioError> {
        let mut changed = self.clone();
        for &(robot, set_point) in set_points {
            changed.robots[robot].set_point = set_point;
        }
        changed.validate_distances(min_separation)?;
        self.alone(set_points).check(min_separation)?;
        Ok(changed)
    }

    /// Only these robots, with these set-points, m.
    pub(crate) fn alone(&self, set_points: &[(usize, Position)]) -> Self {
        let robot = |&(robot, set_point): &(usize, Position)| super::Robot { set_point, ..self.robots[robot].clone() };
        Self { robots: set_points.iter().map(robot).collect(), ..self.clone() }
    }

    /// Checks all that can be checked.
    pub(crate) fn check(&self, min_separation: f64) -> Result<(), ScenarioError> {
        self.validate()?;
        self.validate_distances(min_separation)?;
        self.validate_ways(min_separation)
    }

    pub(super) fn invalid(&self, problem: Problem) -> ScenarioError {
        ScenarioError::Invalid { scenario: self.name.clone(), problem }
    }

    fn find_problem(&self) -> Result<(), Problem> {
        match self.robots.len() {
            0 => return Err(Problem::NoRobots),
            1..=MAX_ROBOTS => {}
            many => return Err(Problem::TooManyRobots(many)),
        }
        integer("max_ticks", self.max_ticks, 1, MAX_TICKS)?;
        // TOML integers have a sign.
        integer("seed", self.seed, 0, i64::MAX as u64)?;
        for robot in &self.robots {
            coordinate(&robot.name, "start", robot.start)?;
            coordinate(&robot.name, "set_point", robot.set_point)?;
            check_radius(&robot.name, robot.radius)?;
            if let Some(speed) = robot.max_speed.filter(|speed| !(*speed > 0.0 && *speed <= MAX_SPEED)) {
                return Err(Problem::Speed { who: robot.name.clone(), speed });
            }
        }
        for obstacle in &self.obstacles {
            coordinate(&obstacle.name, "position", obstacle.position)?;
            check_radius(&obstacle.name, obstacle.radius)?;
        }
        let mut names: Vec<&str> = self.robots.iter().map(|robot| robot.name.as_str()).collect();
        names.extend((0..self.obstacle_count()).map(|number| self.obstacle_name(number)));
        names.sort_unstable();
        match names.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(Problem::DuplicateName(pair[0].into())),
            None => Ok(()),
        }
    }

    fn find_overlap(&self, min_separation: f64) -> Result<(), Problem> {
        let radius = |given: Option<f64>| given.unwrap_or(min_separation / 2.0);
        let shapes = Obstacles::new(self.shapes.clone());
        for (i, a) in self.robots.iter().enumerate() {
            for b in &self.robots[i + 1..] {
                let needed = radius(a.radius) + radius(b.radius);
                self.check_start(&a.name, a.start, &b.name, b.start, needed)?;
                let distance = (a.set_point - b.set_point).norm();
                if distance < needed - TOLERANCE {
                    let b = format!("that of {}", b.name);
                    return Err(Problem::CloseSetPoint { a: a.name.clone(), b, distance, needed });
                }
            }
            for obstacle in &self.obstacles {
                let needed = radius(a.radius) + radius(obstacle.radius);
                self.check_start(&a.name, a.start, &obstacle.name, obstacle.position, needed)?;
                let distance = (a.set_point - obstacle.position).norm();
                if distance < needed - TOLERANCE {
                    let b = obstacle.name.clone();
                    return Err(Problem::CloseSetPoint { a: a.name.clone(), b, distance, needed });
                }
            }
            let place = |what, at| check::place(&shapes, &a.name, what, at, radius(a.radius));
            match place("start", a.start) {
                // Nearer than owed, but outside: out of there the way is known.
                Err(PlaceProblem::TooNear { .. }) if self.allow_close_start => {}
                other => other.map_err(Box::new).map_err(Problem::Place)?,
            }
            place("set-point", a.set_point).map_err(Box::new).map_err(Problem::Place)?;
        }
        Ok(())
    }

    fn find_closed_way(&self, min_separation: f64) -> Result<(), Problem> {
        let all = self.standing(min_separation);
        let mut maps: Vec<Arc<Roadmap>> = Vec::new();
        for robot in self.robots.iter().filter(|_| all.count() > 0) {
            let clearance = robot.radius.unwrap_or(min_separation / 2.0);
            let known = maps.iter().find(|map| map.clearance() == clearance).cloned();
            let map = known.unwrap_or_else(|| {
                let map = Arc::new(Roadmap::new(all.all().clone(), clearance));
                maps.push(map.clone());
                map
            });
            match Route::new(map, robot.set_point).and_then(|route| route.reach(robot.start)) {
                // Distances were checked before, with less room for rounding.
                Ok(_) | Err(Unreachable::Place(_)) => {}
                Err(reason) => {
                    return Err(Problem::Unreachable { robot: robot.name.clone(), reason: Box::new(reason) });
                }
            }
        }
        Ok(())
    }

    fn check_start(&self, a: &str, start: Position, b: &str, other: Position, needed: f64) -> Result<(), Problem> {
        let distance = (start - other).norm();
        if distance < COINCIDENT {
            return Err(Problem::Coincident { a: a.into(), b: b.into(), x: start.x, y: start.y });
        }
        if !self.allow_close_start && distance < needed - TOLERANCE {
            return Err(Problem::CloseStart { a: a.into(), b: b.into(), distance, needed });
        }
        Ok(())
    }
}

fn integer(key: &'static str, value: u64, low: u64, high: u64) -> Result<(), Problem> {
    if (low..=high).contains(&value) { Ok(()) } else { Err(Problem::Integer { key, value, low, high }) }
}

fn coordinate(who: &str, what: &'static str, point: Position) -> Result<(), Problem> {
    if point.iter().all(|x| x.abs() <= MAX_COORDINATE) {
        Ok(())
    } else {
        Err(Problem::Coordinate { who: who.into(), what, x: point.x, y: point.y })
    }
}

fn check_radius(who: &str, radius: Option<f64>) -> Result<(), Problem> {
    match radius {
        Some(radius) if !(radius > 0.0 && radius <= MAX_COORDINATE) => Err(Problem::Radius { who: who.into(), radius }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Obstacle;

    fn good() -> Scenario {
        let mut scenario = Scenario::resolve(Some("four_gate"), None).unwrap();
        scenario.name = "mine".into();
        scenario
    }

    /// The message after `change`, or "" when the scenario is still valid.
    fn after(change: impl FnOnce(&mut Scenario)) -> String {
        let mut scenario = good();
        change(&mut scenario);
        match scenario.validate().and_then(|()| scenario.validate_distances(1.5)) {
            Ok(()) => String::new(),
            Err(error) => error.to_string(),
        }
    }

    fn assert_names(message: &str, parts: &[&str]) {
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in: {message}");
        }
    }

    #[test]
    fn numbers_that_are_none_are_refused() {
        assert_names(&after(|s| s.robots[1].start.x = f64::NAN), &["mine", "start of robot-1", "NaN", "finite"]);
        assert_names(&after(|s| s.robots[2].set_point.y = f64::INFINITY), &["set_point of robot-2", "inf"]);
        assert_names(&after(|s| s.obstacles[1].position.y = 2e6), &["position of obstacle-1", "2000000"]);
        for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_names(&after(|s| s.robots[0].radius = Some(radius)), &["radius of robot-0", "above 0"]);
            assert_names(&after(|s| s.obstacles[0].radius = Some(radius)), &["radius of obstacle-0", "above 0"]);
        }
    }

    #[test]
    fn counts_outside_their_limits_are_refused() {
        assert_names(&after(|s| s.robots.clear()), &["no robots", "[[robot]]"]);
        assert_names(&after(|s| s.robots[0].max_speed = Some(0.0)), &["max_speed of robot-0 is 0 m/s", "above 0"]);
        let many = after(|s| {
            let robot = s.robots[0].clone();
            s.robots = vec![robot; 201];
        });
        assert_names(&many, &["201 robots are too many", "at most 200"]);
        assert_names(&after(|s| s.max_ticks = 0), &["max_ticks = 0", "1..=1000000"]);
        assert_names(&after(|s| s.seed = u64::MAX), &["seed = 18446744073709551615"]);
        assert_names(&after(|s| s.robots[1].name = "obstacle-0".into()), &["two entries are called `obstacle-0`"]);
    }

    #[test]
    fn starts_that_overlap_are_refused_unless_it_is_meant() {
        let close = |s: &mut Scenario| s.robots[1].start = s.robots[0].start + Position::new(1.4, 0.0);
        let message = after(close);
        assert_names(&message, &["robot-0 starts 1.4000 m from robot-1", "1.5000 m", "allow_close_start = true"]);
        let meant = after(|s| {
            close(s);
            s.allow_close_start = true;
        });
        assert_eq!(meant, "");
        let obstacle = after(|s| s.robots[2].start = s.obstacles[0].position + Position::new(0.0, 1.0));
        assert_names(&obstacle, &["robot-2 starts 1.0000 m from obstacle-0"]);
    }

    #[test]
    fn coincident_starts_are_refused_always() {
        let message = after(|s| {
            s.robots[1].start = s.robots[0].start;
            s.allow_close_start = true;
        });
        assert_names(&message, &["robot-0 and robot-1 are at the same place [2.5, 11] m"]);
    }

    #[test]
    fn set_points_that_cannot_be_filled_are_refused() {
        let robots = after(|s| s.robots[3].set_point = s.robots[2].set_point + Position::new(0.0, 1.49));
        assert_names(&robots, &["the set-point of robot-2 is 1.4900 m from that of robot-3", "can never"]);
        let obstacle = after(|s| {
            let position = s.robots[0].set_point + Position::new(-1.0, 0.0);
            s.obstacles.push(Obstacle { name: "late".into(), position, radius: None });
        });
        assert_names(&obstacle, &["the set-point of robot-0 is 1.0000 m from late"]);
    }

    /// `four_gate` with an obstacle of the given corners.
    fn with_polygon(corners: &[(f64, f64)]) -> Scenario {
        use world::shape::{Obstacle, Shape};
        let corners = corners.iter().map(|(x, y)| Position::new(*x, *y)).collect();
        let shapes = vec![Obstacle::new("shelf", Shape::Polygon(corners)).unwrap()];
        Scenario { shapes, ..good() }
    }

    #[test]
    fn robots_inside_a_shape_or_too_near_to_it_are_refused() {
        let start = good().robots[0].start;
        let square = |x: f64, half: f64| {
            let y = start.y;
            with_polygon(&[(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)])
        };
        let message = |scenario: &Scenario| scenario.validate_distances(1.5).unwrap_err().to_string();
        assert_names(&message(&square(start.x, 0.3)), &["start of robot-0", "lies inside shelf (0.3000 m deep)"]);
        let mut near = square(start.x - 1.0, 0.3);
        near.robots.truncate(1);
        assert_names(&message(&near), &["start of robot-0", "is 0.7000 m from shelf", "0.7500 m"]);
        near.allow_close_start = true;
        near.validate_distances(1.5).unwrap();
        near.robots[0].radius = Some(0.7);
        near.allow_close_start = false;
        near.validate_distances(1.5).unwrap();
    }

    #[test]
    fn a_set_point_that_is_shut_in_is_found_before_the_run_with_the_reason() {
        let goal = good().robots[0].set_point;
        let at = |x: f64, y: f64| (goal.x + x, goal.y + y);
        // A C round the set-point that is open by 1.2 m to the right.
        let shut = with_polygon(&[
            at(2.0, 0.6),
            at(2.0, 2.0),
            at(-2.0, 2.0),
            at(-2.0, -2.0),
            at(2.0, -2.0),
            at(2.0, -0.6),
            at(1.8, -0.6),
            at(1.8, -1.8),
            at(-1.8, -1.8),
            at(-1.8, 1.8),
            at(1.8, 1.8),
            at(1.8, 0.6),
        ]);
        let mut one = shut.clone();
        one.robots.truncate(1);
        let message = one.validate_ways(1.5).unwrap_err().to_string();
        assert_names(
            &message,
            &["robot-0 cannot reach its set-point", "1.200 m wide, between shelf and shelf", "1.500 m"],
        );
        one.robots[0].radius = Some(0.55);
        one.validate_ways(1.5).unwrap();
    }

    #[test]
    fn discs_may_touch_and_own_radii_count() {
        assert_eq!(after(|s| s.robots[1].start = s.robots[0].start + Position::new(1.5, 0.0)), "");
        let message = after(|s| s.robots[0].radius = Some(2.5));
        assert_names(&message, &["robot-0 starts 3.0000 m from robot-1", "3.2500 m"]);
        assert_eq!(good().validate_distances(3.0).map_err(|e| e.to_string()), Ok(()));
        assert!(good().validate_distances(3.1).is_err());
    }
}
