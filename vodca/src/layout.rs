//! What every robot knows for the whole run.

use crate::Position;
use crate::geometry::{Disc, NO_DIRECTION, turned};
use crate::obstacles::Obstacles;
use crate::params::Model;
use crate::scenario::{Obstacle, Robot, Scenario};
use crate::way::{Filling, Route, Ways};

/// Set-points, sizes, speeds and obstacles of a team.
#[derive(Clone, Debug)]
pub struct Layout {
    /// Set-points by robot number, m.
    pub set_points: Vec<Position>,
    /// Radius of each robot beyond min_separation / 2, m.
    pub robot_extra: Vec<f64>,
    /// Bound on each robot's input per axis, m/s.
    pub max_speed: Vec<f64>,
    /// What stands.
    pub obstacles: Obstacles,
    /// Ways round the obstacles by robot number.
    pub routes: Vec<Route>,
    /// Ways to where a robot waits for its turn, by robot number.
    pub outside: Vec<Route>,
    /// Whose turn comes before whose.
    pub filling: Filling,
    /// By robot: how much more than the separation owed its set-point leaves to the nearest other set-point or
    /// obstacle, m.
    pub room: Vec<f64>,
}

impl Layout {
    /// The layout of a scenario; discs without a radius of their own have min_separation / 2, robots without a speed of
    /// their own `model.max_speed`.
    pub fn of(scenario: &Scenario, model: &Model) -> Self {
        let min_separation = model.min_separation;
        let set_points: Vec<Position> = scenario.robots.iter().map(|robot| robot.set_point).collect();
        let robot_extra: Vec<f64> = scenario.robots.iter().map(|robot| robot.extra_radius(min_separation)).collect();
        let obstacles = scenario.standing(min_separation);
        let owed: Vec<f64> = robot_extra.iter().map(|extra| min_separation + extra).collect();
        let places: Vec<Disc> =
            set_points.iter().zip(&robot_extra).map(|(&centre, &extra)| Disc { centre, extra }).collect();
        let room = (0..set_points.len())
            .map(|robot| {
                let left = |at: Position, extra: f64| (at - set_points[robot]).norm() - owed[robot] - extra;
                let others = (0..set_points.len()).filter(|&other| other != robot);
                let others = others.map(|other| left(set_points[other], robot_extra[other]));
                let near = obstacles.near(set_points[robot], 2.0 * owed[robot]);
                let discs = near.map(|solid| solid.seen_from(set_points[robot]));
                let all = others.chain(discs.map(|disc| left(disc.centre, disc.extra)));
                all.fold(f64::INFINITY, f64::min).max(0.0)
            })
            .collect::<Vec<f64>>();
        let max_speed = (0..set_points.len()).map(|robot| scenario.max_speed(robot, model.max_speed)).collect();
        let Ways { routes, outside, filling } = Ways::new(&places, &owed, &obstacles, min_separation);
        Self { set_points, robot_extra, max_speed, obstacles, routes, outside, filling, room }
    }

    /// The layout of a scenario in which lost robots stand: `lost` says where (m), by robot number. Their bodies are
    /// obstacles after the scenario's own. Whose set-point a body closes goes as near to it as it can instead of
    /// standing in the way of others.
    pub fn with_lost(scenario: &Scenario, model: &Model, lost: &[Option<Position>]) -> Self {
        let min_separation = model.min_separation;
        let mut scenario = scenario.clone();
        for (robot, at) in lost.iter().enumerate() {
            let Some(position) = *at else { continue };
            for other in (0..scenario.robots.len()).filter(|&other| lost.get(other).is_some_and(Option::is_none)) {
                scenario.robots[other].set_point = beside(&scenario, min_separation, other, robot, position);
            }
            let Robot { name, radius, .. } = &scenario.robots[robot];
            scenario.obstacles.push(Obstacle { name: name.clone(), position, radius: *radius });
        }
        Self::of(&scenario, model)
    }

    /// Whether `robot` cannot make room at its set-point: two that stand side by side, each with a third of a
    /// separation to spare, let one through.
    pub fn is_tight(&self, robot: usize, min_separation: f64) -> bool {
        self.room[robot] < min_separation / 3.0 - 1e-6
    }

    /// The separation between `robot` and robot `other`, m, where two discs of the usual size keep `usual`.
    pub fn owed(&self, usual: f64, robot: usize, other: usize) -> f64 {
        usual + self.robot_extra[robot] + self.robot_extra[other]
    }

    /// The separation between `robot` and `obstacle`, m, where two discs of the usual size keep `usual`.
    pub fn owed_to_obstacle(&self, usual: f64, robot: usize, obstacle: &Disc) -> f64 {
        usual + self.robot_extra[robot] + obstacle.extra
    }
}

/// The set-point of `robot`, or, if the `body` (m) of robot `lost` is nearer to it than is owed, the place nearest to it
/// beside that body that leaves room for all other set-points and obstacles. The set-point where there is none.
fn beside(scenario: &Scenario, min_separation: f64, robot: usize, lost: usize, body: Position) -> Position {
    /// Directions that are tried to either side.
    const TURNS: i32 = 24;
    let set_point = scenario.robots[robot].set_point;
    let owed = |extra: f64| min_separation + scenario.extra_radius(robot, min_separation) + extra;
    let (off, radius) = (set_point - body, owed(scenario.extra_radius(lost, min_separation)));
    if off.norm() >= radius {
        return set_point;
    }
    let straight = if off.norm() < NO_DIRECTION { Position::new(1.0, 0.0) } else { off.normalize() };
    let standing = scenario.standing(min_separation);
    let is_free = |place: &Position| {
        let others = scenario.robots.iter().enumerate().filter(|(other, _)| *other != robot && *other != lost);
        let mut others = others.map(|(_, other)| (other.set_point, other.extra_radius(min_separation)));
        let clear = |(at, extra): (Position, f64)| (at - place).norm() >= owed(extra);
        let mut near = standing.near(*place, 2.0 * owed(0.0)).map(|solid| solid.seen_from(*place));
        others.all(clear) && near.all(|disc| clear((disc.centre, disc.extra)))
    };
    let step = std::f64::consts::PI / f64::from(TURNS);
    let turns = (0..=TURNS).flat_map(|turn| [turn, -turn]);
    let places = turns.map(|turn| body + turned(straight, f64::from(turn) * step) * radius);
    places.into_iter().find(is_free).unwrap_or(set_point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Params;

    #[test]
    fn a_set_point_that_a_lost_body_closes_moves_beside_it_and_others_stay() {
        let scenario = Scenario::resolve(Some("ex14_d"), None).unwrap();
        let body = scenario.robots[2].set_point + Position::new(-1.0, 0.3);
        let mut lost = vec![None; 14];
        lost[5] = Some(body);
        let model = Params::safe().model;
        let (usual, layout) = (Layout::of(&scenario, &model), Layout::with_lost(&scenario, &model, &lost));
        assert!(layout.obstacles.near(body, 0.1).any(|solid| solid.seen_from(body).centre == body));
        for robot in 0..14 {
            let (before, after) = (usual.set_points[robot], layout.set_points[robot]);
            if (before - body).norm() >= 1.5 {
                assert_eq!(before, after, "robot {robot}");
            } else if robot != 5 {
                assert!(((after - body).norm() - 1.5).abs() < 1e-9, "robot {robot}: {after}");
            }
        }
        assert!(layout.set_points[2] != usual.set_points[2]);
        assert_eq!(Layout::with_lost(&scenario, &model, &[None; 14]).set_points, usual.set_points);
    }
}
