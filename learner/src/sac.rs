//! One update of soft actor-critic, in the order of the paper: target, critics, actor, temperature,
//! target critics.

use crate::actor::Actor;
use crate::adam::{Adam, clip_factor};
use crate::critics::{Critics, Pairs};
use crate::network::Pass;
use crate::replay::{Batch, Replay, Transition};
use crate::settings::Settings;
use crate::squashed::Sample;
use crate::temperature::Temperature;
use vodca::random::{self, Use};

/// What one update reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Losses {
    /// Mean squared error of both critics.
    pub critic: f64,
    /// Mean of alpha log pi - min Q; NaN at an update that leaves the actor alone.
    pub actor: f64,
    /// J(alpha); NaN where alpha was left alone.
    pub temperature_loss: f64,
    /// alpha after the update.
    pub temperature: f64,
    /// -mean log pi(a|s), nats; NaN at an update that leaves the actor alone.
    pub entropy: f64,
    /// Mean of both critics' answers.
    pub value: f64,
    /// Mean of the soft target y.
    pub target: f64,
}

impl Losses {
    const NOTHING: Losses = Losses {
        critic: f64::NAN,
        actor: f64::NAN,
        temperature_loss: f64::NAN,
        temperature: f64::NAN,
        entropy: f64::NAN,
        value: f64::NAN,
        target: f64::NAN,
    };

    /// Means over some updates; of what only some report, over those.
    pub fn mean(losses: &[Losses]) -> Losses {
        let mean = |part: fn(&Losses) -> f64| {
            let (sum, count) = losses
                .iter()
                .map(part)
                .filter(|value| !value.is_nan())
                .fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
            sum / count
        };
        Losses {
            critic: mean(|losses| losses.critic),
            actor: mean(|losses| losses.actor),
            temperature_loss: mean(|losses| losses.temperature_loss),
            temperature: mean(|losses| losses.temperature),
            entropy: mean(|losses| losses.entropy),
            value: mean(|losses| losses.value),
            target: mean(|losses| losses.target),
        }
    }

    /// Name and value of each curve.
    pub fn scalars(&self) -> [(&'static str, f64); 7] {
        [
            ("loss/critic", self.critic),
            ("loss/actor", self.actor),
            ("loss/temperature", self.temperature_loss),
            ("temperature", self.temperature),
            ("entropy", self.entropy),
            ("value/mean", self.value),
            ("value/target", self.target),
        ]
    }
}

/// Soft actor-critic: networks, optimisers, temperature, memory and counters.
///
/// Everything random depends on (seed, update) only, so a learner that was saved and loaded goes on
/// as if nothing had happened, and one seed gives one result.
#[derive(Clone, Debug)]
pub struct Learner {
    pub(crate) settings: Settings,
    pub(crate) seed: u64,
    pub(crate) updates: u64,
    pub(crate) actor: Actor,
    pub(crate) actor_adam: Adam,
    pub(crate) critics: Critics,
    pub(crate) temperature: Temperature,
    pub(crate) replay: Replay,
    pub(crate) work: Work,
}

/// Room for one update, made once: an update allocates nothing of its own.
#[derive(Clone, Debug)]
pub(crate) struct Work {
    pub(crate) batch: Batch,
    pass: Pass,
    /// a' ~ pi(s').
    pub(crate) next_sample: Sample,
    /// a ~ pi(s).
    pub(crate) sample: Sample,
    target: Vec<f32>,
    smaller: Vec<f32>,
    action_gradient: Vec<f32>,
    gradient: Vec<f32>,
}

/// What the draws of one update are for.
#[derive(Clone, Copy)]
enum Draw {
    Rows,
    NextAction,
    Action,
}

impl Learner {
    /// A learner for `observations` (2N) and `actions` (N) with first weights from `seed`.
    pub fn new(observations: usize, actions: usize, settings: Settings, seed: u64) -> Self {
        let actor = Actor::new(observations, actions, &settings, seed);
        let rows = settings.batch;
        let work = Work {
            batch: Batch::new(rows, observations, actions),
            pass: Pass::new(actor.network(), rows),
            next_sample: Sample::new(rows, actions),
            sample: Sample::new(rows, actions),
            target: vec![0.0; rows],
            smaller: vec![0.0; rows],
            action_gradient: vec![0.0; rows * actions],
            gradient: vec![0.0; actor.network().parameters().len()],
        };
        Self {
            seed,
            updates: 0,
            actor_adam: Adam::new(actor.network().parameters().len()),
            actor,
            critics: Critics::new(observations, actions, &settings, seed),
            temperature: Temperature::new(settings.temperature),
            replay: Replay::new(settings.replay_rows, observations, actions),
            settings,
            work,
        }
    }

    /// Remembers one transition.
    pub fn remember(&mut self, transition: Transition) {
        self.replay.push(transition, false);
    }

    /// Remembers the transition at which a time limit cut the episode: what follows s' still counts.
    pub fn remember_truncated(&mut self, transition: Transition) {
        self.replay.push(transition, true);
    }

