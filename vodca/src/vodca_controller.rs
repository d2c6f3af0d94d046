//! Variable-horizon MPC with VODCA: one robot, one tick. Profiles are switches of this one controller.

use crate::conflict::back_off;
use crate::conflict::memory::ConflictMemory;
use crate::conflict::rows::collision_rows;
use crate::conflict::traffic::{StraightMotion, Traffic};
use crate::conflict::{Hazard, PredictedMotion};
use crate::controller::{Controller, Decision, Neighbour, View};
use crate::horizon::{Horizon, MAX_HORIZON};
use crate::layout::Layout;
use crate::mpc::cross_check::Comparison;
use crate::mpc::ladder::Ladder;
use crate::mpc::problem::{Problem, Row, SlackPrice, Solution, SolveError, Target};
use crate::obstacles::Solid;
use crate::params::{Infeasible, Params, Reference};
use crate::prediction::Prediction;
use crate::reference;
use crate::safety::cell::{Cell, Last, Present};
use crate::safety::filter::{TOLERANCE, is_answer, nearest_safe};
use crate::step::{Level, Status};
use crate::way::Standing;
use crate::way::right_of_way::{Regard, regard_others, way_on};
use crate::way::{Path, Rest};
use crate::{Input, Position};
use std::f64::consts::SQRT_2;
use std::sync::Arc;
use std::time::Instant;

/// The controller of one robot.
pub struct VodcaController {
    robot: usize,
    params: Params,
    layout: Arc<Layout>,
    ladder: Ladder,
    target: Target,
    rows: Vec<Row>,
    cell: Cell,
    plan: Solution,
    previous: Option<Previous>,
    memory: ConflictMemory,
    traffic: Traffic,
    standing: Standing,
    rests: [[Rest; 2]; 2],
    /// The robot's way in this tick.
    way: Path,
    /// Where that makes it look, m.
    on: Position,
    /// By robot: how this one regards it.
    regards: Vec<Regard>,
}

/// The robot's own plan of tick k - 1.
struct Previous {
    prediction: Prediction,
    plan: Solution,
}

impl VodcaController {
    /// The controller of `robot`; everything a tick needs is allocated here.
    pub fn new(robot: usize, params: &Params, layout: &Arc<Layout>) -> Self {
        let robots = layout.set_points.len();
        let hazards = robots + layout.obstacles.solids();
        let stride = params.model.sample_time * layout.max_speed[robot];
        Self {
            robot,
            params: params.clone(),
            layout: layout.clone(),
            ladder: Ladder::default(),
            target: reference::empty_target(),
            rows: Vec::with_capacity(2 * hazards),
            cell: Cell::with_capacity(hazards, stride),
            plan: Solution::default(),
            previous: None,
            memory: ConflictMemory::default(),
            traffic: Traffic::with_capacity(robots, &params.aim),
            standing: Standing::of(layout),
            rests: rests(layout, robot),
            way: Path::straight(layout.set_points[robot], layout.set_points[robot]),
            on: layout.set_points[robot],
            regards: Vec::with_capacity(robots),
        }
    }

    /// Solves every QP a second time with Clarabel and compares. Allocates in every tick.
    pub fn checked(self) -> Self {
        Self { ladder: Ladder::checked(), ..self }
    }

    /// Rules 2 and 3: collision rows from the plans of tick k - 1. None at the first tick.
    fn detect(&mut self, view: &View<'_>) -> usize {
        self.rows.clear();
        let Some(previous) = &self.previous else { return 0 };
        let hazards = hazards(&self.params, &self.layout, self.robot, view, &self.regards);
        let min_separation = self.params.model.min_separation;
        let vodca = &self.params.vodca;
        let turn = self.memory.turn(vodca);
        collision_rows(vodca, min_separation, turn, &previous.prediction, view.horizon, hazards, &mut self.rows)
    }

    /// Rule 8: the right turn that the traffic ahead asks for, rad.
    fn look_ahead(&mut self, view: &View<'_>) -> f64 {
        let Self { params, layout, traffic, robot, .. } = self;
        let Params { model, aim, .. } = &*params;
        let stride = |robot: usize| model.sample_time * layout.max_speed[robot];
        let own = StraightMotion { from: view.position, to: self.on, stride: stride(*robot) };
        if aim.look_ahead == 0 || (own.to - own.from).norm() < aim.fade_start {
            return 0.0;
        }
        traffic.clear();
        for (other, neighbour) in view.neighbours.iter().enumerate().filter(|(other, _)| *other != *robot) {
            if let Some((_, from)) = neighbour.present.filter(|_| !neighbour.lost) {
                let separation = layout.owed(model.min_separation, *robot, other);
                traffic.add(StraightMotion { from, to: neighbour.toward, stride: stride(other) }, separation);
            }
        }
        traffic.turn(own)
    }

