//! L D L' of the small matrix of the active rows, grown row by row; a dependent row is refused.

/// Most rows in one active set; a QP that needs more is left to the next solver.
pub(super) const MAX_ACTIVE: usize = 96;

/// The factor; `MAX_ACTIVE^2` numbers, allocated once.
#[derive(Clone, Debug)]
pub(super) struct SmallFactor {
    size: usize,
    /// L below the diagonal, D on it; row-major with stride MAX_ACTIVE.
    entries: Vec<f64>,
}

impl SmallFactor {
    pub(super) fn new() -> Self {
        Self { size: 0, entries: vec![0.0; MAX_ACTIVE * MAX_ACTIVE] }
    }

    pub(super) fn clear(&mut self) {
        self.size = 0;
    }

    /// The next row to fill: entries against the present rows, then the diagonal.
    pub(super) fn next_row(&mut self) -> &mut [f64] {
        let start = self.size * MAX_ACTIVE;
        &mut self.entries[start..=start + self.size]
    }

    /// Takes the row filled into [`Self::next_row`]. `false`: its pivot is not above `smallest`, the
    /// row depends on the others and stays out.
    pub(super) fn push(&mut self, smallest: f64) -> bool {
        let size = self.size;
        let (above, row) = self.entries.split_at_mut(size * MAX_ACTIVE);
        // Row of L D first (forward substitution), then divided by D while the pivot is formed.
        for i in 1..size {
            let earlier = &above[i * MAX_ACTIVE..];
            let mut sum = row[i];
            for k in 0..i {
                sum -= row[k] * earlier[k];
            }
            row[i] = sum;
        }
        let mut pivot = row[size];
        for i in 0..size {
            let scaled = row[i] / above[i * MAX_ACTIVE + i];
            pivot -= row[i] * scaled;
            row[i] = scaled;
        }
        row[size] = pivot;
        let independent = pivot > smallest;
        self.size += usize::from(independent);
        independent
    }

    /// Replaces `right` by the solution.
    pub(super) fn solve(&self, right: &mut [f64]) {
        for i in 1..self.size {
            let row = &self.entries[i * MAX_ACTIVE..];
            for k in 0..i {
                right[i] -= row[k] * right[k];
            }
        }
        for (i, value) in right[..self.size].iter_mut().enumerate() {
            *value /= self.entries[i * MAX_ACTIVE + i];
        }
        for i in (1..self.size).rev() {
            let row = &self.entries[i * MAX_ACTIVE..];
            for k in 0..i {
                right[k] -= row[k] * right[i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    fn push(factor: &mut SmallFactor, matrix: &DMatrix<f64>, members: &[usize], row: usize) -> bool {
        let entries = factor.next_row();
        for (entry, &column) in entries.iter_mut().zip(members) {
            *entry = matrix[(row, column)];
        }
        entries[members.len()] = matrix[(row, row)];
        factor.push(1e-10)
    }

    #[test]
    fn it_solves_what_it_took_and_refuses_dependent_rows() {
        let roots = DMatrix::from_fn(6, 6, |i, j| ((3 * i * i + 5 * i * j + 7 * j * j) as f64).sin());
        let mut roots = roots.insert_row(3, 0.0);
        let sum = roots.row(0) + roots.row(2) * 2.0;
        roots.set_row(3, &sum); // row 3 depends on rows 0 and 2
        let matrix = &roots * roots.transpose();
        let mut factor = SmallFactor::new();
        let mut members = Vec::new();
        for row in 0..7 {
            if push(&mut factor, &matrix, &members, row) {
                members.push(row);
            }
        }
        assert_eq!(members, [0, 1, 2, 4, 5, 6]);
        let small = matrix.select_rows(&members).select_columns(&members);
        let right = DVector::from_fn(members.len(), |i, _| i as f64 - 1.5);
        let mut solution = right.clone();
        factor.solve(solution.as_mut_slice());
        assert!((small * solution - right).amax() < 1e-8);
    }
}
