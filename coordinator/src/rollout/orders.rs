//! Which rounds of episodes are to be played: a number of them, or what a trainer writes line by line.

use policy::encoding::sha256_bytes;
use shared::stop::StopFlag;
use std::io::BufRead;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// How often a waiting session looks whether it was asked to stop.
const LOOK_AROUND: Duration = Duration::from_millis(50);

/// Episodes that end up in one shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Round {
    /// Its number: the shard's name.
    pub number: u64,
    /// How many.
    pub episodes: u64,
    /// SHA-256 of the policy that must act in them.
    pub policy: Option<[u8; 32]>,
}

/// Where rounds come from.
pub enum Orders {
    /// So many episodes, so many to a round.
    Fixed {
        /// Number of the next round.
        next: u64,
        /// Episodes that are left.
        episodes: u64,
        /// Most episodes of a round.
        per_round: u64,
    },
    /// `NUMBER EPISODES [SHA256]` a line, until the end of the stream or of this session.
    Lines {
        /// What was read.
        lines: Receiver<String>,
        /// Asked to stop.
        stop: StopFlag,
    },
}

impl Orders {
    /// Reads rounds from standard input, in a thread that nobody waits for.
    pub fn from_stdin(stop: &StopFlag) -> Self {
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            for line in std::io::stdin().lock().lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        });
        Self::Lines { lines, stop: stop.clone() }
    }

    /// The next round; `None`: there is none, or what came means nothing (logged).
    pub fn take(&mut self) -> Option<Round> {
        match self {
            Self::Fixed { episodes: 0, .. } => None,
            Self::Fixed { next, episodes, per_round } => {
                let round = Round { number: *next, episodes: (*per_round).min(*episodes), policy: None };
                *next += 1;
                *episodes -= round.episodes;
                Some(round)
            }
            Self::Lines { lines, stop } => loop {
                if stop.is_set() {
                    return None;
                }
                match lines.recv_timeout(LOOK_AROUND) {
                    Ok(line) => match parse(&line) {
                        Some(round) => return Some(round),
                        None => {
                            tracing::error!("`{line}` is no round; write NUMBER EPISODES [SHA256]");
                            return None;
                        }
                    },
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => return None,
                }
            },
        }
    }
}

fn parse(line: &str) -> Option<Round> {
    let mut words = line.split_whitespace();
    let (number, episodes) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
    let policy = match words.next() {
        Some(digits) => Some(sha256_bytes(digits)?),
        None => None,
    };
    (episodes > 0 && words.next().is_none()).then_some(Round { number, episodes, policy })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn episodes_are_dealt_out_to_rounds() {
        let mut orders = Orders::Fixed { next: 4, episodes: 5, per_round: 2 };
        let rounds: Vec<_> = std::iter::from_fn(|| orders.take()).map(|round| (round.number, round.episodes)).collect();
        assert_eq!(rounds, [(4, 2), (5, 2), (6, 1)]);
    }

    #[test]
    fn a_line_is_a_round_or_nothing() {
        let digits = "00ff".repeat(16);
        let round = parse(&format!("7 10 {digits}")).unwrap();
        assert_eq!((round.number, round.episodes, round.policy.unwrap()[..3].to_vec()), (7, 10, vec![0, 255, 0]));
        assert_eq!(parse("7 10"), Some(Round { number: 7, episodes: 10, policy: None }));
        for wrong in ["", "7", "7 0", "x 1", "7 1 00ff", "7 1 zz", "7 1 2 3"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }
}
