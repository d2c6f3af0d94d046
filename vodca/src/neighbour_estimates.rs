//! What a robot knows of the others, disturbed on purpose where the parameters say so. Draws depend on seed, tick, sender and listener only.

use crate::Position;
use crate::controller::Neighbour;
use crate::membership::State;
use crate::params::Disturbance;
use crate::prediction::Prediction;
use crate::random::{self, Use};
use crate::scenario::Scenario;

/// What one robot has heard of all others.
#[derive(Clone, Debug)]
pub struct NeighbourEstimates {
    listener: usize,
    seed: u64,
    disturbance: Disturbance,
    neighbours: Vec<Neighbour>,
    /// Set-points of the scenario by robot number, m.
    set_points: Vec<Position>,
    /// Plans under way, `plan_delay` per sender, oldest first from `tick % plan_delay`.
    under_way: Vec<Option<(u64, Prediction)>>,
}

impl NeighbourEstimates {
    /// What `listener` knows before tick 0: the starts of the scenario.
    pub fn new(listener: usize, scenario: &Scenario, disturbance: &Disturbance, seed: u64) -> Self {
        let robots = &scenario.robots;
        Self {
            listener,
            seed,
            disturbance: disturbance.clone(),
            neighbours: robots.iter().map(|robot| Neighbour::at_start(robot.start, robot.set_point)).collect(),
            set_points: robots.iter().map(|robot| robot.set_point).collect(),
            under_way: vec![None; robots.len() * disturbance.plan_delay],
        }
    }

    /// All robots by number, as [`crate::controller::View`] wants them.
    pub fn neighbours(&self) -> &[Neighbour] {
        &self.neighbours
    }

    /// Takes the plan that robot `sender` computed at `tick`.
    pub fn hear(&mut self, tick: u64, sender: usize, plan: &Prediction) {
        let Disturbance { plan_delay, plan_loss, position_loss, .. } = self.disturbance;
        let lost = sender != self.listener && self.is_lost(position_loss, tick, sender, 0);
        if !lost {
            let neighbour = &mut self.neighbours[sender];
            neighbour.present = Some((tick + 1, plan.state(1)));
            neighbour.set_point = plan.set_point;
            neighbour.toward = plan.toward;
        }
        let news = !lost && !self.is_lost(plan_loss, tick, sender, 1);
        if plan_delay == 0 {
            match &mut self.neighbours[sender].plan {
                _ if !news => {}
                Some((at, held)) => {
                    *at = tick;
                    held.clone_from(plan);
                }
                none => *none = Some((tick, plan.clone())),
            }
            return;
        }
        // What is under way moves on even when this message is lost: otherwise a plan would stay in its
        // slot and arrive after newer ones.
        let slot = sender * plan_delay + (tick as usize) % plan_delay;
        let arrived = std::mem::replace(&mut self.under_way[slot], news.then(|| (tick, plan.clone())));
        if arrived.is_some() {
            self.neighbours[sender].plan = arrived;
        }
    }

    /// Takes note that robot `sender` did not take part in the tick before `tick` and stands at `at` (m), which
    /// everybody is told. What was heard of it otherwise does not count.
    pub fn note_absent(&mut self, tick: u64, sender: usize, state: State, at: Position) {
        let delay = self.disturbance.plan_delay;
        self.under_way[sender * delay..(sender + 1) * delay].fill(None);
        let lost = state == State::Lost;
        let set_point = if lost { at } else { self.set_points[sender] };
        let plan = tick.checked_sub(1).map(|planned| (planned, Prediction::standing(at, set_point)));
        let present = Some((tick, at));
        self.neighbours[sender] = Neighbour { plan, present, set_point, toward: set_point, lost };
    }

