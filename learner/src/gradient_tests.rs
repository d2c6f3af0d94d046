//! Every gradient of an update against f64 finite differences of the loss as the paper writes it.

use crate::adam::Adam;
use crate::reference::{difference, network, squash, wide};
use crate::replay::Transition;
use crate::sac::{Learner, Work};
use crate::settings::Settings;
use vodca::random::{Use, stream, unit};

const S: usize = 6;
const A: usize = 3;
const HIDDEN: usize = 11;
const BATCH: usize = 5;

fn settings() -> Settings {
    Settings {
        hidden: HIDDEN,
        batch: BATCH,
        temperature: 0.3,
        log_std_min: -0.2,
        log_std_max: 0.2,
        ..Settings::default()
    }
}

fn actor_widths() -> [usize; 4] {
    [S, HIDDEN, HIDDEN, 2 * A]
}

fn critic_widths() -> [usize; 4] {
    [S + A, HIDDEN, HIDDEN, 1]
}

/// A learner with a few remembered rows, some of them terminated, and targets that differ from their critics.
fn learner() -> Learner {
    let mut learner = Learner::new(S, A, settings(), 3);
    let mut generator = stream(1, Use::Problem, 0, 0);
    let mut draw = |count: usize| -> Vec<f32> { (0..count).map(|_| 2.0 * unit(&mut generator) as f32 - 1.0).collect() };
    for number in 0..12 {
        let (s, a, n, r) = (draw(S), draw(A), draw(S), draw(1));
        let row = Transition {
            observation: &s,
            action: &a,
            reward: 50.0 * r[0],
            terminated: number % 3 == 0,
            next_observation: &n,
        };
        if number % 4 == 1 { learner.remember_truncated(row) } else { learner.remember(row) }
    }
    for critic in &mut learner.critics.pair {
        critic.target.parameters_mut().iter_mut().zip(draw(10_000)).for_each(|(w, d)| *w += 0.05 * d);
    }
    learner
}

/// The gradient that a first Adam step was given: m = 0.1 g.
fn first_gradient(adam: &Adam) -> Vec<f64> {
    assert_eq!(adam.steps, 1);
    adam.first.iter().map(|m| f64::from(*m) * 10.0).collect()
}

/// Rows of `[count, width]` numbers.
fn rows(numbers: &[f32], width: usize) -> Vec<Vec<f64>> {
    numbers.chunks_exact(width).map(wide).collect()
}

fn q(parameters: &[f64], s: &[f64], a: &[f64]) -> f64 {
    network(&critic_widths(), parameters, &[s, a].concat())[0]
}

/// What the update drew: the batch and both noises, by the learner's own generators.
struct Drawn {
    s: Vec<Vec<f64>>,
    a: Vec<Vec<f64>>,
    r: Vec<f64>,
    terminated: Vec<bool>,
    next: Vec<Vec<f64>>,
    next_noise: Vec<Vec<f64>>,
    noise: Vec<Vec<f64>>,
}

fn drawn(learner: &Learner) -> Drawn {
    let mut copy = learner.clone();
    copy.draw();
    let Work { batch, next_sample, sample, .. } = copy.work;
    Drawn {
        s: rows(&batch.observation, S),
        a: rows(&batch.action, A),
        r: wide(&batch.reward),
        terminated: batch.terminated,
        next: rows(&batch.next_observation, S),
        next_noise: rows(&next_sample.noise, A),
        noise: rows(&sample.noise, A),
    }
}

const BOUNDS: (f64, f64) = (-0.2f32 as f64, 0.2f32 as f64);

/// y of the paper from the parameters before the update.
fn targets(learner: &Learner, drawn: &Drawn) -> Vec<f64> {
    let actor = wide(learner.actor.network().parameters());
    let [first, second] = learner.critics.pair.each_ref().map(|critic| wide(critic.target.parameters()));
    let alpha = learner.temperature();
    let scale = settings().reward_scale(A);
    (0..BATCH)
        .map(|row| {
            let s = &drawn.next[row];
            let (a, log_probability) = squash(&network(&actor_widths(), &actor, s), &drawn.next_noise[row], BOUNDS);
            let value = q(&first, s, &a).min(q(&second, s, &a)) - alpha * log_probability;
            scale * drawn.r[row] + if drawn.terminated[row] { 0.0 } else { 0.99 * value }
        })
        .collect()
}

