//! A fixed tree of rectangles over the pieces: who is near, without looking at all of them.

use super::{Bounds, Piece};
use crate::Position;

/// Pieces in a leaf, at most.
const LEAF: usize = 4;
/// Deeper than this no tree of halves over 2^32 pieces gets.
const DEPTH: usize = 40;

/// A node: a leaf over `count` pieces from `first`, or (count = 0) an inner node whose left child is the next
/// node and whose right child is node `first`.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    first: u32,
    count: u32,
}

/// Immutable; the order in which it names pieces depends on the pieces alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    nodes: Vec<Node>,
}

impl Tree {
    /// Sorts `pieces` into the order of the tree's leaves.
    pub(super) fn new(pieces: &mut [Piece]) -> Self {
        let mut tree = Self::default();
        if !pieces.is_empty() {
            tree.add(pieces, 0);
        }
        tree
    }

    fn add(&mut self, pieces: &mut [Piece], first: usize) {
        let bounds = pieces.iter().fold(Bounds::NOTHING, |all, piece| all.joined(&piece.bounds()));
        let own = self.nodes.len();
        self.nodes.push(Node { bounds, first: first as u32, count: pieces.len() as u32 });
        if pieces.len() <= LEAF {
            return;
        }
        let size = bounds.high - bounds.low;
        let axis = usize::from(size.y > size.x);
        pieces.sort_by(|a, b| a.bounds().centre()[axis].total_cmp(&b.bounds().centre()[axis]));
        let half = pieces.len() / 2;
        let (left, right) = pieces.split_at_mut(half);
        self.add(left, first);
        self.nodes[own].first = self.nodes.len() as u32;
        self.nodes[own].count = 0;
        self.add(right, first + half);
    }

    /// The pieces of `pieces` under nodes that `wanted` lets pass and that it lets pass themselves.
    pub(super) fn find<'a, F: Fn(&Bounds) -> bool>(&'a self, pieces: &'a [Piece], wanted: F) -> Found<'a, F> {
        let mut found = Found { tree: self, pieces, wanted, open: [0; DEPTH], depth: 0, leaf: 0..0 };
        if !self.nodes.is_empty() {
            found.depth = 1;
        }
        found
    }
}

/// The pieces that a search finds, one after the other; nothing is allocated.
#[derive(Clone)]
pub(super) struct Found<'a, F> {
    tree: &'a Tree,
    pieces: &'a [Piece],
    wanted: F,
    open: [u32; DEPTH],
    depth: usize,
    leaf: std::ops::Range<usize>,
}

impl<'a, F: Fn(&Bounds) -> bool> Iterator for Found<'a, F> {
    type Item = &'a Piece;

    fn next(&mut self) -> Option<&'a Piece> {
        loop {
            for at in self.leaf.by_ref() {
                if (self.wanted)(&self.pieces[at].bounds()) {
                    return Some(&self.pieces[at]);
                }
            }
            self.depth = self.depth.checked_sub(1)?;
            let at = self.open[self.depth];
            let node = &self.tree.nodes[at as usize];
            if !(self.wanted)(&node.bounds) {
                continue;
            }
            if node.count > 0 {
                self.leaf = node.first as usize..(node.first + node.count) as usize;
            } else {
                self.open[self.depth] = node.first;
                self.open[self.depth + 1] = at + 1;
                self.depth += 2;
            }
        }
    }
}

/// The pieces whose rectangles come within `reach` (m) of `place`.
pub(super) fn near(place: Position, reach: f64) -> impl Fn(&Bounds) -> bool + Clone {
    move |bounds| bounds.distance(place) <= reach
}

/// The pieces whose rectangles come within `reach` (m) of the straight line.
pub(super) fn along(from: Position, to: Position, reach: f64) -> impl Fn(&Bounds) -> bool + Clone {
    move |bounds| bounds.meets_line(from, to, reach)
}
