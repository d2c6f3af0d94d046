//! Random numbers by counter: a draw depends on its seed and coordinates only, never on who drew
//! before, so that runs do not depend on the order of processes.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};

/// What a draw is for. Each use has its own stream, so that uses sharing a seed stay independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Use {
    /// `random:SEED` horizons.
    Horizon = 1,
    /// The jitter of the horizon.
    HorizonJitter = 2,
    /// Measurement noise.
    Noise = 3,
    /// Which messages get lost.
    Loss = 4,
    /// Generated scenarios.
    Scenario = 5,
    /// Jittered start positions.
    StartJitter = 6,
    /// Samples of a stochastic policy.
    Policy = 7,
    /// Random QPs for tests and benchmarks.
    Problem = 8,
    /// Pushes that break the symmetry of a baseline.
    Push = 9,
    /// Resamples of a bootstrap.
    Resample = 10,
    /// Seeds of the episodes of a session.
    Episode = 11,
    /// Draws of a search.
    Search = 12,
    /// Directions in which a stuck robot backs off.
    BackOff = 13,
    /// Faults on purpose.
    Fault = 14,
    /// Where robots go next that have arrived.
    Task = 15,
    /// The learner's first weights, batches and action noise.
    Learning = 20,
}

/// The generator of one `(seed, use, a, b)` coordinate, positioned at its first draw.
pub fn stream(seed: u64, purpose: Use, a: u64, b: u64) -> ChaCha8Rng {
    let mut key = [0u8; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&(purpose as u64).to_le_bytes());
    key[16..24].copy_from_slice(&a.to_le_bytes());
    key[24..].copy_from_slice(&b.to_le_bytes());
    ChaCha8Rng::from_seed(key)
}

/// Seed of episode `episode` of a session with `seed`; episode 0 has the session's own. 63 bits: TOML
/// knows no larger numbers.
pub fn episode_seed(seed: u64, episode: u64) -> u64 {
    if episode == 0 { seed } else { stream(seed, Use::Episode, episode, 0).next_u64() >> 1 }
}

/// A draw from `0..bound`, without bias (rejection).
pub fn below(generator: &mut impl Rng, bound: u64) -> u64 {
    debug_assert!(bound > 0);
    let limit = u64::MAX - u64::MAX % bound;
    loop {
        let draw = generator.next_u64();
        if draw < limit {
            return draw % bound;
        }
    }
}

/// A draw from `[0, 1)` with 53 bits.
pub fn unit(generator: &mut impl Rng) -> f64 {
    (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// A standard normal draw (Box and Muller).
pub fn normal(generator: &mut impl Rng) -> f64 {
    let radius = (-2.0 * (1.0 - unit(generator)).ln()).sqrt();
    radius * (std::f64::consts::TAU * unit(generator)).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draw_depends_on_its_coordinates_only() {
        let draw = |seed, a, b| stream(seed, Use::Horizon, a, b).next_u64();
        assert_eq!(draw(1, 2, 3), draw(1, 2, 3));
        assert_ne!(draw(1, 2, 3), draw(2, 2, 3));
        assert_ne!(draw(1, 2, 3), draw(1, 3, 3));
        assert_ne!(draw(1, 2, 3), draw(1, 2, 4));
    }

    #[test]
    fn below_is_uniform_over_the_horizons() {
        let mut count = [0u32; 49];
        for tick in 0..49_000 {
            count[below(&mut stream(7, Use::Horizon, 0, tick), 49) as usize] += 1;
        }
        // 1,000 expected each; five standard deviations of a binomial.
        assert!(count.iter().all(|&c| (840..=1160).contains(&c)), "{count:?}");
    }

    #[test]
    fn unit_draws_stay_in_their_interval() {
        let mut generator = stream(3, Use::Noise, 0, 0);
        let draws: Vec<f64> = (0..1000).map(|_| unit(&mut generator)).collect();
        assert!(draws.iter().all(|u| (0.0..1.0).contains(u)));
        let mean = draws.iter().sum::<f64>() / 1000.0;
        assert!((mean - 0.5).abs() < 0.05, "{mean}");
    }

    #[test]
    fn normal_draws_have_mean_0_and_variance_1() {
        let mut generator = stream(3, Use::Policy, 0, 0);
        let draws: Vec<f64> = (0..20_000).map(|_| normal(&mut generator)).collect();
        let mean = draws.iter().sum::<f64>() / 20_000.0;
        let variance = draws.iter().map(|draw| (draw - mean).powi(2)).sum::<f64>() / 20_000.0;
        // Five standard errors: 5 / sqrt(20000) and 5 sqrt(2 / 20000).
        assert!(mean.abs() < 0.036 && (variance - 1.0).abs() < 0.05, "{mean} {variance}");
        assert!(draws.iter().any(|draw| *draw > 2.5) && draws.iter().any(|draw| *draw < -2.5));
    }
}
