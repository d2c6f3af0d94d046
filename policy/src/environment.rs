//! Episodes of a team in this process, tick by tick, as whoever learns sees them: fresh starts by seed, what is observed,
//! what is earned, and how an episode ends. Rollouts of processes give the same numbers.

use crate::reward::{Judgement, Reward, Share};
use vodca::horizon::Horizon;
use vodca::local_observation::LocalObserver;
use vodca::metrics::RunMetrics;
use vodca::params::Params;
use vodca::random::episode_seed;
use vodca::scenario::{Scenario, ScenarioError};
use vodca::step::Step;
use vodca::{Position, Team};

/// How episodes differ and when they end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// Every start is moved by up to this much per axis, m.
    pub start_jitter: f64,
    /// A generated layout less its seed (`box:8:3`): every episode has a layout of its own.
    pub family: Option<String>,
    /// Ticks played after everybody has arrived; `None`: every episode lasts until K, as in the paper.
    pub after_arrival: Option<u64>,
}

/// A team and the episode it is in.
pub struct Environment {
    scenario: Scenario,
    params: Params,
    settings: Settings,
    seed: u64,
    episode: u64,
    now: Episode,
}

/// The episode that is being played.
struct Episode {
    scenario: Scenario,
    team: Team,
    reward: Reward,
    metrics: RunMetrics,
    /// Ticks after which everybody had arrived for the first time.
    arrived: Option<u64>,
}

/// How a tick ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended {
    /// What it was worth, and whether somebody collided or everybody has arrived.
    pub judgement: Judgement,
    /// The episode ends by a collision: nothing follows.
    pub terminated: bool,
    /// It is cut off at K or after arrival: what would follow still counts.
    pub truncated: bool,
}

impl Environment {
    /// The first episode of the session with `seed`, before its first tick. `scenario` and `params` are checked.
    ///
    /// # Errors
    /// A layout that cannot be made, or that has no room for moved starts.
    pub fn new(scenario: Scenario, params: Params, settings: Settings, seed: u64) -> Result<Self, ScenarioError> {
        let now = Episode::new(&scenario, &params, &settings, seed)?;
        Ok(Self { scenario, params, settings, seed, episode: 0, now })
    }

    /// The first episode of the session with `seed`.
    ///
    /// # Errors
    /// As of [`Self::new`].
    pub fn restart(&mut self, seed: u64) -> Result<(), ScenarioError> {
        self.begin(seed, 0)
    }

    /// The next episode of the same session.
    ///
    /// # Errors
    /// As of [`Self::new`].
    pub fn next_episode(&mut self) -> Result<(), ScenarioError> {
        self.begin(self.seed, self.episode + 1)
    }

    fn begin(&mut self, seed: u64, episode: u64) -> Result<(), ScenarioError> {
        (self.seed, self.episode) = (seed, episode);
        self.now = Episode::new(&self.scenario, &self.params, &self.settings, episode_seed(seed, episode))?;
        Ok(())
    }

    /// Plays one tick in which robot i plans over `horizons[i]`, moved by `horizon.jitter` as in a run with a policy.
    pub fn step(&mut self, horizons: &mut [Horizon]) -> Ended {
        let Episode { scenario, team, reward, metrics, arrived } = &mut self.now;
        let tick = team.tick();
        for (robot, horizon) in horizons.iter_mut().enumerate() {
            *horizon = horizon.jittered(self.params.horizon.jitter, scenario.seed, robot, tick);
        }
        let steps = team.step(horizons);
        metrics.observe(tick, steps);
        let judgement = reward.tick(tick, steps);
        let played = tick + 1;
        if judgement.arrived {
            arrived.get_or_insert(played);
        }
        let after_arrival = |arrived: u64| self.settings.after_arrival.is_some_and(|ticks| played >= arrived + ticks);
        let enough = judgement.arrived && arrived.is_some_and(after_arrival);
        let terminated = judgement.collided;
        Ended { judgement, terminated, truncated: (enough || played >= scenario.max_ticks) && !terminated }
    }

    /// What `robot` earned in the newest tick.
    pub fn share(&self, robot: usize) -> Share {
        let (tick, steps) = (self.tick(), self.steps());
        if tick == 0 { Share::default() } else { self.now.reward.share(tick - 1, robot, steps) }
    }

    /// What every robot did in the newest tick, by robot number; nothing before the first one.
    pub fn steps(&self) -> &[Step] {
        vodca::play::Playable::steps(&self.now.team) // by its whole name: the trait has a `tick` too
    }

    /// Where every robot measures itself at the start of the next tick, m, by robot number.
    pub fn measured(&self) -> &[Position] {
        self.now.team.measured()
    }

    /// Ticks played in this episode.
    pub fn tick(&self) -> u64 {
        self.now.team.tick()
    }

    /// The figures of this episode so far.
    pub fn metrics(&self) -> &RunMetrics {
        &self.now.metrics
    }

    /// The layout of this episode; its seed is the episode's.
    pub fn scenario(&self) -> &Scenario {
        &self.now.scenario
    }

