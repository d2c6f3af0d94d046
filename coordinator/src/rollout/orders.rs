//! Which rounds of episodes are to be played: a number of them, or what a trainer writes line by line.

use policy::session::{RoundOrder, from_line};
use shared::stop::StopFlag;
use std::io::BufRead;
use std::num::NonZeroU64;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

/// How often a waiting session looks whether it was asked to stop.
const LOOK_AROUND: Duration = Duration::from_millis(50);

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
    /// A [`RoundOrder`] a line, until the end of the stream or of this session.
    Lines {
        /// What was read.
        lines: Receiver<String>,
        /// Asked to stop.
        stop: StopFlag,
    },
}

impl Orders {
    /// Reads rounds from standard input, in a detached thread.
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
    pub fn take(&mut self) -> Option<RoundOrder> {
        match self {
            Self::Fixed { next, episodes, per_round } => {
                let dealt = NonZeroU64::new((*per_round).min(*episodes))?;
                let order = RoundOrder { round: *next, episodes: dealt, policy: None };
                *next += 1;
                *episodes -= dealt.get();
                Some(order)
            }
            Self::Lines { lines, stop } => loop {
                if stop.is_set() {
                    return None;
                }
                match lines.recv_timeout(LOOK_AROUND) {
                    Ok(line) => match from_line(&line) {
                        Ok(order) => return Some(order),
                        Err(error) => {
                            tracing::error!(
                                "`{line}` orders no round: {error}; write {{\"round\": 0, \"episodes\": 10}}, and \
                                 \"policy\": \"SHA-256\" if one actor must act"
                            );
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn episodes_are_dealt_out_to_rounds() {
        let mut orders = Orders::Fixed { next: 4, episodes: 5, per_round: 2 };
        let rounds: Vec<_> =
            std::iter::from_fn(|| orders.take()).map(|order| (order.round, order.episodes.get())).collect();
        assert_eq!(rounds, [(4, 2), (5, 2), (6, 1)]);
    }
}
