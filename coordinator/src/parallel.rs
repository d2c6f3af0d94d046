//! Work on all cores. The only file that imports `rayon`.

use rayon::prelude::*;

/// `work` for every item, on all cores; the results in the order of the items. `done` is told after each.
pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync, done: impl Fn() + Sync) -> Vec<R> {
    items
        .par_iter()
        .map(|item| {
            let result = work(item);
            done();
            result
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn results_keep_the_order_of_the_items() {
        let count = AtomicUsize::new(0);
        let items: Vec<u64> = (0..1000).collect();
        let squares = super::map(
            &items,
            |n| n * n,
            || {
                count.fetch_add(1, Ordering::Relaxed);
            },
        );
        assert!(squares.iter().enumerate().all(|(n, &square)| square == (n * n) as u64));
        assert_eq!(count.into_inner(), 1000);
    }
}
