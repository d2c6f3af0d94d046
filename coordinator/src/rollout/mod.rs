//! Rollouts: episode after episode with one team of processes, recorded for a learner.

mod orders;

pub use orders::Orders;

use crate::horizons::RunHorizons;
use crate::record::RecordError;
use crate::run::{Episode, EpisodeDriver, RunTick};
use crate::team::ProcessTeam;
use policy::reward::{Judgement, Reward};
use policy::rollout::{About, Row, Shard};
use policy::session::{Played, RoundOrder, RoundReport};
use std::path::PathBuf;
use std::time::Instant;
use vodca::horizon_source::Horizons;
use vodca::metrics::RunMetrics;
use vodca::params::Params;
use vodca::play::{Observer, Verdict};

/// When an episode ends that nothing else ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// At K, as in the paper.
    LastTick,
    /// So many ticks after everybody has arrived: nothing new happens then. A learner bootstraps there.
    Arrived {
        /// Ticks played with everybody in place.
        ticks: u64,
    },
}

/// Records the episodes of a team, a shard per round.
pub struct Recorder<'a> {
    params: &'a Params,
    orders: Orders,
    /// Folder of the shards; `None`: nothing is kept.
    out: Option<PathBuf>,
    until: Until,
    written: &'a mut dyn FnMut(&RoundReport) -> Result<(), RecordError>,
    round: RoundOrder,
    shard: Shard,
    played: Vec<Played>,
    started: Instant,
    now: Option<Running>,
    // Of the tick that is being written down.
    observation: Vec<f32>,
    next_observation: Vec<f32>,
    action: Vec<f32>,
    horizon: Vec<u8>,
}

/// The episode that is being played.
struct Running {
    number: u64,
    max_ticks: u64,
    reward: Reward,
    total: f64,
    /// Ticks and path when everybody had arrived for the first time.
    arrived: Option<(u64, f64)>,
}

impl<'a> Recorder<'a> {
    /// Records rounds as `orders` say into the folder `out`, if there is one. `written` is called with every shard. `None`: there
    /// is nothing to do.
    pub fn new(
        params: &'a Params,
        about: About,
        mut orders: Orders,
        out: Option<PathBuf>,
        until: Until,
        written: &'a mut dyn FnMut(&RoundReport) -> Result<(), RecordError>,
    ) -> Option<Self> {
        let round = orders.take()?;
        Some(Self {
            params,
            orders,
            out,
            until,
            written,
            round,
            shard: Shard::new(about),
            played: Vec::new(),
            started: Instant::now(),
            now: None,
            observation: Vec::new(),
            next_observation: Vec::new(),
            action: Vec::new(),
            horizon: Vec::new(),
        })
    }

    /// Writes the shard of the round.
    fn write_round(&mut self) -> Result<(), RecordError> {
        let empty = Shard::new(self.shard.about.clone());
        let shard = std::mem::replace(&mut self.shard, empty);
        let name = format!("{:06}.{}", self.round.round, policy::rollout::ENDING);
        let path = self.out.as_ref().map(|out| out.join(name));
        if let Some(path) = &path {
            shard.write(path).map_err(|error| RecordError::Rollout { reason: error.to_string() })?;
        }
        let seconds = self.started.elapsed().as_secs_f64();
        let episodes = std::mem::take(&mut self.played);
        (self.written)(&RoundReport { shard: path, seconds, episodes })
    }

    fn row(&mut self, tick: &RunTick<'_>, judgement: &Judgement, truncated: bool, number: u64) {
        self.observation.clear();
        self.next_observation.clear();
        self.action.clear();
        self.horizon.clear();
        for (robot, step) in tick.steps.iter().enumerate() {
            // What the policy saw, and what it sees next.
            let (here, next) = (step.measured, step.next_measured);
            self.observation.extend([here.x as f32, here.y as f32]);
            self.next_observation.extend([next.x as f32, next.y as f32]);
            self.horizon.push(step.horizon.steps() as u8);
            let action = tick.horizons.actions().get(robot).copied().unwrap_or(step.horizon.action() as f32);
            self.action.push(action);
        }
        self.shard.push(&Row {
            episode: number,
            tick: tick.tick,
            observation: &self.observation,
            action: &self.action,
            horizon: &self.horizon,
            terms: judgement.terms,
            terminated: judgement.collided,
            truncated,
            next_observation: &self.next_observation,
        });
    }
}

impl Observer<ProcessTeam, RunHorizons> for Recorder<'_> {
    type Error = RecordError;

    fn tick(&mut self, tick: &RunTick<'_>) -> Result<Verdict, RecordError> {
        let Some(now) = &mut self.now else { return Ok(Verdict::Over) };
        let judgement = now.reward.tick(tick.tick, tick.steps);
        now.total += judgement.terms.total();
        let played = tick.tick + 1;
        if judgement.arrived && now.arrived.is_none() {
            now.arrived = Some((played, tick.metrics.finish().path_cost));
        }
        let enough = match (self.until, now.arrived) {
            (Until::Arrived { ticks }, Some((arrived, _))) => judgement.arrived && played >= arrived + ticks,
            _ => false,
        };
        let last = played == now.max_ticks;
        let number = now.number;
        if self.out.is_none() {
            return Ok(if judgement.collided || enough { Verdict::Over } else { Verdict::Continue });
        }
        self.row(tick, &judgement, (last || enough) && !judgement.collided, number);
        Ok(if judgement.collided || enough { Verdict::Over } else { Verdict::Continue })
    }
}

impl EpisodeDriver for Recorder<'_> {
    fn begin(&mut self, episode: &Episode<'_>) -> Result<Option<[u8; 32]>, RecordError> {
        if self.played.is_empty() {
            self.started = Instant::now();
        }
        self.now = Some(Running {
            number: episode.number,
            max_ticks: episode.scenario.max_ticks,
            reward: Reward::new(episode.scenario, self.params),
            total: 0.0,
            arrived: None,
        });
        if let Some(digest) = self.round.policy {
            self.shard.about.policy_sha256 = policy::encoding::hex(&digest);
        }
        Ok(self.round.policy)
    }

    fn another(&mut self, metrics: &RunMetrics) -> Result<bool, RecordError> {
        if let Some(now) = self.now.take() {
            let summary = metrics.finish();
            let (arrived_tick, path) = now.arrived.unwrap_or((summary.ticks, summary.path_cost));
            let success = now.arrived.is_some() && summary.collisions == 0;
            let (episode, ticks, total) = (now.number, summary.ticks, now.total);
            self.played.push(Played { episode, ticks, total, success, arrived_tick, path });
        }
        if (self.played.len() as u64) < self.round.episodes.get() {
            return Ok(true);
        }
        self.write_round()?;
        match self.orders.take() {
            Some(round) => {
                self.round = round;
                Ok(true)
            }
            None => Ok(false),
        }
    }
}
