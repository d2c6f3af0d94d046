//! The tanh Gaussian: a = tanh(u), u = mu + sigma eps, eps ~ N(0, 1), per robot (the paper's policy).
//!
//! log pi(a|s) = sum_i [ -eps_i^2 / 2 - log sigma_i - log(2 pi) / 2 - log(1 - a_i^2) ], and
//! log(1 - tanh(u)^2) = 2 (log 2 - u - softplus(-2u)), which is finite for every u.

use chacha20::rand_core::Rng;

/// Bounds of log sigma; the gradient is zero where they cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogStdBounds {
    /// Lower.
    pub low: f32,
    /// Upper.
    pub high: f32,
}

impl LogStdBounds {
    /// The value within the bounds (a NaN stays one), as ONNX's Clip.
    pub fn clip(self, log_std: f32) -> f32 {
        log_std.clamp(self.low, self.high)
    }

    fn cuts(self, log_std: f32) -> bool {
        log_std < self.low || log_std > self.high
    }
}

/// log(1 + exp(x)) without overflow.
pub fn softplus(x: f32) -> f32 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}

/// log(1 - tanh(u)^2).
pub fn log_slope(u: f32) -> f32 {
    2.0 * (std::f32::consts::LN_2 - u - softplus(-2.0 * u))
}

/// Actions drawn for a batch, with what their gradient needs.
#[derive(Clone, Debug)]
pub struct Sample {
    actions: usize,
    /// eps, `[batch, N]`; drawn or set before [`Sample::squash`].
    pub noise: Vec<f32>,
    /// a = tanh(u), `[batch, N]`.
    pub action: Vec<f32>,
    /// log pi(a|s), `[batch]`.
    pub log_probability: Vec<f32>,
    /// sigma eps where the bounds do not cut, otherwise 0, `[batch, N]`.
    slope: Vec<f32>,
    /// 1 where the bounds do not cut, otherwise 0, `[batch, N]`.
    inside: Vec<f32>,
}

impl Sample {
    /// Room for `batch` rows of `actions` robots.
    pub fn new(batch: usize, actions: usize) -> Self {
        let wide = vec![0.0; batch * actions];
        let log_probability = vec![0.0; batch];
        Self { actions, noise: wide.clone(), action: wide.clone(), log_probability, slope: wide.clone(), inside: wide }
    }

    /// Draws eps (Box and Muller, two numbers from each pair of uniforms).
    pub fn draw(&mut self, generator: &mut impl Rng) {
        for pair in self.noise.chunks_mut(2) {
            let bits = generator.next_u64();
            let uniform = |bits: u32| (f64::from(bits) + 0.5) / 4_294_967_296.0;
            let radius = (-2.0 * uniform(bits as u32).ln()).sqrt();
            let (sine, cosine) = (std::f64::consts::TAU * uniform((bits >> 32) as u32)).sin_cos();
            pair.iter_mut().zip([radius * cosine, radius * sine]).for_each(|(slot, draw)| *slot = draw as f32);
        }
    }

    /// Actions and their log-probabilities from the actor's `output` `[batch, 2N]`: N means, N log sigmas.
    pub fn squash(&mut self, output: &[f32], bounds: LogStdBounds) {
        let half_log_tau = 0.5 * std::f32::consts::TAU.ln();
        let n = self.actions;
        for (row, (output, log_probability)) in output.chunks_exact(2 * n).zip(&mut self.log_probability).enumerate() {
            let (mean, log_std) = output.split_at(n);
            let mut sum = 0.0;
            for i in 0..n {
                let at = row * n + i;
                let (noise, clipped) = (self.noise[at], bounds.clip(log_std[i]));
                let inside = if bounds.cuts(log_std[i]) { 0.0 } else { 1.0 };
                let spread = clipped.exp() * noise;
                let u = mean[i] + spread;
                self.action[at] = u.tanh();
                self.slope[at] = spread * inside;
                self.inside[at] = inside;
                sum += -0.5 * noise * noise - clipped - half_log_tau - log_slope(u);
            }
            *log_probability = sum;
        }
    }

