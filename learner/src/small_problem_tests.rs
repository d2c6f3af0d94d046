//! Small problems with a known answer, learnt with a fixed seed.

use crate::replay::Transition;
use crate::sac::Learner;
use crate::settings::Settings;
use vodca::random::{Use, stream, unit};

fn small(batch: usize) -> Settings {
    Settings {
        hidden: 32,
        batch,
        actor_rate: 3e-3,
        critic_rate: 3e-3,
        temperature_rate: 3e-3,
        reward_scale: Some(1.0),
        ..Settings::default()
    }
}

/// tanh of the actor's mean.
fn action(learner: &Learner, observation: &[f32]) -> f32 {
    learner.actor().answer(observation).0[0].tanh()
}

#[test]
fn a_point_is_driven_to_its_goal() {
    // x in [-1, 1] moves by 0.2 a and is paid -x^2: the answer is a = -1 right of 0 and +1 left of it.
    let mut learner = Learner::new(1, 1, small(64), 7);
    let mut generator = stream(7, Use::Problem, 0, 0);
    let mut draw = || 2.0 * unit(&mut generator) as f32 - 1.0;
    for _ in 0..2000 {
        let (x, a) = (draw(), draw());
        let next = (x + 0.2 * a).clamp(-1.0, 1.0);
        let row = Transition {
            observation: &[x],
            action: &[a],
            reward: -next * next,
            terminated: false,
            next_observation: &[next],
        };
        learner.remember(row);
    }
    let far = |learner: &Learner, start: f32| {
        let end = (0..20).fold(start, |x, _| (x + 0.2 * action(learner, &[x])).clamp(-1.0, 1.0));
        end.abs()
    };
    let before = [-0.9, 0.9].map(|start| far(&learner, start)).iter().fold(0.0f32, |most, x| most.max(*x));
    assert!(before > 0.3, "nothing to learn: {before}");
    (0..1500).for_each(|_| {
        learner.update();
    });
    for start in [-0.9, -0.4, 0.4, 0.9] {
        assert!(far(&learner, start) < 0.1, "from {start} to {}", far(&learner, start));
    }
}

#[test]
fn a_bandit_is_solved_and_the_entropy_reaches_its_target() {
    // One state, episodes of one tick, R = -4 (a - 0.5)^2: the best action is 0.5.
    let settings = Settings { target_entropy: Some(-1.0), ..small(64) };
    let mut learner = Learner::new(1, 1, settings, 5);
    let mut generator = stream(5, Use::Problem, 0, 0);
    for _ in 0..1000 {
        let a = 2.0 * unit(&mut generator) as f32 - 1.0;
        let reward = -4.0 * (a - 0.5) * (a - 0.5);
        learner.remember(Transition {
            observation: &[1.0],
            action: &[a],
            reward,
            terminated: true,
            next_observation: &[1.0],
        });
    }
    let losses: Vec<_> = (0..2500).map(|_| learner.update()).collect();
    let best = action(&learner, &[1.0]);
    assert!((best - 0.5).abs() < 0.1, "{best}");
    let entropy = losses[2300..].iter().map(|losses| losses.entropy).sum::<f64>() / 200.0;
    assert!((entropy + 1.0).abs() < 0.2, "{entropy}");
    assert!(learner.temperature() < 0.5, "{}", learner.temperature());
}

#[test]
fn a_time_limit_is_no_end_and_a_collision_is() {
    // A state that pays 1 for ever is worth 1 / (1 - gamma) = 2; one that ends is worth 1. alpha is
    // nearly 0, so that entropy is worth nothing.
    let settings =
        Settings { discount: 0.5, temperature: 1e-6, temperature_fixed: true, target_rate: 0.05, ..small(32) };
    let mut learner = Learner::new(1, 1, settings, 3);
    let mut generator = stream(3, Use::Problem, 0, 0);
    for number in 0..600 {
        let a = 2.0 * unit(&mut generator) as f32 - 1.0;
        let state = if number % 2 == 0 { [1.0] } else { [-1.0] };
        let terminated = number % 2 == 1;
        let row = Transition { observation: &state, action: &[a], reward: 1.0, terminated, next_observation: &state };
        // Every endless row is the last of an episode that the time limit cut.
        if terminated { learner.remember(row) } else { learner.remember_truncated(row) }
    }
    (0..1500).for_each(|_| {
        learner.update();
    });
    let worth = |state: f32| {
        let critic = &learner.critics.pair[0].online;
        let mut pass = crate::network::Pass::new(critic, 1);
        pass.input_mut().copy_from_slice(&[state, action(&learner, &[state])]);
        critic.forward(&mut pass);
        pass.output()[0]
    };
    assert!((worth(1.0) - 2.0).abs() < 0.1, "{}", worth(1.0));
    assert!((worth(-1.0) - 1.0).abs() < 0.1, "{}", worth(-1.0));
}

#[test]
fn nothing_remembered_means_nothing_changes() {
    let mut learner = Learner::new(2, 1, small(4), 1);
    let before = learner.actor().clone();
    assert!(learner.update().critic.is_nan());
    assert_eq!((learner.updates(), learner.actor()), (0, &before));
}
