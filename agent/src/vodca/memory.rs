//! How much and for how long a robot has been in conflict: its whole memory besides its own plan.

use shared::params::{Aim, Vodca};

/// Two running means of "this tick has a collision row", 0 at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConflictMemory {
    /// s of rule 4 (safe.md): how much of the last few ticks, with weight `aim.memory`. Traffic ahead counts
    /// as conflict here, so s is in 0..=`aim.most`.
    pub recent: f64,
    /// How long the conflict has lasted, with weight `vodca.lasting_memory`, 0..=1.
    pub lasting: f64,
}

impl ConflictMemory {
    /// Takes the number of collision rows of one more tick and the traffic ahead ([`super::traffic`]).
    pub fn remember(&mut self, aim: &Aim, vodca: &Vodca, rows: usize, traffic: f64) {
        let flag = if rows > 0 { 1.0 } else { 0.0 };
        self.recent += aim.memory * (traffic.max(flag) - self.recent);
        self.lasting += vodca.lasting_memory * (flag - self.lasting);
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
    use shared::params::Params;

    #[test]
    fn a_lasting_conflict_turns_from_the_one_angle_to_the_other() {
        let Params { aim, vodca, .. } = Params::safe();
        let mut memory = ConflictMemory::default();
        assert_eq!(memory.turn(&vodca), vodca.turn);
        memory.remember(&aim, &vodca, 3, 0.0);
        assert_eq!((memory.recent, memory.lasting), (aim.memory, vodca.lasting_memory));
        (0..2000).for_each(|_| memory.remember(&aim, &vodca, 1, 0.0));
        assert!((memory.turn(&vodca) - vodca.turn_lasting).abs() < 1e-9);
        (0..2000).for_each(|_| memory.remember(&aim, &vodca, 0, 0.0));
        assert!(memory.recent < 1e-9 && (memory.turn(&vodca) - vodca.turn).abs() < 1e-9);
    }

    #[test]
    fn traffic_ahead_turns_the_aim_before_there_is_a_row_and_leaves_the_rows_alone() {
        let Params { aim, vodca, .. } = Params::safe();
        let mut memory = ConflictMemory::default();
        (0..200).for_each(|_| memory.remember(&aim, &vodca, 0, 1.6));
        assert!((memory.recent - 1.6).abs() < 1e-9);
        assert_eq!(memory.turn(&vodca), vodca.turn);
        (0..200).for_each(|_| memory.remember(&aim, &vodca, 2, 0.0));
        assert!((memory.recent - 1.0).abs() < 1e-9);
    }
}
