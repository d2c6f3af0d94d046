//! Robots that stand where they want to be: others walk round them.
//!
//! Routes ([`super::Route`]) lead round what never moves. A robot whose disc covers its set-point stands as well,
//! for the time being.

use super::chains::Chains;
use super::corners::{Closed, is_free};
use super::robot_set::{MOST_STANDING, RobotSet};
use super::route::Route;
use crate::Position;
use crate::controller::View;
use crate::layout::Layout;
use crate::params::Params;

/// By how much robots that touch may seem to overlap, m.
const ROUNDING: f64 = 1e-6;

/// What stands, seen by one robot in one tick.
#[derive(Clone, Debug)]
pub struct Standing {
    /// What the centre of the robot must not enter while they stand: the robots that do.
    closed: Vec<Closed>,
    /// The robots that stand, by number.
    pub who: RobotSet,
    /// Those of them who cannot make room.
    pub tight: RobotSet,
    chains: Chains,
}

impl Standing {
    /// Room for all of `layout`.
    pub fn of(layout: &Layout) -> Self {
        let robots = layout.set_points.len();
        Self {
            closed: Vec::with_capacity(robots),
            who: RobotSet::default(),
            tight: RobotSet::default(),
            chains: Chains::with_capacity(robots + layout.obstacles.solids()),
        }
    }

    /// Looks at who stands in `view`, as `walker` has to keep away from it.
    pub fn look(&mut self, params: &Params, layout: &Layout, walker: usize, view: &View<'_>) {
        let min_separation = params.model.min_separation;
        self.closed.clear();
        (self.who, self.tight) = Default::default();
        let owed = |extra: f64| min_separation + layout.robot_extra[walker] + extra;
        for (other, neighbour) in view.neighbours.iter().enumerate().filter(|(other, _)| *other != walker) {
            let covers = |at: Position| (at - neighbour.set_point).norm() < 0.5 * min_separation;
            if neighbour.lost || !neighbour.present.is_some_and(|(_, at)| covers(at)) {
                continue;
            }
            let radius = owed(layout.robot_extra[other]);
            if (view.position - neighbour.set_point).norm() < radius - ROUNDING {
                continue; // Not in its place yet, as the walker is: nobody walks round what it is in.
            }
            self.closed.push(Closed { centre: neighbour.set_point, radius });
            if view.neighbours.len() > MOST_STANDING {
                continue;
            }
            self.who.add(other);
            if layout.is_tight(other, min_separation) {
                self.tight.add(other);
            }
        }
    }

    /// Whether those who stand, and what never moves for the robot of `route`, close the way between two places.
    pub fn shuts_in(&mut self, route: &Route, from: Position, to: Position) -> bool {
        let Self { closed, chains, .. } = self;
        !is_free(closed, from, to) && chains.separate(closed, route.ground(), from, to)
    }
}
