//! Pairs of items whose boxes are near each other, of one tree or of two.

use alloc::collections::VecDeque;
use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::Bvh;
use super::bound::{Bound, BoxDistance};
use super::node::{Child, Link, Slot, WIDTH};
use super::search::MAX_DEPTH;
use crate::{Aabb, Vector};

/// Two nodes leave at most 15 of 16 pairs of children behind, a node and an item 3 of 4.
const STACK: usize = (WIDTH * WIDTH + WIDTH) * MAX_DEPTH;

/// The pairs of items whose boxes are within a distance; asked by [`visit`](Self::visit), in [pieces](Self::split) if need
/// be.
#[derive(Clone, Copy, Debug)]
pub struct PairSearch<'t, V: Vector> {
    a: &'t Bvh<V>,
    b: &'t Bvh<V>,
    /// Whether pairs of one tree are meant, each of which counts once.
    same: bool,
    distance: V::Scalar,
    start: Pair,
}

/// A place of the first tree and one of the second; no place is the root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Pair(Slot, Slot);

impl<V: Vector> Bvh<V> {
    /// All pairs of different items whose boxes are at most `distance` apart, each once.
    #[must_use]
    pub fn pairs_within(&self, distance: V::Scalar) -> PairSearch<'_, V> {
        PairSearch { a: self, b: self, same: true, distance, start: Pair(Slot::NONE, Slot::NONE) }
    }

    /// All pairs of an item of this tree and one of `other` whose boxes are at most `distance` apart.
    #[must_use]
    pub fn pairs_between<'t>(&'t self, other: &'t Self, distance: V::Scalar) -> PairSearch<'t, V> {
        PairSearch { a: self, b: other, same: false, distance, start: Pair(Slot::NONE, Slot::NONE) }
    }

    #[inline]
    fn link(&self, slot: Slot) -> Link {
        if slot == Slot::NONE { Link::node(0) } else { self.nodes[slot.node()].children[slot.lane()] }
    }
}

impl<'t, V: Vector> PairSearch<'t, V> {
    /// Shows every pair, in no particular order, until `visit` breaks off; perhaps others that [rounding cannot tell](Bound::near) from
    /// those. Returns the number of pairs of nodes, or of a node and an item, that were looked into.
    pub fn visit(self, mut visit: impl FnMut(usize, usize) -> ControlFlow<()>) -> usize {
        let mut stack = [self.start; STACK];
        let (mut top, mut looked) = (1, 0);
        while top > 0 {
            top -= 1;
            let pair = stack[top];
            if let (Child::Item(i), Child::Item(j)) = self.children(pair) {
                if visit(i, j).is_break() {
                    return looked;
                }
                continue;
            }
            looked += 1;
            self.expand(pair, |next| {
                stack[top] = next;
                top += 1;
            });
        }
        looked
    }

    /// The same search in pieces, `at_least` so many if there are as many pairs, for as many threads. Which ones does not
    /// depend on the number of threads.
    #[must_use]
    pub fn split(self, at_least: usize) -> Vec<Self> {
        let mut pieces = VecDeque::from([self.start]);
        let mut whole = 0;
        while pieces.len() < at_least && whole < pieces.len() {
            let Some(pair) = pieces.pop_front() else { break };
            if let (Child::Item(_), Child::Item(_)) = self.children(pair) {
                pieces.push_back(pair);
                whole += 1;
            } else {
                whole = 0;
                self.expand(pair, |next| pieces.push_back(next));
            }
        }
        pieces.into_iter().map(|start| Self { start, ..self }).collect()
    }

    #[inline]
    fn children(&self, Pair(a, b): Pair) -> (Child, Child) {
        (self.a.link(a).child(), self.b.link(b).child())
    }

    /// The pairs that a pair consists of and whose boxes are near. Not for two items.
    #[inline]
    fn expand(&self, pair: Pair, mut push: impl FnMut(Pair)) {
        match self.children(pair) {
            (Child::Node(a), Child::Node(b)) => {
                for lane in 0..WIDTH {
                    if self.a.nodes[a].children[lane] == Link::NONE {
                        continue;
                    }
                    let slot = Slot::new(a, lane);
                    let mut first = 0;
                    if self.same && a == b {
                        // A pair counts once, and an item makes none with itself.
                        first = lane + 1;
                        if let Child::Node(_) = self.a.nodes[a].children[lane].child() {
                            push(Pair(slot, slot));
                        }
                    }
                    self.near(self.a.nodes[a].boxes.get(lane), self.b, b, first, |other| {
                        push(Pair(slot, other));
                    });
                }
            }
            (Child::Node(a), Child::Item(_)) => {
                let around = self.b.nodes[pair.1.node()].boxes.get(pair.1.lane());
                self.near(around, self.a, a, 0, |slot| push(Pair(slot, pair.1)));
            }
            (Child::Item(_), Child::Node(b)) => {
                let around = self.a.nodes[pair.0.node()].boxes.get(pair.0.lane());
                self.near(around, self.b, b, 0, |slot| push(Pair(pair.0, slot)));
            }
            _ => {}
        }
    }

    /// The children of a node, from `first` on, that are near a box.
    #[inline]
    fn near(&self, around: Aabb<V>, tree: &Bvh<V>, node: usize, first: usize, mut push: impl FnMut(Slot)) {
        let holder = &tree.nodes[node];
        let mut near = BoxDistance::new(around).near(&holder.boxes, self.distance) & !((1 << first) - 1);
        while near != 0 {
            let lane = near.trailing_zeros() as usize;
            near &= near - 1;
            if holder.children[lane] != Link::NONE {
                push(Slot::new(node, lane));
            }
        }
    }
}
