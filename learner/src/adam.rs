//! Adam (Kingma and Ba 2015), with PyTorch's defaults for its constants.

use crate::simd::wide;

const BETA1: f64 = 0.9;
const BETA2: f64 = 0.999;
const EPSILON: f32 = 1e-8;

/// Adam's memory for one slice of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Adam {
    /// Running mean of the gradient, m.
    pub first: Vec<f32>,
    /// Running mean of its square, v.
    pub second: Vec<f32>,
    /// Steps taken, t.
    pub steps: u64,
}

impl Adam {
    /// For `count` parameters.
    pub fn new(count: usize) -> Self {
        Self { first: vec![0.0; count], second: vec![0.0; count], steps: 0 }
    }

    /// One step down `gradient` with step size `rate`; the gradient is first multiplied with `factor`.
    pub fn step(&mut self, parameters: &mut [f32], gradient: &[f32], rate: f64, factor: f32) {
        self.steps += 1;
        let steps = self.steps as f64;
        let step_size = (rate / (1.0 - BETA1.powf(steps))) as f32;
        let correction = (1.0 / (1.0 - BETA2.powf(steps)).sqrt()) as f32;
        let (keep1, keep2) = (BETA1 as f32, BETA2 as f32);
        let (take1, take2) = ((1.0 - BETA1) as f32, (1.0 - BETA2) as f32);
        let moments = self.first.iter_mut().zip(&mut self.second);
        wide(|| {
            for ((parameter, gradient), (first, second)) in parameters.iter_mut().zip(gradient).zip(moments) {
                let gradient = gradient * factor;
                *first = keep1 * *first + take1 * gradient;
                *second = keep2 * *second + take2 * gradient * gradient;
                *parameter -= step_size * *first / (second.sqrt() * correction + EPSILON);
            }
        });
    }
}

/// What to multiply `gradient` with so that its Euclidean norm is at most `limit` (0: no limit).
pub fn clip_factor(gradient: &[f32], limit: f64) -> f32 {
    if limit <= 0.0 {
        return 1.0;
    }
    let norm = gradient.iter().map(|g| f64::from(*g) * f64::from(*g)).sum::<f64>().sqrt();
    if norm > limit { (limit / norm) as f32 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_step_has_the_size_of_the_rate() {
        let mut parameters = [1.0f32, -2.0, 3.0];
        Adam::new(3).step(&mut parameters, &[0.5, -4.0, 0.0], 0.01, 1.0);
        // m / sqrt(v) after both corrections is the gradient's sign.
        let expected = [0.99f32, -1.99, 3.0];
        assert!(parameters.iter().zip(expected).all(|(p, e)| (p - e).abs() < 1e-6), "{parameters:?}");
    }

    #[test]
    fn two_steps_are_those_of_the_paper_in_f64() {
        let (rate, gradients) = (0.1, [0.3f64, -0.8]);
        let (mut m, mut v, mut x) = (0.0, 0.0, 1.0);
        let (mut adam, mut parameters) = (Adam::new(1), [1.0f32]);
        for (t, g) in gradients.iter().enumerate() {
            m = 0.9 * m + 0.1 * g;
            v = 0.999 * v + 0.001 * g * g;
            let (m_hat, v_hat) = (m / (1.0 - 0.9f64.powi(t as i32 + 1)), v / (1.0 - 0.999f64.powi(t as i32 + 1)));
            x -= rate * m_hat / (v_hat.sqrt() + 1e-8);
            adam.step(&mut parameters, &[*g as f32], rate, 1.0);
        }
        assert!((f64::from(parameters[0]) - x).abs() < 1e-6, "{} {x}", parameters[0]);
    }

    #[test]
    fn only_gradients_above_the_limit_are_shortened() {
        assert_eq!(clip_factor(&[3.0, 4.0], 0.0), 1.0);
        assert_eq!(clip_factor(&[3.0, 4.0], 6.0), 1.0);
        assert_eq!(clip_factor(&[3.0, 4.0], 2.5), 0.5);
    }
}