    /// The listener begins anew with tick `tick`: it keeps what came with the plans of the tick before, and nothing
    /// older.
    pub fn restart(&mut self, tick: u64) {
        let is_new = |at: u64| at + 1 == tick;
        self.under_way.iter_mut().for_each(|plan| *plan = plan.take().filter(|(at, _)| is_new(*at)));
        for (neighbour, &set_point) in self.neighbours.iter_mut().zip(&self.set_points) {
            neighbour.plan = neighbour.plan.take().filter(|(at, _)| is_new(*at));
            if neighbour.present.is_none_or(|(at, _)| at != tick) {
                *neighbour = Neighbour { plan: None, present: None, set_point, toward: set_point, lost: false };
            }
        }
    }

    /// What another listener would know that has heard the same.
    pub fn for_listener(&self, listener: usize) -> Self {
        Self { listener, ..self.clone() }
    }

    fn is_lost(&self, share: f64, tick: u64, sender: usize, what: u64) -> bool {
        if share == 0.0 {
            return false;
        }
        let pair = (sender as u64) << 32 | (self.listener as u64) << 1 | what;
        random::unit(&mut random::stream(self.seed, Use::Loss, pair, tick)) < share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hearing(disturbance: Disturbance) -> NeighbourEstimates {
        let scenario = Scenario::resolve(Some("two_setpoint"), None).unwrap();
        NeighbourEstimates::new(0, &scenario, &disturbance, 1)
    }

    fn plan(x: f64) -> Prediction {
        Prediction::from_states(&[Position::new(x, 0.0), Position::new(x + 1.0, 0.0)], Position::zeros())
    }

    const CALM: Disturbance = Disturbance { noise: 0.0, plan_delay: 0, plan_loss: 0.0, position_loss: 0.0 };

    #[test]
    fn late_plans_come_in_order_and_positions_at_once() {
        let mut hearing = hearing(Disturbance { plan_delay: 2, ..CALM });
        for tick in 0..5 {
            hearing.hear(tick, 1, &plan(tick as f64));
            assert_eq!(hearing.neighbours()[1].present, Some((tick + 1, Position::new(tick as f64 + 1.0, 0.0))));
            let heard = hearing.neighbours()[1].plan.as_ref().map(|(at, _)| *at);
            assert_eq!(heard, tick.checked_sub(2));
        }
    }

    #[test]
    fn lost_messages_neither_hold_late_plans_up_nor_bring_old_ones_back() {
        for (plan_delay, plan_loss) in [(1, 0.0), (3, 0.0), (3, 0.4)] {
            let mut hearing = hearing(Disturbance { plan_delay, plan_loss, position_loss: 0.4, ..CALM });
            let arrives = |hearing: &NeighbourEstimates, tick| {
                !hearing.is_lost(0.4, tick, 1, 0) && !hearing.is_lost(plan_loss, tick, 1, 1)
            };
            let (mut due, mut lost) = (None, 0);
            for tick in 0..500 {
                hearing.hear(tick, 1, &plan(tick as f64));
                let sent = tick.checked_sub(plan_delay as u64);
                let news = sent.filter(|&sent| arrives(&hearing, sent));
                lost += u32::from(sent.is_some() && news.is_none());
                due = news.or(due);
                let (at, heard) = hearing.neighbours()[1].plan.clone().unzip();
                assert_eq!(at, due, "delay {plan_delay}, tick {tick}");
                assert_eq!(heard.map(|plan| plan.state(0).x), due.map(|due| due as f64));
            }
            assert!(lost > 100, "{lost} of 500 were lost");
        }
    }

    #[test]
    fn the_stated_share_is_lost_and_own_messages_never() {
        let mut hearing = hearing(Disturbance { position_loss: 0.3, ..CALM });
        let mut heard = 0;
        for tick in 0..2000 {
            hearing.hear(tick, 1, &plan(0.0));
            heard += u64::from(hearing.neighbours()[1].present.unwrap().0 == tick + 1);
            hearing.hear(tick, 0, &plan(0.0));
            assert_eq!(hearing.neighbours()[0].present.unwrap().0, tick + 1);
        }
        assert!((1300..1500).contains(&heard), "{heard} of 2000");
    }
}
