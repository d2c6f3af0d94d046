//! Why a robot did what it did: the collision rows of a tick, found again from what was published.
//!
//! Views, reports and logs show rows, which robots do not publish: they follow from the plans of tick k - 1, the
//! robot's memory of conflicts and the parameters. Whoever has all steps of a run in order finds them here.

use crate::conflict::memory::ConflictMemory;
use crate::conflict::rows::collision_rows;
use crate::controller::{Neighbour, View};
use crate::layout::Layout;
use crate::mpc::problem::Row;
use crate::params::{ControllerKind, Params};
use crate::step::{Status, Step};
use crate::vodca_controller::hazards;
use crate::way::Standing;
use crate::way::right_of_way::regard_others;
use std::sync::Arc;

/// Follows a run step by step and explains its newest tick.
#[derive(Clone, Debug)]
pub struct Explainer {
    params: Arc<Params>,
    layout: Arc<Layout>,
    /// Memory of every robot before the newest tick.
    memories: Vec<ConflictMemory>,
    /// What every robot did in the tick before the newest one; empty before the second tick.
    before: Vec<Step>,
    /// What every robot did in the newest tick.
    now: Vec<Step>,
    tick: u64,
}

impl Explainer {
    /// An explainer that has seen no tick yet.
    pub fn new(params: Arc<Params>, layout: Arc<Layout>) -> Self {
        let memories = vec![ConflictMemory::default(); layout.set_points.len()];
        Self { params, layout, memories, before: Vec::new(), now: Vec::new(), tick: 0 }
    }

    /// Takes in tick `tick`; `steps` is what every robot did, by robot number. Ticks come in order, from 0.
    pub fn observe(&mut self, tick: u64, steps: &[Step]) {
        if tick > 1 {
            for (memory, step) in self.memories.iter_mut().zip(&self.now) {
                // Rows depend on the memory of conflicts only, which the traffic ahead does not change.
                memory.remember(&self.params.aim, &self.params.vodca, step.rows as usize, 0.0);
            }
        }
        std::mem::swap(&mut self.before, &mut self.now);
        self.now.clear();
        self.now.extend_from_slice(steps);
        self.tick = tick;
    }

    /// What every robot did in the newest tick, by robot number.
    pub fn steps(&self) -> &[Step] {
        &self.now
    }

    /// The collision rows of `robot` in the newest tick; `None` where they are not found in the number that
    /// the robot reported (another controller, a disturbed exchange).
    pub fn rows(&self, robot: usize) -> Option<Vec<Row>> {
        let Self { params, layout, memories, before, now, tick } = self;
        let reported = now[robot].rows as usize;
        if reported == 0 {
            return Some(Vec::new());
        }
        if before.is_empty() || params.controller.kind != ControllerKind::Vodca {
            return None;
        }
        let heard = |(step, last): (&Step, &Step)| Neighbour {
            plan: Some((tick - 1, last.plan.clone())),
            present: Some((*tick, step.position)),
            set_point: last.plan.set_point,
            toward: last.plan.toward,
            lost: last.status == Status::Lost,
        };
        let neighbours: Vec<Neighbour> = now.iter().zip(before).map(heard).collect();
        let Step { horizon, position, .. } = now[robot];
        let view = View { tick: *tick, horizon, position, neighbours: &neighbours };
        let memory = &memories[robot];
        let (mut standing, mut regards) = (Standing::of(layout), Vec::new());
        regard_others(params, layout, robot, memory, &view, &mut standing, &mut regards);
        let hazards = hazards(params, layout, robot, &view, &regards);
        let (turn, min_separation) = (memory.turn(&params.vodca), params.model.min_separation);
        let mut rows = Vec::new();
        collision_rows(&params.vodca, min_separation, turn, &before[robot].plan, horizon, hazards, &mut rows);
        (rows.len() == reported).then_some(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::horizon::Horizon;
    use crate::params::Profile;
    use crate::scenario::set_up;
    use crate::team::Team;

    #[test]
    fn the_rows_of_every_tick_of_a_run_are_found_again() {
        for (scenario, profile) in [("ex14_d", Profile::Safe), ("ex14_b", Profile::Paper)] {
            let (scenario, params) = set_up(Some(scenario), None, profile, &[]).unwrap();
            let layout = Arc::new(Layout::of(&scenario, &params.model));
            let mut explainer = Explainer::new(Arc::new(params.clone()), layout);
            let mut team = Team::new(&scenario, &params, 0);
            let (mut rows, mut unknown) = (0, 0);
            for tick in 0..80 {
                let horizons: Vec<Horizon> = (0..14).map(|robot| Horizon::random(1, robot, tick)).collect();
                let steps = team.step(&horizons);
                explainer.observe(tick, steps);
                for (robot, step) in steps.iter().enumerate() {
                    rows += step.rows;
                    unknown += u32::from(explainer.rows(robot).is_none());
                }
            }
            assert!(rows > 100, "{profile}: only {rows} rows");
            assert_eq!(unknown, 0, "{profile}");
        }
    }
}
