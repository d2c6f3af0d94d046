//! How good an actor is by its evaluation, and which one is kept.

use policy::session::Played;
use serde::{Deserialize, Serialize};

/// What an evaluation came to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Episodes in which everybody arrived and nobody collided.
    pub successes: usize,
    /// Episodes played.
    pub episodes: usize,
    /// Mean path over the episodes that succeeded, m.
    pub path: Option<f64>,
    /// Largest number of ticks of those.
    pub ticks: u64,
    /// Mean return over all episodes.
    pub total: f64,
}

impl Score {
    /// The score of what was played.
    pub fn of(played: &[Played]) -> Self {
        let good: Vec<&Played> = played.iter().filter(|episode| episode.success).collect();
        let count = good.len() as f64;
        Self {
            successes: good.len(),
            episodes: played.len(),
            path: (count > 0.0).then(|| good.iter().map(|episode| episode.path).sum::<f64>() / count),
            ticks: good.iter().map(|episode| episode.arrived_tick).max().unwrap_or(0),
            total: played.iter().map(|episode| episode.total).sum::<f64>() / played.len().max(1) as f64,
        }
    }

    /// Whether this is better than `other`: more successes; then within `most_ticks` rather than not
    /// (N = 1 buys short paths with hundreds of ticks); then a shorter path.
    pub fn beats(&self, other: &Score, most_ticks: u64) -> bool {
        let rank = |score: &Score| (score.successes, score.ticks <= most_ticks);
        if rank(self) != rank(other) {
            return rank(self) > rank(other);
        }
        match (self.path, other.path) {
            (Some(own), Some(theirs)) => own < theirs,
            (own, theirs) => own.is_some() && theirs.is_none(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn played(success: bool, path: f64, arrived_tick: u64) -> Played {
        Played { episode: 0, ticks: 350, total: 1.0, success, arrived_tick, path }
    }

    #[test]
    fn only_episodes_that_succeeded_count_for_path_and_ticks() {
        let score = Score::of(&[played(true, 40.0, 90), played(false, 10.0, 350), played(true, 44.0, 100)]);
        assert_eq!((score.successes, score.episodes, score.path, score.ticks), (2, 3, Some(42.0), 100));
        assert_eq!(Score::of(&[played(false, 1.0, 350)]).path, None);
    }

    #[test]
    fn success_counts_first_then_the_bound_on_ticks_then_the_path() {
        let best = Score::of(&[played(true, 44.0, 90), played(true, 44.0, 90)]);
        let one_fails = Score::of(&[played(true, 20.0, 90), played(false, 1.0, 350)]);
        let slow = Score::of(&[played(true, 41.0, 300), played(true, 41.0, 90)]);
        let longer = Score::of(&[played(true, 45.0, 80), played(true, 45.0, 80)]);
        for worse in [one_fails, slow, longer] {
            assert!(best.beats(&worse, 95) && !worse.beats(&best, 95), "{worse:?}");
        }
        assert!(slow.beats(&best, 350));
        assert!(!best.beats(&best, 95));
        let nothing = Score::of(&[played(false, 1.0, 350)]);
        assert!(!nothing.beats(&nothing, 95) && Score::of(&[played(true, 9.0, 350)]).beats(&nothing, 95));
    }
}
