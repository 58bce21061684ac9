//! Pairs of items, of one tree or of two, in the order of the distance of their boxes (branch and bound, best first).
//! [`PairSearch::visit`] is quicker for all pairs within a distance that is known beforehand.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;

use super::Bvh;
use super::bound::{Bound, BoxDistance, CoarseBound, CoarseBoxDistance};
use super::node::{Boxes, Child, Link, WIDTH};
use super::pairs::{Pair, PairSearch, are_items};
use super::search::{coarse_limit, finite};
use crate::glam::Vec3A;
use crate::{Aabb, Vector};

/// The pairs of items, mostly the nearest boxes first, of which [`next`](Self::next) tells one after the other.
///
/// ```
/// use convex_support::{Aabb, Bvh, glam::DVec2};
///
/// let square = |x: f64| Aabb { min: DVec2::new(x, 0.0), max: DVec2::new(x + 1.0, 1.0) };
/// let (a, b) = (Bvh::new(&[square(0.0), square(9.0)]), Bvh::new(&[square(4.0), square(12.0)]));
/// let mut pairs = a.nearest_pairs(&b);
/// let (pair, bound) = pairs.next(f64::INFINITY).ok_or("two by two squares")?;
/// assert_eq!(pair, [1, 1]);
/// assert!(bound <= 2.0 && bound > 1.999_999); // conservative: rounded towards zero
/// assert!(pairs.next(bound).is_none()); // all others are farther
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug)]
pub struct NearestPairs<'t, V: Vector> {
    among: PairSearch<'t, V>,
    order: Order,
    /// The pairs to be looked into first, the last one foremost, which is deepest. Each is its bound and the first link
    /// as one number, in descending order, with the second link.
    deep: Vec<(u64, Link)>,
    /// The others, the least bound on top.
    queue: BinaryHeap<(u64, Link)>,
    nodes: usize,
}

/// Which pairs go on the stack. Those whose bound is 0 always do: so the first pair of items is found soon where all
/// boxes overlap, and many such pairs need no order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    /// All of them.
    Deep,
    /// All of them until a pair is told: mostly one that is near, so that the caller's limit keeps others out of the
    /// queue.
    DeepAtFirst,
    /// No others.
    Nearest,
}

impl<V: Vector> Bvh<V> {
    /// The pairs of an item of this tree and one of `other` in the order of the distance of their boxes.
    #[must_use]
    pub fn nearest_pairs<'t>(&'t self, other: &'t Self) -> NearestPairs<'t, V> {
        NearestPairs::new(self.pairs_between(other, V::Scalar::default()))
    }

    /// The pairs of different items, each once, in the order of the distance of their boxes.
    #[must_use]
    pub fn nearest_pairs_within(&self) -> NearestPairs<'_, V> {
        NearestPairs::new(self.pairs_within(V::Scalar::default()))
    }
}

impl<'t, V: Vector> NearestPairs<'t, V> {
    fn new(among: PairSearch<'t, V>) -> Self {
        let (a, b) = among.start;
        let deep = alloc::vec![(Link::descending(a.after(0.0)), b)];
        Self { among, order: Order::DeepAtFirst, deep, queue: BinaryHeap::new(), nodes: 0 }
    }

    /// The same pairs, depth first: of the children of two nodes the nearest first, and all of them before the others
    /// that are near. If the limit stays as it is, and one pair is enough, it is mostly found after one descent.
    #[must_use]
    pub fn depth_first(self) -> Self {
        Self { order: Order::Deep, ..self }
    }

