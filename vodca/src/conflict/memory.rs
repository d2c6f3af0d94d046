//! How much and for how long a robot has been in conflict: its whole memory besides its own plan.

use crate::params::{Aim, Vodca};

/// Two running means, 0 at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConflictMemory {
    /// phi s of rule 4 (ARCHITECTURE), rad: by how much the aim is turned right, with weight `aim.memory`.
    pub aim: f64,
    /// How long there have been collision rows, with weight `vodca.lasting_memory`, 0..=1.
    pub lasting: f64,
}

impl ConflictMemory {
    /// Takes the number of collision rows of one more tick and the right turn that the traffic ahead asks
    /// for ([`super::traffic`]), rad; a row asks for `aim.angle`.
    pub fn remember(&mut self, aim: &Aim, vodca: &Vodca, rows: usize, turn: f64) {
        let flag = if rows > 0 { 1.0 } else { 0.0 };
        self.aim += aim.memory * (turn.max(aim.angle * flag) - self.aim);
        self.lasting += vodca.lasting_memory * (flag - self.lasting);
    }

    /// Whether the conflict has lasted so long that the robot goes round the obstacles and lets everybody
    /// pass who has farther to go. What is stuck then comes apart from its end: the one with the shortest way
    /// moves aside.
    pub fn is_out_of_patience(&self, vodca: &Vodca) -> bool {
        vodca.patience < 1.0 && self.lasting >= vodca.patience
    }

    /// Whether the conflict has lasted so long that the robot backs off now and then.
    pub fn backs_off(&self, vodca: &Vodca) -> bool {
        self.is_out_of_patience(vodca) && vodca.back_off < 1.0 && self.lasting >= vodca.back_off
    }

    /// The angle by which the normals of the next rows are turned left, rad. Small angles give short
    /// paths through dense traffic; what they leave stuck, large ones resolve.
    pub fn turn(&self, vodca: &Vodca) -> f64 {
        vodca.turn + (vodca.turn_lasting - vodca.turn) * self.lasting
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Params;

    #[test]
    fn a_lasting_conflict_turns_from_the_one_angle_to_the_other() {
        let Params { aim, vodca, .. } = Params::safe();
        let mut memory = ConflictMemory::default();
        assert_eq!(memory.turn(&vodca), vodca.turn);
        memory.remember(&aim, &vodca, 3, 0.0);
        assert_eq!((memory.aim, memory.lasting), (aim.memory * aim.angle, vodca.lasting_memory));
        (0..2000).for_each(|_| memory.remember(&aim, &vodca, 1, 0.0));
        assert!((memory.turn(&vodca) - vodca.turn_lasting).abs() < 1e-9);
        (0..2000).for_each(|_| memory.remember(&aim, &vodca, 0, 0.0));
        assert!(memory.aim < 1e-9 && (memory.turn(&vodca) - vodca.turn).abs() < 1e-9);
    }

    #[test]
    fn traffic_ahead_turns_the_aim_before_there_is_a_row_and_leaves_the_rows_alone() {
        let Params { aim, vodca, .. } = Params::safe();
        let mut memory = ConflictMemory::default();
        (0..200).for_each(|_| memory.remember(&aim, &vodca, 0, 0.4));
        assert!((memory.aim - 0.4).abs() < 1e-9);
        assert_eq!(memory.turn(&vodca), vodca.turn);
        (0..200).for_each(|_| memory.remember(&aim, &vodca, 2, 0.0));
        assert!((memory.aim - aim.angle).abs() < 1e-9);
    }

    #[test]
    fn patience_ends_in_a_lasting_conflict_and_comes_back_after_it() {
        let Params { aim, vodca, .. } = Params::safe();
        let mut memory = ConflictMemory::default();
        let mut ticks = |rows: usize, wanted: bool| {
            (0..1000).position(|_| {
                memory.remember(&aim, &vodca, rows, 0.0);
                memory.is_out_of_patience(&vodca) == wanted
            })
        };
        assert!((40..100).contains(&ticks(1, true).unwrap()));
        assert!(ticks(0, false).unwrap() < 10);
        let mut paper = ConflictMemory { lasting: 1.0, ..Default::default() };
        paper.remember(&Params::paper().aim, &Params::paper().vodca, 1, 0.0);
        assert!(!paper.is_out_of_patience(&Params::paper().vodca));
        let never = Vodca { back_off: 1.0, ..vodca.clone() };
        let long = ConflictMemory { lasting: 1.0, ..Default::default() };
        assert!(long.backs_off(&vodca) && !long.backs_off(&never) && !memory.backs_off(&vodca));
    }
}
