//! Faults on purpose: which robot suffers what at which tick. Seeded, so that a run with faults can be repeated.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use vodca::random::{self, Use};

/// Ticks for which a stopped process is stopped where nothing else is said.
const STOPPED: u64 = 3;

/// What can be made to go wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The process is killed before the tick.
    Kill,
    /// The process is stopped before the tick, and goes on some ticks later.
    Stop,
    /// The robot's messages of the tick come with the next one.
    Delay,
    /// The robot's messages of the tick never come.
    Drop,
    /// The robot's messages of the tick come twice.
    Duplicate,
}

impl Kind {
    const ALL: [(Self, &str); 5] = [
        (Self::Kill, "kill"),
        (Self::Stop, "stop"),
        (Self::Delay, "delay"),
        (Self::Drop, "drop"),
        (Self::Duplicate, "duplicate"),
    ];

    fn word(self) -> &'static str {
        Self::ALL.iter().find(|(kind, _)| *kind == self).map_or("", |(_, word)| word)
    }
}

/// Whom a fault strikes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Aim {
    /// Every robot at every tick with this probability.
    Share(f64),
    /// One robot at one tick.
    One { robot: usize, tick: u64 },
}

/// One kind of fault.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fault {
    kind: Kind,
    aim: Aim,
    /// How long it lasts ([`Kind::Stop`]), ticks.
    ticks: u64,
}

/// What happens to the process of a robot before a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcessFault {
    /// It is killed.
    Kill,
    /// It is stopped, for so many ticks.
    Stop {
        /// From this tick on.
        ticks: u64,
    },
}

/// What happens to what a robot says in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessageFault {
    /// It comes with the next tick, too late to count.
    Delay,
    /// It never comes.
    Drop,
    /// It comes twice, the second time with the next tick.
    Duplicate,
}

impl MessageFault {
    /// Whether the robot misses the tick because of it.
    pub fn misses(self) -> bool {
        self != Self::Duplicate
    }
}

/// Faults on purpose, as `--chaos` says: `kill:0.001,stop:0.01x5,drop:0.02,seed:7`, or `kill:3@41` for robot 3 at tick 41.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Chaos {
    faults: Vec<Fault>,
    seed: u64,
}

/// A specification of faults means nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "--chaos: `{item}` is no fault; write KIND:SHARE (0..=1, of all robots and ticks) or KIND:ROBOT@TICK with one of kill, \
     stop, delay, drop, duplicate; xTICKS after a stop is how long; seed:NUMBER; separate them by commas"
)]
pub struct ChaosError {
    /// The part that was not understood.
    pub item: String,
}

impl Chaos {
    /// Whether nothing goes wrong on purpose.
    pub fn is_none(&self) -> bool {
        self.faults.is_empty()
    }

    /// What happens to the process of `robot` before tick `tick`.
    pub fn process(&self, robot: usize, tick: u64) -> Option<ProcessFault> {
        self.faults.iter().find_map(|fault| match fault.kind {
            Kind::Kill if self.strikes(fault, robot, tick) => Some(ProcessFault::Kill),
            Kind::Stop if self.strikes(fault, robot, tick) => Some(ProcessFault::Stop { ticks: fault.ticks }),
            _ => None,
        })
    }

    /// What happens to what `robot` says in tick `tick`.
    pub fn message(&self, robot: usize, tick: u64) -> Option<MessageFault> {
        self.faults.iter().find_map(|fault| {
            let what = match fault.kind {
                Kind::Delay => MessageFault::Delay,
                Kind::Drop => MessageFault::Drop,
                Kind::Duplicate => MessageFault::Duplicate,
                Kind::Kill | Kind::Stop => return None,
            };
            self.strikes(fault, robot, tick).then_some(what)
        })
    }

    fn strikes(&self, fault: &Fault, robot: usize, tick: u64) -> bool {
        match fault.aim {
            Aim::One { robot: one, tick: at } => (one, at) == (robot, tick),
            Aim::Share(share) => {
                let who = (fault.kind as u64) << 32 | robot as u64;
                random::unit(&mut random::stream(self.seed, Use::Fault, who, tick)) < share
            }
        }
    }
}

