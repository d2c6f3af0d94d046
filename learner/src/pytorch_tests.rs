//! Three updates against PyTorch's, number by number (`bench/cleanrl_sac.py vector` wrote them).

use crate::replay::Transition;
use crate::sac::Learner;
use crate::settings::Settings;
use serde::Deserialize;

#[derive(Deserialize)]
struct Vector {
    states: usize,
    actions: usize,
    hidden: usize,
    batch: usize,
    before: Parameters,
    updates: Vec<Update>,
    after: Parameters,
}

#[derive(Deserialize)]
struct Parameters {
    actor: Vec<f32>,
    critics: [Vec<f32>; 2],
    targets: [Vec<f32>; 2],
    log_alpha: f32,
}

#[derive(Deserialize)]
struct Update {
    s: Vec<f32>,
    a: Vec<f32>,
    r: Vec<f32>,
    done: Vec<f32>,
    s2: Vec<f32>,
    noise2: Vec<f32>,
    noise: Vec<f32>,
    critic: f64,
    actor: f64,
    alpha: f64,
}

fn near(name: &str, got: &[f32], expected: &[f32]) {
    assert_eq!(got.len(), expected.len(), "{name}");
    let apart = got.iter().zip(expected).map(|(got, expected)| (got - expected).abs()).fold(0.0, f32::max);
    // Three steps of 3e-4 move a parameter by up to 9e-4.
    assert!(apart < 2e-6, "{name}: {apart}");
}

#[test]
fn three_updates_are_those_of_pytorch() {
    let vector: Vector = serde_json::from_str(include_str!("../tests/pytorch_vector.json")).unwrap();
    let (states, actions) = (vector.states, vector.actions);
    let settings =
        Settings { hidden: vector.hidden, batch: vector.batch, reward_scale: Some(1.0), ..Settings::default() };
    let mut learner = Learner::new(states, actions, settings, 1);
    learner.actor.network_mut().parameters_mut().copy_from_slice(&vector.before.actor);
    for (at, critic) in learner.critics.pair.iter_mut().enumerate() {
        critic.online.parameters_mut().copy_from_slice(&vector.before.critics[at]);
        critic.target.parameters_mut().copy_from_slice(&vector.before.targets[at]);
    }
    let zeros = vec![0.0; states];
    let row = Transition {
        observation: &zeros,
        action: &zeros[..actions],
        reward: 0.0,
        terminated: false,
        next_observation: &zeros,
    };
    learner.remember(row);
    for update in &vector.updates {
        learner.draw();
        let work = &mut learner.work;
        work.batch.observation.copy_from_slice(&update.s);
        work.batch.action.copy_from_slice(&update.a);
        work.batch.reward.copy_from_slice(&update.r);
        work.batch.next_observation.copy_from_slice(&update.s2);
        work.batch.terminated = update.done.iter().map(|done| *done != 0.0).collect();
        work.next_sample.noise.copy_from_slice(&update.noise2);
        work.sample.noise.copy_from_slice(&update.noise);
        let losses = learner.step();
        for (name, got, expected) in [
            ("critic", losses.critic, update.critic),
            ("actor", losses.actor, update.actor),
            ("temperature", losses.temperature_loss, update.alpha),
        ] {
            assert!((got - expected).abs() < 1e-5 * expected.abs().max(1.0), "{name}: {got} {expected}");
        }
    }
    near("actor", learner.actor.network().parameters(), &vector.after.actor);
    for (at, critic) in learner.critics.pair.iter().enumerate() {
        near("critic", critic.online.parameters(), &vector.after.critics[at]);
        near("target", critic.target.parameters(), &vector.after.targets[at]);
    }
    near("temperature", &[learner.temperature.logarithm], &[vector.after.log_alpha]);
    assert!(vector.before.actor.iter().zip(&vector.after.actor).any(|(before, after)| (before - after).abs() > 5e-4));
}
