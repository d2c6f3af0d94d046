//! The same networks and losses in f64 with plain loops, written independently of the f32 code: the
//! ruler of the gradient checks and of the export.

/// Output of a network for one row; `parameters` as in `Network`, `widths` with the input first.
pub(crate) fn network(widths: &[usize], parameters: &[f64], input: &[f64]) -> Vec<f64> {
    let mut at = 0;
    let mut values = input.to_vec();
    for (layer, pair) in widths.windows(2).enumerate() {
        let (inputs, outputs) = (pair[0], pair[1]);
        let bias = at + inputs * outputs;
        let neuron = |o: usize| {
            let row = &parameters[at + o * inputs..at + (o + 1) * inputs];
            parameters[bias + o] + row.iter().zip(&values).map(|(w, x)| w * x).sum::<f64>()
        };
        let sums: Vec<f64> = (0..outputs).map(neuron).collect();
        let hidden = layer + 2 < widths.len();
        values = sums.into_iter().map(|sum| if hidden { sum.max(0.0) } else { sum }).collect();
        at = bias + outputs;
    }
    values
}

/// Action and log pi(a|s) of one row from the actor's output and eps; log(1 - tanh^2) as written.
pub(crate) fn squash(output: &[f64], noise: &[f64], bounds: (f64, f64)) -> (Vec<f64>, f64) {
    let n = noise.len();
    let mut log_probability = 0.0;
    let mut actions = Vec::new();
    for i in 0..n {
        let log_std = output[n + i].clamp(bounds.0, bounds.1);
        let u = output[i] + log_std.exp() * noise[i];
        let a = u.tanh();
        log_probability -= 0.5 * noise[i] * noise[i] + log_std + 0.5 * std::f64::consts::TAU.ln() + (1.0 - a * a).ln();
        actions.push(a);
    }
    (actions, log_probability)
}

/// Central difference of `loss` for parameter `index`, with a step that f64 resolves.
pub(crate) fn difference(parameters: &[f64], index: usize, loss: impl Fn(&[f64]) -> f64) -> f64 {
    let step = 1e-5;
    let mut moved = parameters.to_vec();
    moved[index] += step;
    let above = loss(&moved);
    moved[index] -= 2.0 * step;
    (above - loss(&moved)) / (2.0 * step)
}

/// f32 numbers as f64.
pub(crate) fn wide(numbers: &[f32]) -> Vec<f64> {
    numbers.iter().map(|number| f64::from(*number)).collect()
}
