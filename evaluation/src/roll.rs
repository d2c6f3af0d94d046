//! Who took part in which tick of a recorded run.

use coordinator::members::Change;
use vodca::membership::State;
use vodca::step::Status;
use vodca::team::Attendance;

/// Goes through a run tick by tick.
#[derive(Clone, Debug)]
pub(crate) struct Roll {
    changes: Vec<Change>,
    states: Vec<State>,
}

impl Roll {
    /// Of a run of `robots` in which `changes` happened.
    pub(crate) fn new(robots: usize, changes: Vec<Change>) -> Self {
        Self { changes, states: vec![State::Driving; robots] }
    }

    /// Whether everybody always took part.
    pub(crate) fn is_full(&self) -> bool {
        self.changes.is_empty()
    }

    /// How everybody takes part in tick `tick`; ticks come in order from 0.
    pub(crate) fn tick(&mut self, tick: u64) -> Vec<Attendance> {
        let now = |change: &&Change| change.tick == tick;
        for change in self.changes.iter().filter(now).filter(|change| change.state == State::Back) {
            self.states[change.robot] = State::Back; // announced with this tick
        }
        let announced = self.states.clone();
        for change in self.changes.iter().filter(now).filter(|change| change.state != State::Back) {
            self.states[change.robot] = change.state; // found out during it
        }
        let missing = |state: &State| match state {
            State::Late => Some(Status::Late),
            State::Lost => Some(Status::Lost),
            State::Expected | State::Driving | State::Back => None,
        };
        let roll = announced.into_iter().zip(&self.states);
        let roll = roll.map(|(announced, state)| Attendance { announced, missing: missing(state) }).collect();
        self.states.iter_mut().filter(|state| **state == State::Back).for_each(|state| *state = State::Driving);
        roll
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_found_out_in_a_tick_is_announced_with_the_next() {
        let change = |tick, state| Change { tick, robot: 1, state, life: 1, why: String::new() };
        let mut roll = Roll::new(2, vec![change(1, State::Lost), change(3, State::Back), change(3, State::Late)]);
        let of = |announced, missing| Attendance { announced, missing };
        let expected = [
            of(State::Driving, None),
            of(State::Driving, Some(Status::Lost)),
            of(State::Lost, Some(Status::Lost)),
            of(State::Back, Some(Status::Late)),
            of(State::Late, Some(Status::Late)),
        ];
        for (tick, expected) in expected.into_iter().enumerate() {
            assert_eq!(roll.tick(tick as u64), [of(State::Driving, None), expected], "tick {tick}");
        }
    }
}