    /// Rule 1: the reference, aimed by rule 4.
    fn aim(&mut self, view: &View<'_>) {
        let Params { model, mpc, aim, vodca, .. } = &self.params;
        let (h, speed) = (model.sample_time, self.layout.max_speed[self.robot]);
        match mpc.reference {
            Reference::SetPoint => {
                reference::set_point(&mut self.target, self.layout.set_points[self.robot], view.horizon);
            }
            Reference::Straight | Reference::Route => {
                let mut way = self.way;
                if self.memory.backs_off(vodca) {
                    let to = self.on;
                    let off = back_off::aim(self.robot, view.tick, view.position, to, 2.0 * model.min_separation);
                    if off != to {
                        way = Path::straight(view.position, off);
                    }
                }
                let way = way.turned(view.position, -self.memory.aim * aim.fade(way.length));
                reference::along(&mut self.target, view.position, way.points(), view.horizon, h, speed);
            }
        }
    }

    /// Rule 5: the cell of this tick from the broadcast positions.
    fn bound_cell(&mut self, view: &View<'_>) {
        self.cell.clear();
        if !self.params.cell.enabled {
            return;
        }
        let own = match &self.previous {
            Some(previous) => previous.prediction.state(1),
            // It begins anew; the others build their cells from where it was announced to stand.
            None if view.tick > 0 => view.neighbours[self.robot].present.map_or(view.position, |(_, at)| at),
            None => view.position,
        };
        let Self { robot, layout, cell, params, .. } = self;
        let noise = params.cell.noise_bound;
        let escape = params.cell.escape + noise;
        let usual = params.cell.separation + 3.0 * noise;
        for (other, neighbour) in view.neighbours.iter().enumerate().filter(|(other, _)| other != robot) {
            let separation = layout.owed(usual, *robot, other);
            let stride = params.model.sample_time * layout.max_speed[other];
            match neighbour.present {
                _ if neighbour.lost => {} // an obstacle of the layout
                Some((tick, position)) if tick == view.tick => {
                    let present = Present { position, separation, moves: Some(stride) };
                    cell.keep_away(own, &present, escape, *robot < other);
                }
                Some((tick, last)) => {
                    cell.stay_near(
                        own,
                        &Last { position: last, age: view.tick.saturating_sub(tick), stride },
                        separation,
                    );
                }
                None => cell.reach = 0.0,
            }
        }
        let reach = usual + layout.robot_extra[*robot] + SQRT_2 * cell.stride;
        for obstacle in layout.obstacles.near(own, reach) {
            let disc = obstacle.seen_from(own);
            let separation = layout.owed_to_obstacle(usual, *robot, &disc);
            let present = Present { position: disc.centre, separation, moves: None };
            cell.keep_away(own, &present, escape, true);
        }
        self.rows.extend(self.cell.as_rows(view.position));
    }

    /// The ladder, then what the method does when the hard rows admit nothing or nobody finishes.
    fn solve(&mut self, view: &View<'_>, collision_rows: usize) -> (Level, Status) {
        match self.run_ladder(view) {
            Ok(level) => return (level, Status::Solved),
            Err(SolveError::Infeasible) if self.params.vodca.infeasible == Infeasible::Hold => {
                self.plan = Solution::default();
                return (Level::Fallback, Status::Held);
            }
            Err(SolveError::Infeasible) => {
                self.rows[..collision_rows].iter_mut().for_each(|row| row.hard = false);
                if let Ok(level) = self.run_ladder(view) {
                    return (level, Status::Relaxed);
                }
            }
            Err(SolveError::GaveUp { .. }) => {}
        }
        (Level::Fallback, self.fall_back(view.horizon))
    }

    fn run_ladder(&mut self, view: &View<'_>) -> Result<Level, SolveError> {
        let Params { model, mpc, vodca, .. } = &self.params;
        let problem = Problem {
            horizon: view.horizon,
            position: view.position,
            target: &self.target,
            rows: &self.rows,
            slack: SlackPrice { linear: vodca.slack_linear, quadratic: vodca.slack_quadratic },
            sample_time: model.sample_time,
            max_speed: self.layout.max_speed[self.robot],
            state_weight: mpc.state_weight,
            input_weight: mpc.input_weight,
        };
        self.ladder.solve(&problem, &mut self.plan)
    }

    /// No solver finished: the previous plan one step later, or standing still.
    fn fall_back(&mut self, horizon: Horizon) -> Status {
        self.plan = Solution::default();
        let Some(previous) = &self.previous else { return Status::Stopped };
        let still_planned = previous.plan.inputs.iter().skip(1).take(horizon.steps());
        for (to, from) in self.plan.inputs.iter_mut().zip(still_planned) {
            *to = *from;
        }
        Status::Shifted
    }

    /// Rule 6, then the plan that everybody sees: bounded inputs rolled out by the model, never the
    /// solver's own states, so that state(1) is where the robot will be.
    fn publish(&mut self, view: &View<'_>) -> (Prediction, bool) {
        let (model, speed) = (&self.params.model, self.layout.max_speed[self.robot]);
        let inputs = &mut self.plan.inputs[..view.horizon.steps()];
        for input in inputs.iter_mut() {
            *input = input.map(|axis| bounded(axis, speed));
        }
        let mut filtered = false;
        if self.params.cell.enabled {
            let (step, changed) = nearest_safe(inputs[0] * model.sample_time, &self.cell);
            if changed {
                inputs[0] = (step / model.sample_time).map(|axis| bounded(axis, speed));
                filtered = true;
            }
            debug_assert!(is_answer(inputs[0] * model.sample_time, &self.cell, 2.0 * TOLERANCE));
        }
        let set_point = self.layout.set_points[self.robot];
        let plan = Prediction::roll_out(view.position, set_point, model.sample_time, inputs);
        (plan.looking(self.on), filtered)
    }
}