    /// The next pair whose boxes are at most `limit` apart, with a lower bound on their distance. `None` if there is no
    /// other, or if the limit is negative or NaN. The limit must not grow from one call to the next.
    pub fn next(&mut self, limit: V::Scalar) -> Option<([usize; 2], V::Scalar)> {
        let limit = finite(limit)?;
        let nowhere = Boxes::EMPTY.get(0);
        let end = coarse_limit(&self.coarse(&nowhere), limit);
        while let Some(((a, b), bound)) = self.pop() {
            if bound > end {
                // What is in the queue is farther still.
                if self.deep.is_empty() {
                    break;
                }
                continue;
            }
            if are_items((a, b)) {
                let pair = [a.index(), b.index()];
                let bound = BoxDistance::new(self.among.a.boxes[pair[0]]).bound(&self.among.b.boxes[pair[1]]);
                if bound <= limit {
                    if self.order == Order::DeepAtFirst {
                        (self.order, self.queue) = (Order::Nearest, core::mem::take(&mut self.deep).into());
                    }
                    return Some((pair, bound));
                }
            } else {
                self.nodes += 1;
                self.expand((a, b), end);
            }
        }
        (self.deep, self.queue) = Default::default();
        None
    }

    /// The number of pairs of nodes, or of a node and an item, that were tested so far.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// What is still to be searched, in so many parts of about equal promise, for as many threads.
    #[must_use]
    pub fn deal(self, parts: usize) -> Vec<Self> {
        let (parts, among, order) = (parts.max(1), self.among, self.order);
        let nothing = |_| Self { among, order, deep: Vec::new(), queue: BinaryHeap::new(), nodes: 0 };
        let mut dealt: Vec<_> = (0..parts).map(nothing).collect();
        dealt[0].nodes = self.nodes;
        for (i, pair) in self.queue.into_sorted_vec().into_iter().rev().enumerate() {
            dealt[i % parts].queue.push(pair);
        }
        for (i, pair) in self.deep.into_iter().enumerate() {
            dealt[i % parts].deep.push(pair);
        }
        dealt
    }

    fn push(&mut self, bound: f32, (a, b): Pair) {
        let pair = (Link::descending(a.after(bound)), b);
        if bound == 0.0 || self.order != Order::Nearest {
            self.deep.push(pair);
        } else {
            self.queue.push(pair);
        }
    }

    fn pop(&mut self) -> Option<(Pair, f32)> {
        let (number, b) = self.deep.pop().or_else(|| self.queue.pop())?;
        let (a, bound) = Link::with_bound(Link::descending(number));
        Some(((a, b), bound))
    }

    /// The bound for a box in the frame of the second tree.
    #[inline(always)]
    fn coarse(&self, around: &Aabb<Vec3A>) -> CoarseBoxDistance<V> {
        CoarseBoxDistance::seen(around, self.among.b.frame.unit())
    }

    /// Queues the pairs of children of a pair, but for those that are farther apart than the coarse limit `end`.
    #[inline]
    fn expand(&mut self, (a, b): Pair, end: f32) {
        let PairSearch { a: first, b: second, same, .. } = self.among;
        let (mut boxes, firsts) = first.parts(a);
        if !same {
            boxes = self.among.as_b_sees(&boxes);
        }
        let (others, seconds) = second.parts(b);
        let (is_one, start) = (same && a == b, self.deep.len());
        for (lane, &first) in firsts.iter().enumerate().filter(|(_, link)| **link != Link::NONE) {
            let bounds = self.coarse(&boxes.get(lane)).bounds(&others).to_array();
            // A pair counts once, and an item makes none with itself.
            let from = if is_one { lane + usize::from(first.is_item()) } else { 0 };
            for (&second, bound) in seconds.iter().zip(bounds).skip(from) {
                if bound <= end && second != Link::NONE {
                    self.push(bound, (first, second));
                }
            }
        }
        self.deep[start..].sort_unstable();
    }
}

impl<V: Vector> Bvh<V> {
    /// The children of a node with their boxes; or an item by itself.
    #[inline]
    fn parts(&self, link: Link) -> (Boxes, [Link; WIDTH]) {
        if let Child::Node(node) = link.child() {
            return (self.nodes[node].boxes, self.nodes[node].children);
        }
        let (mut boxes, mut links) = (Boxes::EMPTY, [Link::NONE; WIDTH]);
        boxes.set(0, self.seen(link.child()));
        links[0] = link;
        (boxes, links)
    }
}
