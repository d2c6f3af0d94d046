//! Work on all cores. The only file that imports `rayon`.

use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

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

/// `work` for one item after the other on every core, until it gives `None` there; `start` makes what a core
/// keeps from item to item. What was done stands at the place of its item.
pub fn map_while<'a, T: Sync, R: Send, S>(
    items: &'a [T],
    start: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, &'a T) -> Option<R> + Sync,
) -> Vec<Option<R>> {
    let next = AtomicUsize::new(0);
    let done = rayon::broadcast(|_| {
        let (mut kept, mut own) = (start(), Vec::new());
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            match items.get(at).and_then(|item| work(&mut kept, item)) {
                Some(result) => own.push((at, result)),
                None => return own,
            }
        }
    });
    let mut all: Vec<Option<R>> = items.iter().map(|_| None).collect();
    for (at, result) in done.into_iter().flatten() {
        all[at] = Some(result);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_not_done_is_absent_and_the_rest_in_its_place() {
        let items: Vec<usize> = (0..1000).collect();
        let all = map_while(&items, || (), |(), &n| Some(n));
        assert!(all.iter().enumerate().all(|(n, done)| *done == Some(n)));
        let cut = map_while(
            &items,
            || 0,
            |count, &n| {
                *count += 1;
                (n != 500 && *count < 900).then_some(n)
            },
        );
        assert_eq!(cut[500], None);
        assert!(cut.iter().enumerate().all(|(n, done)| done.is_none_or(|done| done == n)));
        assert!(cut[..500].iter().all(Option::is_some));
    }

    #[test]
    fn results_keep_the_order_of_the_items() {
        let count = AtomicUsize::new(0);
        let items: Vec<u64> = (0..1000).collect();
        let squares = map(
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