/// Room for what is left of the ways of `robot`.
fn rests(layout: &Layout, robot: usize) -> [[Rest; 2]; 2] {
    [&layout.routes[robot], &layout.outside[robot]].map(|route| [Rest::of(route), Rest::of(route)])
}

/// `axis` within +-`bound`, m/s; what is not a number becomes standing still.
fn bounded(axis: f64, bound: f64) -> f64 {
    if axis.is_nan() { 0.0 } else { axis.clamp(-bound, bound) }
}

impl Controller for VodcaController {
    fn tick(&mut self, view: &View<'_>) -> Decision {
        let started = Instant::now();
        let Self { params, layout, robot, standing, memory, regards, rests, .. } = self;
        regard_others(params, layout, *robot, memory, view, standing, regards);
        self.way = way_on(params, layout, *robot, view, standing, rests);
        self.on = self.way.ahead(view.position);
        let rows = self.detect(view);
        let turn = self.look_ahead(view);
        self.memory.remember(&self.params.aim, &self.params.vodca, rows, turn);
        self.aim(view);
        self.bound_cell(view);
        let solving = Instant::now();
        let detect_ns = (solving - started).as_nanos() as u64;
        let (level, status) = self.solve(view, rows);
        let solve_ns = solving.elapsed().as_nanos() as u64;
        let (prediction, filtered) = self.publish(view);
        let input: Input = self.plan.inputs[0];
        self.previous = Some(Previous { prediction: prediction.clone(), plan: self.plan.clone() });
        Decision { input, plan: prediction, rows: rows as u32, level, status, filtered, detect_ns, solve_ns }
    }

    fn restart(&mut self) {
        self.previous = None;
        self.memory = ConflictMemory::default();
    }

    fn lay_out(&mut self, layout: &Arc<Layout>) {
        let hazards = layout.set_points.len() + layout.obstacles.solids();
        self.rests = rests(layout, self.robot);
        self.standing = Standing::of(layout);
        self.rows.reserve(2 * hazards);
        self.cell.rows.reserve(hazards);
        self.layout = layout.clone();
    }

    fn comparison(&self) -> Option<Comparison> {
        self.ladder.comparison()
    }
}

/// What `robot` must keep away from in the tick of `view`: every neighbour that was heard of, then every
/// obstacle. Asks for a tick after the first one.
pub fn hazards<'a>(
    params: &'a Params,
    layout: &'a Layout,
    robot: usize,
    view: &'a View<'a>,
    regards: &'a [Regard],
) -> impl Iterator<Item = Hazard<'a>> + Clone {
    // Never more than the layout has room for.
    let room = if params.mpc.reference == Reference::Route { layout.room[robot] / 2.0 } else { f64::INFINITY };
    let clearance = params.give_way.clearance.min(room);
    let usual = params.model.min_separation;
    let others = view.neighbours.iter().enumerate().filter(move |(other, _)| *other != robot);
    let neighbours = others.filter_map(move |(other, neighbour)| {
        let separation = layout.owed(usual, robot, other);
        let wish = || wish(params.model.sample_time * layout.max_speed[other], neighbour);
        if neighbour.lost || regards[other] == Regard::Stays {
            return None;
        }
        if let Some(course) = (regards[other] == Regard::Wish).then(wish).flatten() {
            return Some(Hazard { course, separation: separation + clearance });
        }
        let (tick, plan) = neighbour.plan.as_ref()?;
        let age = (view.tick - 1).saturating_sub(*tick) as usize;
        Some(Hazard { course: PredictedMotion::Plan { plan, age }, separation })
    });
    // No plan reaches farther.
    let stride = params.model.sample_time * layout.max_speed[robot];
    let reach = SQRT_2 * stride * MAX_HORIZON as f64 + usual + layout.robot_extra[robot];
    let obstacles = layout.obstacles.near(view.position, reach).map(move |solid| match solid {
        Solid::Disc(disc) => Hazard {
            course: PredictedMotion::Still(disc.centre),
            separation: layout.owed_to_obstacle(usual, robot, disc),
        },
        Solid::Piece(..) => {
            Hazard { course: PredictedMotion::Shape(solid), separation: usual + layout.robot_extra[robot] }
        }
    });
    neighbours.chain(obstacles)
}

/// Rule 3: a robot near its set-point, or without patience, lets those pass that still have farther to go
/// than its own way, by keeping away from where they wish to walk, `stride` (m) in a tick. (A plan that already
/// avoids a parked robot shows no conflict.)
fn wish<'a>(stride: f64, neighbour: &Neighbour) -> Option<PredictedMotion<'a>> {
    let (_, from) = neighbour.present?;
    Some(PredictedMotion::Wish { from, to: neighbour.toward, stride })
}