impl FromStr for Chaos {
    type Err = ChaosError;

    fn from_str(text: &str) -> Result<Self, ChaosError> {
        let mut chaos = Self::default();
        for item in text.split(',').map(str::trim) {
            let unknown = || ChaosError { item: item.to_owned() };
            let (word, rest) = item.split_once(':').ok_or_else(unknown)?;
            if word == "seed" {
                chaos.seed = rest.parse().map_err(|_| unknown())?;
                continue;
            }
            let (kind, _) = Kind::ALL.into_iter().find(|(_, known)| *known == word).ok_or_else(unknown)?;
            let (aim, ticks) = match rest.split_once('x') {
                Some((aim, ticks)) if kind == Kind::Stop => (aim, ticks.parse().map_err(|_| unknown())?),
                Some(_) => return Err(unknown()),
                None => (rest, STOPPED),
            };
            let aim = match aim.split_once('@') {
                Some((robot, tick)) => Aim::One {
                    robot: robot.parse().map_err(|_| unknown())?,
                    tick: tick.parse().map_err(|_| unknown())?,
                },
                None => Aim::Share(aim.parse().ok().filter(|share| (0.0..=1.0).contains(share)).ok_or_else(unknown)?),
            };
            if ticks == 0 {
                return Err(unknown());
            }
            chaos.faults.push(Fault { kind, aim, ticks });
        }
        Ok(chaos)
    }
}

impl fmt::Display for Chaos {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Fault { kind, aim, ticks } in &self.faults {
            match aim {
                Aim::Share(share) => write!(f, "{}:{share}", kind.word())?,
                Aim::One { robot, tick } => write!(f, "{}:{robot}@{tick}", kind.word())?,
            }
            if *kind == Kind::Stop {
                write!(f, "x{ticks}")?;
            }
            write!(f, ",")?;
        }
        write!(f, "seed:{}", self.seed)
    }
}

impl TryFrom<String> for Chaos {
    type Error = ChaosError;

    fn try_from(text: String) -> Result<Self, ChaosError> {
        text.parse()
    }
}

impl From<Chaos> for String {
    fn from(chaos: Chaos) -> Self {
        chaos.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_specification_reads_back_from_its_own_words() {
        for text in ["kill:0.001,stop:0.01x5,drop:0.02,seed:7", "kill:3@41,seed:0", "delay:1,duplicate:0.5,seed:2"] {
            assert_eq!(text.parse::<Chaos>().unwrap().to_string(), text);
        }
        assert_eq!("stop:2@4".parse::<Chaos>().unwrap().process(2, 4), Some(ProcessFault::Stop { ticks: STOPPED }));
    }

    #[test]
    fn what_means_nothing_is_named() {
        for (text, item) in
            [("kill", "kill"), ("drop:0.1,burn:1", "burn:1"), ("kill:2", "kill:2"), ("drop:1x3", "drop:1x3"), ("", "")]
        {
            assert_eq!(text.parse::<Chaos>(), Err(ChaosError { item: item.into() }), "{text}");
        }
        assert!("stop:0.1x0".parse::<Chaos>().is_err());
    }

    #[test]
    fn the_stated_share_is_struck_by_seed_and_each_kind_for_itself() {
        let chaos: Chaos = "kill:0.1,drop:0.1,seed:3".parse().unwrap();
        let other: Chaos = "kill:0.1,drop:0.1,seed:4".parse().unwrap();
        let kills = |chaos: &Chaos| (0..2000).map(|tick| chaos.process(1, tick).is_some()).collect::<Vec<bool>>();
        let drops: Vec<bool> = (0..2000).map(|tick| chaos.message(1, tick) == Some(MessageFault::Drop)).collect();
        let count = kills(&chaos).iter().filter(|struck| **struck).count();
        assert!((150..250).contains(&count), "{count}");
        assert_eq!(kills(&chaos), kills(&chaos));
        assert!(kills(&chaos) != kills(&other) && kills(&chaos) != drops);
        assert_eq!(Chaos::default().process(0, 0), None);
    }
}
