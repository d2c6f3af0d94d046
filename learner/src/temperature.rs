//! The temperature alpha, which weighs entropy against reward (paper, entropy term of section IV).

use crate::adam::Adam;

/// alpha = exp(log_alpha) with its optimiser's memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Temperature {
    /// log alpha.
    pub logarithm: f32,
    /// Of `logarithm`.
    pub adam: Adam,
}

impl Temperature {
    /// Starting at `alpha`.
    pub fn new(alpha: f64) -> Self {
        Self { logarithm: alpha.ln() as f32, adam: Adam::new(1) }
    }

    /// alpha.
    pub fn value(&self) -> f64 {
        f64::from(self.logarithm).exp()
    }

    /// J(alpha) = -alpha (mean log pi + H-bar) and one step down its gradient with respect to log alpha:
    /// alpha grows while the entropy, -mean log pi, is below the target H-bar.
    pub fn learn(&mut self, mean_log_probability: f64, target_entropy: f64, rate: f64) -> f64 {
        let loss = -self.value() * (mean_log_probability + target_entropy);
        // dJ/d(log alpha) = J.
        self.adam.step(std::slice::from_mut(&mut self.logarithm), &[loss as f32], rate, 1.0);
        loss
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_little_entropy_raises_alpha_and_too_much_lowers_it() {
        let mut temperature = Temperature::new(0.5);
        // Entropy -5 (log pi = 5) below the target -2.
        let loss = temperature.learn(5.0, -2.0, 1e-3);
        assert!(temperature.value() > 0.5 && (loss + 1.5).abs() < 1e-6, "{loss}");
        let mut temperature = Temperature::new(0.5);
        temperature.learn(-3.0, -2.0, 1e-3);
        assert!(temperature.value() < 0.5);
    }
}
