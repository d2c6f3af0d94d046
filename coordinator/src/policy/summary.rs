//! The policy's part of `summary.json`.

use super::Source;
use crate::latency::{Latency, Percentiles};
use policy::encoding::hex;
use serde::{Deserialize, Serialize};
use shared::messages::PolicyAnswer;
use std::path::PathBuf;
use vodca::horizon::Horizon;

/// How a run went as its policy sees it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PolicySummary {
    /// Where the policy came from.
    pub source: PathBuf,
    /// Which version acted when, in order; a version that acted twice stands twice.
    pub versions: Vec<VersionSummary>,
    /// Ticks with an answer in time.
    pub answered: u64,
    /// Ticks without: their answers came late or never.
    pub late: u64,
    /// Answers that came after their tick.
    pub came_too_late: u64,
    /// Ticks for which robots kept their last horizon.
    pub held: u64,
    /// Ticks with the default horizon.
    pub default_used: u64,
    /// From the server reading an observation to its answer.
    pub inference: Percentiles,
    /// From the observation being published to the horizons being there.
    pub round_trip: Percentiles,
    /// What the shadow did.
    pub shadow: Option<ShadowSummary>,
}

/// A version and the ticks at which it acted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VersionSummary {
    /// `v000017`.
    pub version: String,
    /// SHA-256 of its file.
    pub sha256: String,
    /// First tick.
    pub from_tick: u64,
    /// Last tick.
    pub to_tick: u64,
}

/// How a shadow's horizons compare with those that were used.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShadowSummary {
    /// Where the shadow came from.
    pub source: PathBuf,
    /// SHA-256 of its file.
    pub sha256: String,
    /// Horizons compared: ticks times robots.
    pub compared: u64,
    /// How many of them differ.
    pub differing: u64,
    /// Mean of |shadow - used| over all compared, steps.
    pub mean_distance: f64,
    /// Largest |shadow - used|, steps.
    pub max_distance: u64,
}

/// Counts during a run.
pub(super) struct Tally {
    summary: PolicySummary,
    inference: Latency,
    round_trip: Latency,
    distance: u64,
}

impl Tally {
    pub(super) fn new(source: PathBuf, shadow: Option<PathBuf>) -> Self {
        let shadow = shadow.map(|source| ShadowSummary {
            source,
            sha256: String::new(),
            compared: 0,
            differing: 0,
            mean_distance: 0.0,
            max_distance: 0,
        });
        let none = Percentiles::default();
        let summary = PolicySummary {
            source,
            versions: Vec::new(),
            answered: 0,
            late: 0,
            came_too_late: 0,
            held: 0,
            default_used: 0,
            inference: none,
            round_trip: none,
            shadow,
        };
        Self { summary, inference: Latency::new(), round_trip: Latency::new(), distance: 0 }
    }

    /// An answer in time, heard at `now` ns.
    pub(super) fn answered(&mut self, answer: &PolicyAnswer, now: u64) {
        self.inference.record_ns(answer.stamp.saturating_sub(answer.read));
        self.round_trip.record_ns(now.saturating_sub(answer.asked));
    }

    pub(super) fn too_late(&mut self) {
        self.summary.came_too_late += 1;
    }

    pub(super) fn tick(&mut self, tick: u64, source: Source, answer: Option<&PolicyAnswer>) {
        let summary = &mut self.summary;
        match source {
            Source::Policy => summary.answered += 1,
            Source::Held => summary.held += 1,
            Source::Default => summary.default_used += 1,
        }
        summary.late = summary.held + summary.default_used;
        let (Source::Policy, Some(answer)) = (source, answer) else { return };
        let (version, sha256) = (format!("v{:06}", answer.version), hex(&answer.sha256));
        match summary.versions.last_mut() {
            Some(last) if last.version == version && last.sha256 == sha256 => last.to_tick = tick,
            _ => summary.versions.push(VersionSummary { version, sha256, from_tick: tick, to_tick: tick }),
        }
    }

    pub(super) fn shadow(&mut self, answer: &PolicyAnswer, shadow: &[Horizon], used: &[Horizon]) {
        let Some(summary) = &mut self.summary.shadow else { return };
        if summary.sha256.is_empty() {
            summary.sha256 = hex(&answer.sha256);
        }
        for (shadow, used) in shadow.iter().zip(used) {
            let distance = shadow.steps().abs_diff(used.steps()) as u64;
            summary.compared += 1;
            summary.differing += u64::from(distance > 0);
            summary.max_distance = summary.max_distance.max(distance);
            self.distance += distance;
        }
    }

    pub(super) fn summary(mut self) -> PolicySummary {
        self.summary.inference = self.inference.percentiles();
        self.summary.round_trip = self.round_trip.percentiles();
        if let Some(shadow) = &mut self.summary.shadow {
            shadow.mean_distance = self.distance as f64 / shadow.compared.max(1) as f64;
        }
        self.summary
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_told_by_their_ranges_of_ticks() {
        let mut tally = Tally::new("p".into(), None);
        let answer = |version| PolicyAnswer { version, sha256: [version as u8; 32], ..PolicyAnswer::EMPTY };
        for (tick, version) in [1, 1, 2, 2, 1].into_iter().enumerate() {
            tally.tick(tick as u64, Source::Policy, Some(&answer(version)));
        }
        tally.tick(5, Source::Held, None);
        tally.tick(6, Source::Default, None);
        let summary = tally.summary();
        let ranges: Vec<_> = summary.versions.iter().map(|v| (v.version.as_str(), v.from_tick, v.to_tick)).collect();
        assert_eq!(ranges, [("v000001", 0, 1), ("v000002", 2, 3), ("v000001", 4, 4)]);
        assert_eq!((summary.answered, summary.late, summary.held, summary.default_used), (5, 2, 1, 1));
    }

    #[test]
    fn a_shadow_is_compared_with_what_was_used() {
        let mut tally = Tally::new("p".into(), Some("s".into()));
        let horizons = |steps: [u64; 3]| steps.map(|steps| Horizon::new(steps).unwrap());
        tally.shadow(&PolicyAnswer::EMPTY, &horizons([5, 9, 20]), &horizons([5, 10, 13]));
        let shadow = tally.summary().shadow.unwrap();
        assert_eq!((shadow.compared, shadow.differing, shadow.max_distance), (3, 2, 7));
        assert!((shadow.mean_distance - 8.0 / 3.0).abs() < 1e-12);
    }
}
