//! Whatever a robot asks in a tick allocates nothing; own binary, because it counts every allocation.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use world::Position;
use world::route::{Roadmap, Route};
use world::shape::{Obstacle, Obstacles, Shape};

struct Counting;

thread_local! {
    /// Allocations of this thread; the harness allocates on its own.
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    // Fails only while the thread ends, when nothing is counted any more.
    let _ = ALLOCATIONS.try_with(|n| n.set(n.get() + 1));
}

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `alloc_zeroed`.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What `work` gives and how often it allocates.
fn counted<T>(work: impl FnOnce() -> T) -> (T, u64) {
    let before = ALLOCATIONS.get();
    let outcome = work();
    (outcome, ALLOCATIONS.get() - before)
}

fn place(i: usize) -> Position {
    Position::new((i % 21) as f64 - 0.3, (i / 21) as f64 - 0.2)
}

#[test]
fn what_is_near_where_to_go_and_the_way_there_allocate_nothing() {
    let shape = |i: usize| match i % 3 {
        0 => Shape::Disc { centre: place(7 * i), radius: 0.4 },
        1 => Shape::Wall { points: vec![place(7 * i), place(7 * i + 23)], thickness: 0.1 },
        _ => Shape::Polygon(vec![place(7 * i), place(7 * i + 1), place(7 * i + 22)]),
    };
    let list = (0..60).map(|i| Obstacle::new("it", shape(i)).expect("it is a shape")).collect();
    let all = Arc::new(Obstacles::new(list));
    let map = Arc::new(Roadmap::new(all.clone(), 0.3));
    let route = Route::new(map, Position::new(-3.0, -3.0)).expect("nothing stands there");
    let (mut bends, mut hint) = (0, None);
    for from in (0..441).map(place) {
        let (near, allocations) = counted(|| {
            let near = all.pieces_within(from, 2.0).map(|piece| piece.nearest(from).distance).fold(9.0, f64::min);
            near.min(all.separation(from, from.add_scalar(0.1), 2.0))
        });
        assert!(near <= 9.0);
        assert_eq!(allocations, 0);
        let (aim, allocations) = counted(|| route.aim(from, hint));
        assert_eq!(allocations, 0);
        hint = aim.and_then(|aim| aim.corner);
        let (count, allocations) = counted(|| {
            let paced = route.walk(from, hint).paced(std::iter::repeat_n(0.3, 49)).count();
            route.walk(from, hint).count() + paced
        });
        assert_eq!(allocations, 0);
        bends += count - 49;
    }
    assert!(bends > 441, "{bends}");
}
