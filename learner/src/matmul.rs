//! The three matrix products of a fully connected layer: the only file that imports `faer`.
//!
//! Matrices are row-major slices as in PyTorch and ONNX: a batch is `[rows, features]`, a weight
//! `[outputs, inputs]`. So weights go to files as they are, and nothing is ever transposed in memory:
//! faer's kernels take any strides (on AVX-512 both orders of a weight ran equally fast, README). One
//! product runs on one thread: two critics side by side use two cores better, and to the same bits.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

fn matrix(numbers: &[f32], rows: usize) -> MatRef<'_, f32> {
    MatRef::from_row_major_slice(numbers, rows, numbers.len() / rows)
}

fn matrix_mut(numbers: &mut [f32], rows: usize) -> MatMut<'_, f32> {
    let columns = numbers.len() / rows;
    MatMut::from_row_major_slice_mut(numbers, rows, columns)
}

/// Y = X Wᵀ: `input` X `[batch, inputs]`, `weight` W `[outputs, inputs]`, `output` Y `[batch, outputs]`.
pub fn forward(input: &[f32], weight: &[f32], output: &mut [f32], batch: usize) {
    let outputs = output.len() / batch;
    let (x, w) = (matrix(input, batch), matrix(weight, outputs));
    matmul(matrix_mut(output, batch), Accum::Replace, x, w.transpose(), 1.0, Par::Seq);
}

/// dL/dW = Dᵀ X: `delta` D = dL/dY `[batch, outputs]`, `input` X `[batch, inputs]`, `gradient` `[outputs, inputs]`.
pub fn weight_gradient(delta: &[f32], input: &[f32], gradient: &mut [f32], batch: usize) {
    let outputs = delta.len() / batch;
    let (d, x) = (matrix(delta, batch), matrix(input, batch));
    matmul(matrix_mut(gradient, outputs), Accum::Replace, d.transpose(), x, 1.0, Par::Seq);
}

/// dL/dX = D W for the last inputs only, as many as `gradient` `[batch, some]` has columns: `delta` D
/// `[batch, outputs]`, `weight` W `[outputs, inputs]`. A critic's actions are its last inputs.
pub fn input_gradient(delta: &[f32], weight: &[f32], gradient: &mut [f32], batch: usize) {
    let columns = gradient.len() / batch;
    let (d, w) = (matrix(delta, batch), matrix(weight, delta.len() / batch));
    let w = w.subcols(w.ncols() - columns, columns);
    matmul(matrix_mut(gradient, batch), Accum::Replace, d, w, 1.0, Par::Seq);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// sum over l of a(i, l) b(l, j), in f64.
    fn plain(
        rows: usize,
        inner: usize,
        columns: usize,
        a: impl Fn(usize, usize) -> f32,
        b: impl Fn(usize, usize) -> f32,
    ) -> Vec<f64> {
        let entry = |i, j| (0..inner).map(|l| f64::from(a(i, l)) * f64::from(b(l, j))).sum::<f64>();
        (0..rows * columns).map(|at| entry(at / columns, at % columns)).collect()
    }

    fn near(got: &[f32], expected: &[f64]) -> bool {
        got.len() == expected.len() && got.iter().zip(expected).all(|(g, e)| (f64::from(*g) - e).abs() <= 1e-4)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn products_are_those_of_plain_loops(batch in 1usize..40, inputs in 1usize..50, outputs in 1usize..50, seed in any::<u64>()) {
            let mut generator = vodca::random::stream(seed, vodca::random::Use::Problem, 0, 0);
            let mut draw = |count: usize| -> Vec<f32> { (0..count).map(|_| vodca::random::unit(&mut generator) as f32 - 0.5).collect() };
            let (x, w, d) = (draw(batch * inputs), draw(outputs * inputs), draw(batch * outputs));
            let mut y = vec![9.0; batch * outputs];
            forward(&x, &w, &mut y, batch);
            prop_assert!(near(&y, &plain(batch, inputs, outputs, |i, l| x[i * inputs + l], |l, j| w[j * inputs + l])));
            let mut dw = vec![9.0; outputs * inputs];
            weight_gradient(&d, &x, &mut dw, batch);
            prop_assert!(near(&dw, &plain(outputs, batch, inputs, |i, l| d[l * outputs + i], |l, j| x[l * inputs + j])));
            let some = inputs.div_ceil(2);
            let mut dx = vec![9.0; batch * some];
            input_gradient(&d, &w, &mut dx, batch);
            prop_assert!(near(&dx, &plain(batch, outputs, some, |i, l| d[i * outputs + l], |l, j| w[l * inputs + inputs - some + j])));
        }
    }

    #[test]
    fn a_repeated_product_is_the_same_to_the_last_bit() {
        let x: Vec<f32> = (0..256 * 42).map(|i| (i as f32).sin()).collect();
        let w: Vec<f32> = (0..256 * 42).map(|i| (i as f32).cos()).collect();
        let product = || {
            let mut y = vec![0.0; 256 * 256];
            forward(&x, &w, &mut y, 256);
            y
        };
        assert_eq!(product(), product());
    }
}
