//! What a trainer and the robots that play for it tell each other: an order per round, a report per round,
//! each one line of JSON (`vodca rollout --rounds-from-stdin`).

use crate::encoding::sha256_digits;
use serde::{Deserialize, Serialize};
use std::num::NonZeroU64;
use std::path::PathBuf;

/// Asks for a round: episodes whose transitions end up in one shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoundOrder {
    /// Its number: the shard's name.
    pub round: u64,
    /// How many episodes.
    pub episodes: NonZeroU64,
    /// SHA-256 of the actor that must act in them, as digits; left out: whichever acts.
    #[serde(default, with = "sha256_digits", skip_serializing_if = "Option::is_none")]
    pub policy: Option<[u8; 32]>,
}

/// What became of a round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoundReport {
    /// The shard of its transitions, if one is kept.
    pub shard: Option<PathBuf>,
    /// From its first tick to its last, s.
    pub seconds: f64,
    /// Its episodes.
    pub episodes: Vec<Played>,
}

impl RoundReport {
    /// Ticks of all its episodes.
    pub fn ticks(&self) -> u64 {
        self.episodes.iter().map(|episode| episode.ticks).sum()
    }
}

/// What became of an episode.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Played {
    /// Its number.
    pub episode: u64,
    /// Ticks played.
    pub ticks: u64,
    /// Sum of R over them.
    #[serde(rename = "return")]
    pub total: f64,
    /// Whether everybody had arrived at its end and nobody had collided.
    pub success: bool,
    /// Ticks until everybody had arrived; all of them without success.
    pub arrived_tick: u64,
    /// Sum of the paths until then, m.
    pub path: f64,
}

/// `message` as the line that the other side reads, without its end.
///
/// # Errors
/// A path that is no text.
pub fn to_line(message: &impl Serialize) -> Result<String, serde_json::Error> {
    serde_json::to_string(message)
}

/// The message in `line`.
///
/// # Errors
/// What is wrong with it and at which column, in words.
pub fn from_line<'a, Message: Deserialize<'a>>(line: &'a str) -> Result<Message, serde_json::Error> {
    serde_json::from_str(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_survives_its_lines_to_the_same_bits() {
        let policy = Some(std::array::from_fn(|index| index as u8));
        for policy in [policy, None] {
            let order = RoundOrder { round: 7, episodes: NonZeroU64::new(10).unwrap(), policy };
            let line = to_line(&order).unwrap();
            assert!(!line.contains('\n'));
            assert_eq!(from_line::<RoundOrder>(&line).unwrap(), order);
        }
        let (total, path) = (-1.0 / 3.0, 0.1 + 0.2);
        let played = Played { episode: 4, ticks: 350, total, success: true, arrived_tick: 89, path };
        for shard in [Some("out/000007.safetensors".into()), None] {
            let report = RoundReport { shard, seconds: 0.5, episodes: vec![played; 2] };
            assert_eq!(from_line::<RoundReport>(&to_line(&report).unwrap()).unwrap(), report);
            assert_eq!(report.ticks(), 700);
        }
    }

    #[test]
    fn an_order_that_means_nothing_is_refused_with_the_reason() {
        let refused = |line: &str| from_line::<RoundOrder>(line).unwrap_err().to_string();
        assert!(refused("7 10").contains("expected struct RoundOrder"), "{}", refused("7 10"));
        assert!(refused(r#"{"round":7}"#).contains("missing field `episodes`"));
        assert!(refused(r#"{"round":7,"episodes":0}"#).contains("nonzero"));
        assert!(refused(r#"{"round":7,"episodes":1,"policy":"00ff"}"#).contains("64 lower-case hexadecimal digits"));
        assert!(refused(r#"{"round":7,"episodes":1,"polcy":null}"#).contains("unknown field `polcy`"));
    }
}
