//! A multilayer perceptron with ReLU between its layers: forward pass, and backward pass by hand.
//!
//! All parameters of a network stand in one slice, layer by layer: weight `[outputs, inputs]` row-major,
//! then bias `[outputs]`. Gradients, Adam's moments and target networks have the same layout, so that
//! each is one loop.

use crate::matmul;
use crate::simd::wide;
use std::ops::Range;
use vodca::random::{self, Use};

/// A network: y = W_n relu(... relu(W_1 x + b_1) ...) + b_n.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    layers: Vec<Layer>,
    parameters: Vec<f32>,
}

/// One layer's place in the parameters.
#[derive(Clone, Debug, PartialEq)]
struct Layer {
    inputs: usize,
    outputs: usize,
    weight: Range<usize>,
    bias: Range<usize>,
}

/// The layers between `widths` and the number of their parameters.
fn layout(widths: &[usize]) -> (Vec<Layer>, usize) {
    let mut end = 0;
    let layer = |pair: &[usize]| {
        let (inputs, outputs) = (pair[0], pair[1]);
        let weight = end..end + inputs * outputs;
        let bias = weight.end..weight.end + outputs;
        end = bias.end;
        Layer { inputs, outputs, weight, bias }
    };
    (widths.windows(2).map(layer).collect(), end)
}

/// What one forward pass of a batch leaves for the backward pass. Made once, used at every update.
#[derive(Clone, Debug)]
pub struct Pass {
    batch: usize,
    /// `values[0]` is the input, `values[l]` the output of layer l, `[batch, width]` each.
    values: Vec<Vec<f32>>,
    /// dL/d(values[l + 1] before the ReLU).
    deltas: Vec<Vec<f32>>,
}

impl Network {
    /// A network of these widths (input first) with PyTorch's default weights: uniform within
    /// +-1/sqrt(inputs). `number` tells the networks of one seed apart.
    pub fn new(widths: &[usize], seed: u64, number: u64) -> Self {
        let (layers, count) = layout(widths);
        let mut generator = random::stream(seed, Use::Learning, u64::MAX, number);
        let mut parameters = Vec::with_capacity(count);
        for layer in &layers {
            let bound = 1.0 / (layer.inputs as f64).sqrt();
            let draw = |_| ((2.0 * random::unit(&mut generator) - 1.0) * bound) as f32;
            parameters.extend((layer.weight.start..layer.bias.end).map(draw));
        }
        Self { layers, parameters }
    }

    /// A network with these parameters; `None` when their number does not fit the widths.
    pub fn from_parameters(widths: &[usize], parameters: Vec<f32>) -> Option<Self> {
        let (layers, count) = layout(widths);
        (count == parameters.len()).then_some(Self { layers, parameters })
    }

    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.layers.first().map_or(0, |layer| layer.inputs)
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.layers.last().map_or(0, |layer| layer.outputs)
    }

    /// All parameters, layer by layer: weight `[outputs, inputs]`, bias.
    pub fn parameters(&self) -> &[f32] {
        &self.parameters
    }

    /// The same to change.
    pub fn parameters_mut(&mut self) -> &mut [f32] {
        &mut self.parameters
    }

    /// Weight `[outputs, inputs]` and bias of each layer.
    pub fn layers(&self) -> impl Iterator<Item = (&[f32], &[f32])> {
        let part = |range: &Range<usize>| &self.parameters[range.clone()];
        self.layers.iter().map(move |layer| (part(&layer.weight), part(&layer.bias)))
    }

    /// Runs the batch in `pass.input_mut()`; the answer is `pass.output()`.
    pub fn forward(&self, pass: &mut Pass) {
        let last = self.layers.len() - 1;
        for (l, layer) in self.layers.iter().enumerate() {
            let (before, after) = pass.values.split_at_mut(l + 1);
            let output = &mut after[0];
            matmul::forward(&before[l], &self.parameters[layer.weight.clone()], output, pass.batch);
            let bias = &self.parameters[layer.bias.clone()];
            let floor = if l < last { 0.0 } else { f32::NEG_INFINITY };
            wide(|| {
                for row in output.chunks_exact_mut(layer.outputs) {
                    for (value, bias) in row.iter_mut().zip(bias) {
                        let sum = *value + bias;
                        // Not f32::max: a NaN must stay one to be noticed.
                        *value = if sum < floor { floor } else { sum };
                    }
                }
            });
        }
    }

    /// Goes back from dL/d(output) in `pass.output_gradient_mut()`: all of `gradient` (dL/d(parameters))
    /// is written when it is asked for, and so is `input_gradient`, dL/dx of the last inputs, `[batch, some]`.
    pub fn backward(&self, pass: &mut Pass, mut gradient: Option<&mut [f32]>, input_gradient: Option<&mut [f32]>) {
        let batch = pass.batch;
        for (l, layer) in self.layers.iter().enumerate().rev() {
            let (before, after) = pass.deltas.split_at_mut(l);
            let delta = &after[0];
            if let Some(gradient) = gradient.as_deref_mut() {
                matmul::weight_gradient(delta, &pass.values[l], &mut gradient[layer.weight.clone()], batch);
                let sums = &mut gradient[layer.bias.clone()];
                sums.fill(0.0);
                wide(|| {
                    for row in delta.chunks_exact(layer.outputs) {
                        sums.iter_mut().zip(row).for_each(|(sum, delta)| *sum += delta);
                    }
                });
            }
            let weight = &self.parameters[layer.weight.clone()];
            if let Some(below) = before.last_mut() {
                matmul::input_gradient(delta, weight, below, batch);
                let values = &pass.values[l];
                wide(|| {
                    for (delta, value) in below.iter_mut().zip(values) {
                        *delta = if *value > 0.0 { *delta } else { 0.0 };
                    }
                });
            }
        }
        if let (Some(input_gradient), Some(layer)) = (input_gradient, self.layers.first()) {
            let weight = &self.parameters[layer.weight.clone()];
            matmul::input_gradient(&pass.deltas[0], weight, input_gradient, batch);
        }
    }
}

impl Pass {
    /// Room for `batch` rows through `network`.
    pub fn new(network: &Network, batch: usize) -> Self {
        let deltas: Vec<Vec<f32>> = network.layers.iter().map(|layer| vec![0.0; batch * layer.outputs]).collect();
        let values = std::iter::once(vec![0.0; batch * network.inputs()]).chain(deltas.iter().cloned()).collect();
        Self { batch, values, deltas }
    }

    /// Rows of a batch.
    pub fn batch(&self) -> usize {
        self.batch
    }

    /// x, `[batch, inputs]`.
    pub fn input_mut(&mut self) -> &mut [f32] {
        &mut self.values[0]
    }

    /// y, `[batch, outputs]`.
    pub fn output(&self) -> &[f32] {
        self.values.last().map_or(&[], Vec::as_slice)
    }

    /// dL/dy, `[batch, outputs]`, to be written before the backward pass.
    pub fn output_gradient_mut(&mut self) -> &mut [f32] {
        self.deltas.last_mut().map_or(&mut [], Vec::as_mut_slice)
    }
}