    /// dL/d(output) `[batch, 2N]` of L = sum over rows of (weight log pi(a|s)) + F(a), given
    /// `action_gradient` = dF/da `[batch, N]`. eps does not depend on the actor (reparameterisation).
    pub fn backward(&self, weight: f32, action_gradient: &[f32], output_gradient: &mut [f32]) {
        let n = self.actions;
        for (row, gradient) in output_gradient.chunks_exact_mut(2 * n).enumerate() {
            let (mean, log_std) = gradient.split_at_mut(n);
            for i in 0..n {
                let at = row * n + i;
                let action = self.action[at];
                // d(log pi)/du = 2 tanh(u), da/du = 1 - a^2.
                let through_u = weight * 2.0 * action + action_gradient[at] * (1.0 - action * action);
                mean[i] = through_u;
                log_std[i] = through_u * self.slope[at] - weight * self.inside[at];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vodca::random::{Use, stream};

    #[test]
    fn the_correction_is_exact_near_zero_and_finite_far_out() {
        for u in [-3.0f64, -0.5, 0.0, 0.1, 2.0] {
            let exact = (1.0 - u.tanh().powi(2)).ln();
            assert!((f64::from(log_slope(u as f32)) - exact).abs() < 1e-5, "{u}");
        }
        // tanh(50) is 1 in every format, so log(1 - tanh^2) as written is -inf; the limit is 2 log 2 - 2|u|.
        for u in [-50.0f32, 50.0] {
            assert!((log_slope(u) - (2.0 * std::f32::consts::LN_2 - 100.0)).abs() < 1e-4);
        }
    }

    #[test]
    fn the_density_of_one_robot_integrates_to_one() {
        // Mean 0.3, log sigma -0.4: sum pi(a) da over eps, a = tanh(0.3 + sigma eps).
        let bounds = LogStdBounds { low: -20.0, high: 2.0 };
        let steps = 4000;
        let mut sample = Sample::new(steps, 1);
        sample.noise.iter_mut().enumerate().for_each(|(i, eps)| *eps = -6.0 + 12.0 * i as f32 / (steps - 1) as f32);
        sample.squash(&[0.3f32, -0.4].repeat(steps), bounds);
        let area: f64 = (1..steps)
            .map(|i| {
                let middle =
                    0.5 * (f64::from(sample.log_probability[i]).exp() + f64::from(sample.log_probability[i - 1]).exp());
                middle * f64::from(sample.action[i] - sample.action[i - 1])
            })
            .sum();
        assert!((area - 1.0).abs() < 1e-3, "{area}");
    }

    #[test]
    fn noise_is_standard_normal_and_depends_on_its_stream_only() {
        let mut sample = Sample::new(5000, 3);
        sample.draw(&mut stream(1, Use::Learning, 0, 0));
        let (count, first) = (15_000.0, sample.noise.clone());
        let mean = first.iter().map(|x| f64::from(*x)).sum::<f64>() / count;
        let variance = first.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / count;
        // Five standard errors: 5 / sqrt(15000), 5 sqrt(2 / 15000).
        assert!(mean.abs() < 0.041 && (variance - 1.0).abs() < 0.058, "{mean} {variance}");
        sample.draw(&mut stream(1, Use::Learning, 0, 0));
        assert_eq!(sample.noise, first);
        sample.draw(&mut stream(1, Use::Learning, 1, 0));
        assert_ne!(sample.noise, first);
    }

    #[test]
    fn a_cut_log_sigma_has_no_gradient() {
        let bounds = LogStdBounds { low: -5.0, high: 2.0 };
        let mut sample = Sample::new(1, 3);
        sample.noise = vec![0.5, 0.5, 0.5];
        sample.squash(&[0.1, 0.1, 0.1, -9.0, 0.0, 3.0], bounds);
        let mut gradient = vec![9.0; 6];
        sample.backward(0.2, &[1.0, 1.0, 1.0], &mut gradient);
        assert_eq!((gradient[3], gradient[5]), (0.0, 0.0));
        assert!(gradient[4] != 0.0 && gradient[..3].iter().all(|g| *g != 0.0));
    }
}
