//! Where the robots of a run go at run time: its tasks, and orders from outside.

use crate::orders::Inbox;
use std::path::Path;
use vodca::Position;
use vodca::membership::{Membership, State};
use vodca::tasks::{Assignment, Tasks};

/// Gives robots their set-points tick by tick.
#[derive(Debug)]
pub(crate) struct Destinations {
    /// `None`: everybody goes where the scenario says, whatever is ordered.
    tasks: Option<Tasks>,
    inbox: Inbox,
    /// What has changed with the newest tick.
    assigned: Vec<Assignment>,
    /// Everybody's set-point, m; empty while all are the scenario's.
    set_points: Vec<Position>,
}

impl Destinations {
    /// Of the run in the folder `run`.
    pub(crate) fn new(tasks: Option<Tasks>, run: &Path) -> Self {
        Self { tasks, inbox: Inbox::of(run), assigned: Vec::new(), set_points: Vec::new() }
    }

    /// What has changed with the newest tick.
    pub(crate) fn assigned(&self) -> &[Assignment] {
        &self.assigned
    }

    /// Everybody's set-point, m, by robot number; empty while all are the scenario's.
    pub(crate) fn set_points(&self) -> &[Position] {
        &self.set_points
    }

    /// Whether somebody who is not lost has something left to do: who is late is heard again.
    pub(crate) fn is_pending(&self, membership: &Membership) -> bool {
        self.tasks.as_ref().is_some_and(|tasks| tasks.is_pending(|robot| membership.state(robot) != State::Lost))
    }

    /// Decides where everybody goes from tick `tick` on; `measured` is where everybody is then, m, by robot number.
    pub(crate) fn hand_out(&mut self, tick: u64, measured: &[Position], membership: &Membership) {
        self.assigned.clear();
        let Some(tasks) = &mut self.tasks else { return };
        let takes_part = |robot: usize| membership.state(robot).takes_part();
        self.inbox.answer_all(tasks.scenario().robots.len(), |order| {
            if !takes_part(order.robot) {
                return Err(format!("robot {} is lost or late: it goes nowhere now", order.robot));
            }
            tasks.redirect(order.robot, order.set_point).map_err(|error| error.to_string())?;
            self.assigned.push(Assignment { tick, robot: order.robot, set_point: order.set_point });
            Ok(tick)
        });
        self.assigned.extend(tasks.assign(tick, measured, takes_part));
        if !self.assigned.is_empty() {
            self.set_points.clear();
            self.set_points.extend(tasks.scenario().robots.iter().map(|robot| robot.set_point));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vodca::params::Params;
    use vodca::scenario::Scenario;
    use vodca::tasks::Task;

    #[test]
    fn a_run_is_not_over_while_a_late_robot_has_a_task() {
        let scenario = Scenario::resolve(Some("ring:2"), None).unwrap();
        let mut tasks = Tasks::new(&scenario, &Params::safe());
        tasks.add(Task { robot: 1, set_point: Position::zeros(), after: 0 });
        let place = tempfile::tempdir().unwrap();
        let destinations = Destinations::new(Some(tasks), place.path());
        let mut membership = Membership::new(2);
        assert!((0..2).all(|robot| membership.join(robot, 1, 0)));
        membership.begin(0);
        assert!(membership.miss(1) && membership.state(1) == State::Late);
        assert!(destinations.is_pending(&membership));
        assert!(membership.lose(1, 0));
        assert!(!destinations.is_pending(&membership));
    }
}
