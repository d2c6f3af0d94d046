//! A set of robots in one word.

/// Teams of more robots walk round obstacles only, and slide past those who stand: corners round every set-point, and who
/// sees whom, would take more memory and time than such a team has.
pub(super) const MOST_STANDING: usize = 64;

/// Robots by number, of teams of up to 64 (`MOST_STANDING`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RobotSet(u64);

impl RobotSet {
    /// Adds `robot`, below 64.
    pub fn add(&mut self, robot: usize) {
        self.0 |= 1 << robot;
    }

    /// These without `robot`.
    pub(super) fn without(self, robot: usize) -> Self {
        if robot < MOST_STANDING { Self(self.0 & !(1 << robot)) } else { self }
    }

    /// Whether nobody is in it.
    pub fn is_empty(&self) -> bool {
        self.0 == 0
    }

    /// Of these, the ones of `other`.
    pub fn among(&self, other: &Self) -> Self {
        Self(self.0 & other.0)
    }

    /// How many there are.
    pub fn count(&self) -> u32 {
        self.0.count_ones()
    }

    /// Those of both.
    pub(super) fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether somebody is in both.
    pub(super) fn meets(&self, other: &Self) -> bool {
        self.0 & other.0 != 0
    }
}
