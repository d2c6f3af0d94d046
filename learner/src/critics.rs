//! The twin critics Q(s, a) with their targets.

use crate::adam::{Adam, clip_factor};
use crate::network::{Network, Pass};
use crate::settings::Settings;
use crate::simd::wide;

/// Two critics with the same task and different first weights; the smaller answer counts, because
/// each alone overestimates.
#[derive(Clone, Debug)]
pub struct Critics {
    /// Both.
    pub pair: [Critic; 2],
    batch: usize,
    side_by_side: bool,
}

/// One critic: the network that learns, its slow target and the optimiser's memory.
#[derive(Clone, Debug)]
pub struct Critic {
    /// Q.
    pub online: Network,
    /// Q', which follows Q slowly.
    pub target: Network,
    /// Of `online`.
    pub adam: Adam,
    pass: Pass,
    gradient: Vec<f32>,
    action_gradient: Vec<f32>,
}

/// States and actions of a batch, `[batch, 2N]` and `[batch, N]`.
#[derive(Clone, Copy, Debug)]
pub struct Pairs<'a> {
    /// s.
    pub observation: &'a [f32],
    /// a.
    pub action: &'a [f32],
}

impl Critic {
    fn new(observations: usize, actions: usize, settings: &Settings, seed: u64, number: u64) -> Self {
        let online = Network::new(&[observations + actions, settings.hidden, settings.hidden, 1], seed, number);
        let parameters = online.parameters().len();
        Self {
            target: online.clone(),
            adam: Adam::new(parameters),
            pass: Pass::new(&online, settings.batch),
            gradient: vec![0.0; parameters],
            action_gradient: vec![0.0; settings.batch * actions],
            online,
        }
    }

    /// Writes the input: each row the observation, then the action.
    fn set_input(&mut self, pairs: Pairs) {
        let batch = self.pass.batch();
        let (width, n) = (pairs.observation.len() / batch, pairs.action.len() / batch);
        let rows = pairs.observation.chunks_exact(width).zip(pairs.action.chunks_exact(n));
        for (input, (observation, action)) in self.pass.input_mut().chunks_exact_mut(width + n).zip(rows) {
            input[..width].copy_from_slice(observation);
            input[width..].copy_from_slice(action);
        }
    }

    /// One step towards `target`; returns the sums of (Q - y)^2 and of Q.
    fn learn(&mut self, pairs: Pairs, target: &[f32], settings: &Settings) -> (f64, f64) {
        self.set_input(pairs);
        self.online.forward(&mut self.pass);
        let (mut loss, mut value) = (0.0, 0.0);
        let batch = target.len() as f32;
        for (row, target) in target.iter().enumerate() {
            let answer = self.pass.output()[row];
            let error = answer - target;
            loss += f64::from(error * error);
            value += f64::from(answer);
            self.pass.output_gradient_mut()[row] = 2.0 * error / batch;
        }
        self.online.backward(&mut self.pass, Some(&mut self.gradient), None);
        let factor = clip_factor(&self.gradient, settings.gradient_clip);
        self.adam.step(self.online.parameters_mut(), &self.gradient, settings.critic_rate, factor);
        (loss, value)
    }
}

impl Critics {
    /// Critics with first weights from `seed`; targets start equal to them.
    pub fn new(observations: usize, actions: usize, settings: &Settings, seed: u64) -> Self {
        let pair = [1, 2].map(|number| Critic::new(observations, actions, settings, seed, number));
        Self { pair, batch: settings.batch, side_by_side: settings.threads > 1 }
    }

    /// Does the same with both critics, on two threads when there are two.
    fn both<T: Send>(&mut self, task: impl Fn(&mut Critic) -> T + Sync) -> [T; 2] {
        let [first, second] = &mut self.pair;
        if !self.side_by_side {
            return [task(first), task(second)];
        }
        std::thread::scope(|scope| {
            let other = scope.spawn(|| task(second));
            let mine = task(first);
            // A panic there is a panic here.
            [mine, other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))]
        })
    }

    /// min over the two TARGET critics of Q'(s, a), into `smaller` `[batch]`.
    pub fn target_minimum(&mut self, pairs: Pairs, smaller: &mut [f32]) {
        self.both(|critic| {
            critic.set_input(pairs);
            critic.target.forward(&mut critic.pass);
        });
        for (row, smaller) in smaller.iter_mut().enumerate() {
            let [first, second] = self.pair.each_ref().map(|critic| critic.pass.output()[row]);
            *smaller = if second < first { second } else { first };
        }
    }

    /// One step of both critics towards `target` y `[batch]`, down L = mean of (Q(s, a) - y)^2 each.
    /// Returns the mean of both losses and the mean of all Q.
    pub fn learn(&mut self, pairs: Pairs, target: &[f32], settings: &Settings) -> (f64, f64) {
        let [first, second] = self.both(|critic| critic.learn(pairs, target, settings));
        let rows = 2.0 * self.batch as f64;
        ((first.0 + second.0) / rows, (first.1 + second.1) / rows)
    }

    /// min over the two critics of Q(s, a) into `smaller` `[batch]`, and `weight` times its gradient
    /// with respect to the actions into `gradient` `[batch, N]`. The critics learn nothing from it.
    pub fn minimum(&mut self, pairs: Pairs, weight: f32, smaller: &mut [f32], gradient: &mut [f32]) {
        self.both(|critic| {
            critic.set_input(pairs);
            critic.online.forward(&mut critic.pass);
        });
        for (row, smaller) in smaller.iter_mut().enumerate() {
            let [first, second] = self.pair.each_ref().map(|critic| critic.pass.output()[row]);
            let second_counts = second < first;
            *smaller = if second_counts { second } else { first };
            let weights = if second_counts { [0.0, weight] } else { [weight, 0.0] };
            for (critic, weight) in self.pair.iter_mut().zip(weights) {
                critic.pass.output_gradient_mut()[row] = weight;
            }
        }
        self.both(|critic| critic.online.backward(&mut critic.pass, None, Some(&mut critic.action_gradient)));
        let [first, second] = &self.pair;
        let both = first.action_gradient.iter().zip(&second.action_gradient);
        gradient.iter_mut().zip(both).for_each(|(gradient, (first, second))| *gradient = first + second);
    }

    /// The targets move by `rate` (tau) towards the critics.
    pub fn move_targets(&mut self, rate: f64) {
        let rate = rate as f32;
        for critic in &mut self.pair {
            let (target, online) = (critic.target.parameters_mut(), critic.online.parameters());
            wide(|| target.iter_mut().zip(online).for_each(|(target, online)| *target += rate * (online - *target)));
        }
    }
}
