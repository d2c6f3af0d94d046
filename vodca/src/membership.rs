//! Who takes part in a run, by which life, and since when.
//!
//! One small state machine for every robot, without clocks, processes or messages: whoever keeps a team tells it
//! what happened, and it says who counts. A robot that misses a tick stands in it (its input was never taken), so its
//! place stays known to everybody; it begins anew as soon as it can be counted on again.
//!
//! ```text
//! Expected --joins--> Driving --misses a tick--> Late --speaks--> Back --answers--> Driving
//!                        |                         |                |
//!                        +---- its process ends ---+----------------+--> Lost --joins--> Back
//! ```
//!
//! *Invariant*: a message counts once at most, in the tick it belongs to, from the life that was admitted last.

use serde::{Deserialize, Serialize};

/// How a robot takes part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum State {
    /// Not there yet.
    #[default]
    Expected = 0,
    /// It took part in the newest tick.
    Driving = 1,
    /// It missed a tick and has not been heard since: nobody waits for it.
    Late = 2,
    /// Its process has ended: it stands until it comes back.
    Lost = 3,
    /// It is there again, and begins anew with the tick that comes.
    Back = 4,
}

impl State {
    /// All of them, by number.
    pub const ALL: [Self; 5] = [Self::Expected, Self::Driving, Self::Late, Self::Lost, Self::Back];

    /// Its number in messages.
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// The state of this number.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }

    /// Whether a tick waits for the robot.
    pub const fn takes_part(self) -> bool {
        matches!(self, Self::Driving | Self::Back)
    }

    /// Whether the robot stood during the tick before.
    pub const fn has_stood(self) -> bool {
        matches!(self, Self::Late | Self::Lost | Self::Back)
    }
}

/// One robot of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Member {
    /// How it takes part.
    pub state: State,
    /// Which of its processes counts, from 1; 0: none was there yet.
    pub life: u32,
    /// The tick since which `state` holds: the first one that it missed, or in which it drives (again).
    pub since: u64,
}

/// What a message is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It counts.
    Counts,
    /// It shows that its robot can be counted on again, no more.
    SignOfLife,
    /// Another tick's, a second one, or one of another life.
    Nothing,
}

/// All robots of a run.
#[derive(Clone, Debug)]
pub struct Membership {
    members: Vec<Member>,
    answered: Vec<bool>,
    missing: usize,
    tick: u64,
}

impl Membership {
    /// A team of `robots` of which nobody is there yet.
    pub fn new(robots: usize) -> Self {
        Self { members: vec![Member::default(); robots], answered: vec![false; robots], missing: robots, tick: 0 }
    }

    /// The newest tick that has begun.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// All members, by robot number.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// How `robot` takes part.
    pub fn state(&self, robot: usize) -> State {
        self.members[robot].state
    }

    /// How many are in `state`.
    pub fn count(&self, state: State) -> usize {
        self.members.iter().filter(|member| member.state == state).count()
    }

    /// A process says that it is life `life` of `robot`, which begins with tick `tick`. `false`: it is not admitted,
    /// because an other life drives the robot or this one has had its time.
    pub fn join(&mut self, robot: usize, life: u32, tick: u64) -> bool {
        let member = &mut self.members[robot];
        let state = match member.state {
            State::Expected => State::Driving,
            State::Lost => State::Back,
            State::Driving | State::Late | State::Back => return false,
        };
        let admitted = life > member.life;
        if admitted {
            *member = Member { state, life, since: tick };
        }
        admitted
    }

    /// Tick `tick` begins: whoever takes part has to answer once.
    pub fn begin(&mut self, tick: u64) {
        self.tick = tick;
        self.missing = 0;
        for (answered, member) in self.answered.iter_mut().zip(&self.members) {
            *answered = !member.state.takes_part();
            self.missing += usize::from(!*answered);
        }
    }

    /// Before the first tick, or between two episodes: everybody has to answer once, lost ones excepted.
    pub fn expect_all(&mut self) {
        self.missing = 0;
        for (answered, member) in self.answered.iter_mut().zip(&self.members) {
            *answered = member.state == State::Lost;
            self.missing += usize::from(!*answered);
        }
    }

    /// `robot` answers what [`Self::expect_all`] asks; `false`: it had done so, or need not.
    pub fn answer(&mut self, robot: usize) -> bool {
        let first = !std::mem::replace(&mut self.answered[robot], true);
        self.missing -= usize::from(first);
        first
    }

    /// `robot` says something as life `life`: its answer to tick `tick`, or no more than that it is there (`None`).
    pub fn hear(&mut self, robot: usize, life: u32, tick: Option<u64>) -> Verdict {
        let member = self.members[robot];
        if life != member.life {
            return Verdict::Nothing;
        }
        match member.state {
            State::Late => {
                self.members[robot] = Member { state: State::Back, since: self.tick + 1, ..member };
                Verdict::SignOfLife
            }
            State::Driving | State::Back if tick == Some(self.tick) && self.answer(robot) => Verdict::Counts,
            _ => Verdict::Nothing,
        }
    }

    /// How many answers are missing.
    pub fn missing(&self) -> usize {
        self.missing
    }

    /// The first robot whose answer is missing.
    pub fn first_missing(&self) -> Option<usize> {
        self.answered.iter().position(|answered| !answered)
    }

    /// `robot` will not answer in this tick: it is late. `false`: it has answered, or nobody waits for it.
    pub fn miss(&mut self, robot: usize) -> bool {
        let misses = self.answer(robot);
        if misses {
            let member = &mut self.members[robot];
            (member.state, member.since) = (State::Late, self.tick);
        }
        misses
    }

    /// The process of `robot` has ended; `tick` is the first one that it misses. `false`: that was known.
    pub fn lose(&mut self, robot: usize, tick: u64) -> bool {
        self.answer(robot);
        let member = &mut self.members[robot];
        let news = member.state != State::Lost;
        if news {
            (member.state, member.since) = (State::Lost, tick);
        }
        news
    }

    /// The tick is over: those who are back drive.
    pub fn end(&mut self) {
        for member in &mut self.members {
            if member.state == State::Back && member.since <= self.tick {
                member.state = State::Driving;
            }
        }
    }
}

#[cfg(test)]
#[path = "membership_tests.rs"]
mod tests;