    /// The parameters of every episode.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Writes what every robot sees into `out`, one after the other, [`LocalObserver::width`] numbers each. `observer` is
    /// of this episode's layout.
    pub fn observe(&self, observer: &LocalObserver, out: &mut [f32]) {
        let (team, steps) = (&self.now.team, self.steps());
        for (robot, out) in out.chunks_exact_mut(observer.width()).enumerate() {
            let last = steps.get(robot);
            observer.observe(robot, team.tick(), team.measured()[robot], last, team.heard_by(robot), out);
        }
    }
}

impl Episode {
    fn new(scenario: &Scenario, params: &Params, settings: &Settings, seed: u64) -> Result<Self, ScenarioError> {
        let Settings { start_jitter, family, .. } = settings;
        let layout = scenario.of_episode(family.as_deref(), *start_jitter, params.model.min_separation, seed)?;
        Ok(Self {
            team: Team::new(&layout, params, seed),
            reward: Reward::new(&layout, params),
            metrics: RunMetrics::new(&layout, params),
            arrived: None,
            scenario: layout,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vodca::horizon_source::HorizonSource;
    use vodca::params::Profile;

    fn environment(name: &str, profile: Profile, settings: Settings) -> Environment {
        let (scenario, params) = vodca::set_up(name, profile, &[]).unwrap();
        Environment::new(scenario, params, settings, 7).unwrap()
    }

    /// Plays the episode with horizons of `steps` steps to its end.
    fn play(environment: &mut Environment, steps: i64) -> Ended {
        loop {
            let mut horizons = vec![Horizon::saturating(steps); environment.measured().len()];
            let ended = environment.step(&mut horizons);
            if ended.terminated || ended.truncated {
                return ended;
            }
        }
    }

    #[test]
    fn an_episode_is_the_run_with_its_seed() {
        let mut played = environment("ex14_d", Profile::Safe, Settings::default());
        let (scenario, params) = vodca::set_up("ex14_d", Profile::Safe, &[]).unwrap();
        let source = HorizonSource::new(&"fixed:20".parse().unwrap(), 14, 7, params.horizon.jitter).unwrap();
        let mut team = Team::new(&scenario, &params, 7);
        for tick in 0..90 {
            let horizons: Vec<Horizon> = (0..14).map(|robot| source.horizon(robot, tick)).collect();
            let steps = team.step(&horizons);
            played.step(&mut [Horizon::saturating(20); 14]);
            for (own, step) in played.steps().iter().zip(steps) {
                assert_eq!((own.next_position, own.horizon, own.rows), (step.next_position, step.horizon, step.rows));
            }
        }
    }

    #[test]
    fn an_episode_ends_after_arrival_where_that_is_asked_for_and_at_k_otherwise() {
        let mut short = environment("two_setpoint", Profile::Safe, Settings::default());
        assert!(play(&mut short, 20).truncated);
        assert_eq!(short.tick(), short.scenario().max_ticks);
        for ticks in [0, 5] {
            let settings = Settings { after_arrival: Some(ticks), ..Settings::default() };
            let mut cut = environment("two_setpoint", Profile::Safe, settings);
            let ended = play(&mut cut, 20);
            assert!(ended.truncated && !ended.terminated && ended.judgement.arrived);
            assert_eq!(cut.now.arrived.unwrap() + ticks, cut.tick());
            assert!(cut.metrics().finish().success);
        }
    }

    #[test]
    fn starts_are_fresh_by_seed_and_episode_and_come_again() {
        let settings = Settings { start_jitter: 0.3, after_arrival: Some(0), ..Settings::default() };
        let mut played = environment("two_setpoint", Profile::Paper, settings);
        let starts = |played: &Environment| played.measured().to_vec();
        let first = starts(&played);
        played.next_episode().unwrap();
        let second = starts(&played);
        assert_ne!(first, second);
        assert_eq!(played.scenario().seed, episode_seed(7, 1));
        play(&mut played, 20);
        played.restart(7).unwrap();
        assert_eq!((starts(&played), played.tick(), played.steps().len()), (first, 0, 0));
        played.next_episode().unwrap();
        assert_eq!(starts(&played), second);
    }

    #[test]
    fn a_collision_terminates() {
        let mut played = environment("two_setpoint", Profile::Paper, Settings::default());
        let ended = (0..350).map(|_| played.step(&mut [Horizon::MIN; 2])).find(|ended| ended.terminated);
        let Some(ended) = ended else { return assert!(!played.metrics().collided()) };
        assert!(!ended.truncated && ended.judgement.collided && played.metrics().collided());
        assert!((0..2).all(|robot| played.share(robot).collided()));
    }

    #[test]
    fn shares_add_up_to_what_the_team_earned() {
        let mut played = environment("four_gate", Profile::Paper, Settings::default());
        for _ in 0..60 {
            let terms = played.step(&mut [Horizon::saturating(24); 4]).judgement.terms;
            let shares: f64 = (0..4).map(|robot| played.share(robot).total()).sum();
            assert!((shares - terms.variance - terms.total()).abs() < 1e-9);
        }
    }
}