fn check(name: &str, gradient: &[f64], parameters: &[f64], loss: impl Fn(&[f64]) -> f64) {
    let largest = gradient.iter().fold(0.0f64, |most, g| most.max(g.abs()));
    assert!(largest > 1e-4, "{name}: nothing to check");
    let mut different = 0;
    for (index, gradient) in gradient.iter().enumerate() {
        let expected = difference(parameters, index, &loss);
        let error = (gradient - expected).abs();
        assert!(error < 1e-3 * expected.abs() + 2e-5 * largest, "{name} {index}: {gradient} {expected}");
        different += usize::from(expected.abs() > 1e-9);
    }
    assert!(different * 3 > gradient.len(), "{name}: only {different} of {} matter", gradient.len());
}

#[test]
fn the_critics_gradient_is_that_of_their_loss() {
    let before = learner();
    let (mut after, drawn) = (before.clone(), drawn(&before));
    let y = targets(&before, &drawn);
    let losses = after.update();
    let mut total = 0.0;
    for (old, new) in before.critics.pair.iter().zip(&after.critics.pair) {
        let loss = |parameters: &[f64]| {
            let error = |row: usize| q(parameters, &drawn.s[row], &drawn.a[row]) - y[row];
            (0..BATCH).map(|row| error(row).powi(2)).sum::<f64>() / BATCH as f64
        };
        let parameters = wide(old.online.parameters());
        total += loss(&parameters) / 2.0;
        check("critic", &first_gradient(&new.adam), &parameters, loss);
    }
    assert!((losses.critic - total).abs() < 1e-4 * total, "{} {total}", losses.critic);
    let mean = y.iter().sum::<f64>() / BATCH as f64;
    assert!((losses.target - mean).abs() < 1e-5, "{} {mean}", losses.target);
}

#[test]
fn the_actors_gradient_is_that_of_its_loss_with_the_new_critics() {
    let before = learner();
    let (mut after, drawn) = (before.clone(), drawn(&before));
    let losses = after.update();
    let [first, second] = after.critics.pair.each_ref().map(|critic| wide(critic.online.parameters()));
    let alpha = before.temperature();
    let row_loss = |parameters: &[f64], row: usize| {
        let s = &drawn.s[row];
        let (a, log_probability) = squash(&network(&actor_widths(), parameters, s), &drawn.noise[row], BOUNDS);
        alpha * log_probability - q(&first, s, &a).min(q(&second, s, &a))
    };
    let loss = |parameters: &[f64]| (0..BATCH).map(|row| row_loss(parameters, row)).sum::<f64>() / BATCH as f64;
    let parameters = wide(before.actor.network().parameters());
    // The bounds of log sigma must cut somewhere and not everywhere, or the mask is not checked.
    let log_stds: Vec<f64> =
        drawn.s.iter().flat_map(|s| network(&actor_widths(), &parameters, s)[A..].to_vec()).collect();
    let cut = log_stds.iter().filter(|log_std| !(BOUNDS.0..=BOUNDS.1).contains(*log_std)).count();
    assert!(cut > 0 && cut < log_stds.len(), "{cut}");
    check("actor", &first_gradient(&after.actor_adam), &parameters, loss);
    assert!((losses.actor - loss(&parameters)).abs() < 1e-4, "{} {}", losses.actor, loss(&parameters));
}

#[test]
fn the_temperatures_gradient_is_that_of_its_loss() {
    let before = learner();
    let mut after = before.clone();
    let losses = after.update();
    let loss = |logarithm: &[f64]| -logarithm[0].exp() * (-losses.entropy + settings().target_entropy(A));
    let logarithm = [f64::from(before.temperature.logarithm)];
    check("temperature", &first_gradient(&after.temperature.adam), &logarithm, loss);
    assert!((losses.temperature_loss - loss(&logarithm)).abs() < 1e-9);
}

#[test]
fn the_actors_step_leaves_the_critics_alone() {
    let mut with = learner();
    with.updates = 1;
    let mut without = with.clone();
    without.settings.actor_delay = 2; // 1 is no multiple of it: no step of the actor.
    with.update();
    without.update();
    assert!(with.actor_adam.steps == 1 && without.actor_adam.steps == 0);
    for (critic, other) in with.critics.pair.iter().zip(&without.critics.pair) {
        assert!(critic.online == other.online && critic.target == other.target && critic.adam == other.adam);
    }
}
