//! From a model's answer to actions and horizons: the mean, or a sample that depends on the seed,
//! the tick and the robot only.

use crate::actor::Answer;
use policy::contract::Contract;
use vodca::horizon::Horizon;
use vodca::random::{self, Use};

/// How horizons are chosen from an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The mean: what is evaluated and driven.
    Mean,
    /// tanh(mu + exp(log_std) eps): what rollouts for learning need.
    Sample {
        /// Seed of eps.
        seed: u64,
    },
}

/// The standard normal draw of one robot and tick.
fn normal(seed: u64, robot: usize, tick: u64) -> f64 {
    random::normal(&mut random::stream(seed, Use::Policy, robot as u64, tick))
}

/// The action of `robot` at `tick` in [-1, 1], and its horizon; `None` when the answer is not finite.
pub fn choose(contract: &Contract, answer: &Answer, choice: Choice, robot: usize, tick: u64) -> Option<(f64, Horizon)> {
    let mean = f64::from(*answer.mean.get(robot)?);
    let raw = match (choice, answer.log_std.get(robot)) {
        (Choice::Mean, None) => mean,
        (Choice::Mean, Some(log_std)) if log_std.is_finite() => mean,
        (Choice::Sample { seed }, Some(log_std)) => mean + f64::from(*log_std).exp() * normal(seed, robot, tick),
        _ => return None,
    };
    let action = contract.action(raw);
    Some((action, contract.horizon(action).filter(|_| raw.is_finite())?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_chosen_as_it_is() {
        let contract = Contract::standard(2, true);
        let answer = Answer { mean: vec![0.0, 0.5], log_std: vec![0.0, 0.0] };
        let (action, horizon) = choose(&contract, &answer, Choice::Mean, 1, 7).unwrap();
        assert_eq!((action, horizon.steps()), (0.5f64.tanh(), 37)); // 1 + (0.4621 + 1) 24 = 36.09
    }

    #[test]
    fn a_sample_depends_on_seed_robot_and_tick_only() {
        let contract = Contract::standard(2, true);
        let answer = Answer { mean: vec![0.1, 0.1], log_std: vec![-1.0, -1.0] };
        let draw = |seed, robot, tick| choose(&contract, &answer, Choice::Sample { seed }, robot, tick).unwrap().0;
        assert_eq!(draw(1, 0, 5), draw(1, 0, 5));
        assert_ne!(draw(1, 0, 5), draw(2, 0, 5));
        assert_ne!(draw(1, 0, 5), draw(1, 1, 5));
        assert_ne!(draw(1, 0, 5), draw(1, 0, 6));
    }

    #[test]
    fn samples_have_the_mean_and_spread_that_the_model_says() {
        let contract = Contract::standard(1, true);
        let answer = Answer { mean: vec![0.5], log_std: vec![0.25f32.ln()] };
        let sampled = |tick| choose(&contract, &answer, Choice::Sample { seed: 3 }, 0, tick).unwrap().0.atanh();
        let draws: Vec<f64> = (0..20_000).map(sampled).collect();
        let mean = draws.iter().sum::<f64>() / 20_000.0;
        let variance = draws.iter().map(|draw| (draw - mean).powi(2)).sum::<f64>() / 20_000.0;
        // Five standard errors of a normal draw with spread 0.25.
        assert!((mean - 0.5).abs() < 0.25 * 0.036 && (variance / 0.0625 - 1.0).abs() < 0.05, "{mean} {variance}");
    }

    #[test]
    fn numbers_that_are_not_finite_choose_nothing() {
        let contract = Contract::standard(1, true);
        let one = |mean, log_std| Answer { mean: vec![mean], log_std: vec![log_std] };
        let sampled = Choice::Sample { seed: 1 };
        assert_eq!(choose(&contract, &one(f32::NAN, 0.0), Choice::Mean, 0, 0), None);
        assert_eq!(choose(&contract, &one(f32::INFINITY, 0.0), Choice::Mean, 0, 0), None);
        assert_eq!(choose(&contract, &one(0.0, f32::NAN), Choice::Mean, 0, 0), None);
        assert_eq!(choose(&contract, &one(0.0, f32::INFINITY), sampled, 0, 0), None);
        let no_spread = Answer { mean: vec![0.0], log_std: vec![] };
        assert_eq!(choose(&contract, &no_spread, sampled, 0, 0), None);
        assert!(choose(&contract, &no_spread, Choice::Mean, 0, 0).is_some());
    }
}