    /// Favours the newest `rows` rows (a successful episode), see [`Settings::favoured_share`].
    pub fn favour_newest(&mut self, rows: usize) {
        self.replay.favour_newest(rows);
    }

    /// One update from one batch. With nothing remembered nothing changes and every loss is NaN.
    pub fn update(&mut self) -> Losses {
        if self.replay.is_empty() {
            return Losses::NOTHING;
        }
        self.draw();
        self.step()
    }

    /// The update for what was drawn.
    pub(crate) fn step(&mut self) -> Losses {
        let target = self.soft_target();
        let (critic, value) = self.critic_step();
        let mut losses = Losses { critic, value, target, ..Losses::NOTHING };
        if self.updates.is_multiple_of(self.settings.actor_delay) {
            (losses.actor, losses.entropy) = self.actor_step();
            losses.temperature_loss = self.temperature_step(losses.entropy);
        }
        self.critics.move_targets(self.settings.target_rate);
        self.updates += 1;
        Losses { temperature: self.temperature.value(), ..losses }
    }

    /// (s, a, R, s') ~ replay buffer, and eps for both sampled actions.
    pub(crate) fn draw(&mut self) {
        let generator = |draw: Draw| random::stream(self.seed, Use::Learning, self.updates, draw as u64);
        self.replay.draw(&mut generator(Draw::Rows), self.settings.favoured_share, &mut self.work.batch);
        self.work.next_sample.draw(&mut generator(Draw::NextAction));
        self.work.sample.draw(&mut generator(Draw::Action));
    }

    /// y = R + gamma (1 - terminated) (min Q'(s', a') - alpha log pi(a'|s')), a' ~ pi(s'). Returns its mean.
    fn soft_target(&mut self) -> f64 {
        let scale = self.settings.reward_scale(self.actor.actions()) as f32;
        let (discount, alpha) = (self.settings.discount as f32, self.temperature.value() as f32);
        let Work { batch, pass, next_sample: sample, target, smaller, .. } = &mut self.work;
        pass.input_mut().copy_from_slice(&batch.next_observation);
        self.actor.network().forward(pass);
        sample.squash(pass.output(), self.actor.bounds());
        let pairs = Pairs { observation: &batch.next_observation, action: &sample.action };
        self.critics.target_minimum(pairs, smaller);
        for (row, target) in target.iter_mut().enumerate() {
            let soft_value = smaller[row] - alpha * sample.log_probability[row];
            // A terminated row's soft value is not even multiplied with 0: it may be anything.
            let follows = if batch.terminated[row] { 0.0 } else { discount * soft_value };
            *target = scale * batch.reward[row] + follows;
        }
        mean(target)
    }

    /// Both critics: one step down mean (Q(s, a) - y)^2. Returns the loss and the mean Q.
    fn critic_step(&mut self) -> (f64, f64) {
        let Work { batch, target, .. } = &self.work;
        let pairs = Pairs { observation: &batch.observation, action: &batch.action };
        self.critics.learn(pairs, target, &self.settings)
    }

    /// The actor: one step down mean (alpha log pi(a|s) - min Q(s, a)), a ~ pi(s) reparameterised. Returns
    /// the loss and the entropy.
    fn actor_step(&mut self) -> (f64, f64) {
        let alpha = self.temperature.value();
        let Work { batch, pass, sample, smaller, action_gradient, gradient, .. } = &mut self.work;
        let share = 1.0 / smaller.len() as f32;
        pass.input_mut().copy_from_slice(&batch.observation);
        self.actor.network().forward(pass);
        sample.squash(pass.output(), self.actor.bounds());
        let pairs = Pairs { observation: &batch.observation, action: &sample.action };
        self.critics.minimum(pairs, -share, smaller, action_gradient);
        sample.backward(alpha as f32 * share, action_gradient, pass.output_gradient_mut());
        self.actor.network().backward(pass, Some(gradient), None);
        let factor = clip_factor(gradient, self.settings.gradient_clip);
        self.actor_adam.step(self.actor.network_mut().parameters_mut(), gradient, self.settings.actor_rate, factor);
        let entropy = -mean(&sample.log_probability);
        (-alpha * entropy - mean(smaller), entropy)
    }

    /// alpha: one step down J(alpha), unless it is fixed. Returns J.
    fn temperature_step(&mut self, entropy: f64) -> f64 {
        if self.settings.temperature_fixed {
            return f64::NAN;
        }
        let target = self.settings.target_entropy(self.actor.actions());
        self.temperature.learn(-entropy, target, self.settings.temperature_rate)
    }

    /// The actor as it is now.
    pub fn actor(&self) -> &Actor {
        &self.actor
    }

    /// Updates so far.
    pub fn updates(&self) -> u64 {
        self.updates
    }

    /// What it learns with.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// alpha.
    pub fn temperature(&self) -> f64 {
        self.temperature.value()
    }

    /// What it remembers.
    pub fn replay(&self) -> &Replay {
        &self.replay
    }
}

fn mean(numbers: &[f32]) -> f64 {
    numbers.iter().map(|number| f64::from(*number)).sum::<f64>() / numbers.len() as f64
}
