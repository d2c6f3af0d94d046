//! Optimal reciprocal collision avoidance (van den Berg, Guy, Lin and Manocha, 2011): the baseline.
//!
//! Speeds are bounded by norm, as in RVO2. Obstacles are discs at rest that do not give way, so a robot
//! takes the whole responsibility for them; a piece of a polygon or a wall is the disc of radius 0 at its nearest point.

use super::half_planes::{HalfPlane, cross, nearest_velocity};
use crate::controller::{Controller, Decision, View};
use crate::geometry::{in_disc, turned};
use crate::layout::Layout;
use crate::params::Params;
use crate::prediction::Prediction;
use crate::random::Use;
use crate::step::{Level, Status};
use crate::{Input, Position};
use std::sync::Arc;

/// One robot driven by ORCA.
pub struct OrcaController {
    robot: usize,
    seed: u64,
    params: Params,
    layout: Arc<Layout>,
    velocity: Input,
    seen: Vec<(f64, usize)>,
    planes: Vec<HalfPlane>,
    scratch: Vec<HalfPlane>,
}

/// Another disc as ORCA sees it.
#[derive(Clone, Copy, Debug)]
struct Disc {
    /// Its centre relative to the robot's, m.
    offset: Position,
    /// Velocity of the robot relative to it, m/s.
    relative_velocity: Input,
    /// Sum of the radii, m.
    radii: f64,
    /// Share of the avoidance this robot takes: 1/2 of a robot, all of an obstacle.
    share: f64,
}

impl OrcaController {
    /// The controller of `robot`; everything a tick needs is allocated here. `seed` feeds `orca.push`.
    pub fn new(robot: usize, params: &Params, layout: &Arc<Layout>, seed: u64) -> Self {
        let discs = layout.set_points.len() + layout.obstacles.solids();
        Self {
            robot,
            seed,
            params: params.clone(),
            layout: layout.clone(),
            velocity: Input::zeros(),
            seen: Vec::with_capacity(discs),
            planes: Vec::with_capacity(discs),
            scratch: Vec::with_capacity(discs),
        }
    }

    /// Along the shortest way round the obstacles, turned right by `orca.aim`, no faster than arrives within the tick, and
    /// pushed by a draw of `orca.push`: exact symmetry would hold robots in front of each other for ever.
    fn preferred_velocity(&self, position: Position, tick: u64) -> Input {
        let model = &self.params.model;
        let path = self.layout.routes[self.robot].path(position);
        let step = path.after(position, self.layout.max_speed[self.robot] * model.sample_time) - position;
        let straight = step / model.sample_time;
        // A constant turn circles the set-point at the end: a full tick's way is lost there.
        let aim = self.params.orca.aim * (path.length / self.params.orca.fade).min(1.0);
        turned(straight, -aim) + in_disc(self.params.orca.push, self.seed, Use::Push, self.robot, tick)
    }

    /// Half planes of obstacles first: they stay hard when the robots' planes cannot all be met.
    fn look_around(&mut self, view: &View<'_>) -> usize {
        let orca = &self.params.orca;
        let (layout, usual) = (&self.layout, self.params.model.min_separation);
        let h = self.params.model.sample_time;
        self.planes.clear();
        for obstacle in layout.obstacles.near(view.position, orca.neighbour_distance) {
            let seen = obstacle.seen_from(view.position);
            let offset = seen.centre - view.position;
            let radii = layout.owed_to_obstacle(usual, self.robot, &seen);
            let disc = Disc { offset, relative_velocity: self.velocity, radii, share: 1.0 };
            if offset.norm() < orca.neighbour_distance {
                self.planes.push(half_plane(&disc, self.velocity, orca.time_horizon, h));
            }
        }
        let fixed = self.planes.len();
        self.seen.clear();
        for (other, neighbour) in view.neighbours.iter().enumerate().filter(|(other, _)| *other != self.robot) {
            let Some((_, present)) = neighbour.present.filter(|_| !neighbour.lost) else { continue };
            let distance = (present - view.position).norm();
            if distance < orca.neighbour_distance {
                self.seen.push((distance, other));
            }
        }
        self.seen.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for &(_, other) in self.seen.iter().take(orca.max_neighbours) {
            let neighbour = &view.neighbours[other];
            let Some((_, present)) = neighbour.present else { continue };
            let moving = |plan: &Prediction| (plan.state(1) - plan.state(0)) / h;
            let velocity = neighbour.plan.as_ref().map_or(Input::zeros(), |(_, plan)| moving(plan));
            let disc = Disc {
                offset: present - view.position,
                relative_velocity: self.velocity - velocity,
                radii: layout.owed(usual, self.robot, other),
                share: 0.5,
            };
            self.planes.push(half_plane(&disc, self.velocity, orca.time_horizon, h));
        }
        fixed
    }
}

/// The velocities that avoid `disc` for `time_horizon` seconds, or part from it within a tick where the
/// discs already overlap.
fn half_plane(disc: &Disc, velocity: Input, time_horizon: f64, sample_time: f64) -> HalfPlane {
    let Disc { offset, relative_velocity, radii, share } = *disc;
    let distance_squared = offset.norm_squared();
    let overlapping = distance_squared <= radii * radii;
    let time = if overlapping { sample_time } else { time_horizon };
    let from_centre = relative_velocity - offset / time;
    let toward = from_centre.dot(&offset);
    let (direction, correction);
    if overlapping || (toward < 0.0 && toward * toward > radii * radii * from_centre.norm_squared()) {
        // Nearest point of the velocity obstacle lies on its cut-off circle.
        let length = from_centre.norm();
        let outward = if length > 1e-12 { from_centre / length } else { Input::new(1.0, 0.0) };
        direction = Input::new(outward.y, -outward.x);
        correction = outward * (radii / time - length);
    } else {
        // It lies on one of its legs.
        let leg = (distance_squared - radii * radii).max(0.0).sqrt();
        let left = cross(offset, from_centre) > 0.0;
        let side = if left { 1.0 } else { -1.0 };
        let along = Input::new(offset.x * leg - side * offset.y * radii, side * offset.x * radii + offset.y * leg)
            / distance_squared;
        direction = along * side;
        correction = direction * relative_velocity.dot(&direction) - relative_velocity;
    }
    HalfPlane { point: velocity + correction * share, direction }
}

impl Controller for OrcaController {
    fn restart(&mut self) {
        self.velocity = Input::zeros();
    }

    fn lay_out(&mut self, layout: &Arc<Layout>) {
        self.layout = layout.clone();
    }

    fn tick(&mut self, view: &View<'_>) -> Decision {
        let fixed = self.look_around(view);
        let wanted = self.preferred_velocity(view.position, view.tick);
        let (model, speed) = (&self.params.model, self.layout.max_speed[self.robot]);
        let input = nearest_velocity(&self.planes, fixed, speed, wanted, &mut self.scratch);
        self.velocity = input;
        let set_point = self.layout.set_points[self.robot];
        // What it will do next is not planned: the velocity is published for one step.
        let plan = Prediction::roll_out(view.position, set_point, model.sample_time, &[input]);
        let rows = self.planes.len() as u32;
        Decision {
            input,
            plan,
            rows,
            level: Level::Baseline,
            status: Status::Solved,
            filtered: false,
            detect_ns: 0,
            solve_ns: 0,
        }
    }
}
