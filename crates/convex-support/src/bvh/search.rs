//! Items in the order of a bound, with a limit that shrinks.

use core::hint::black_box;
use core::ops::ControlFlow;

use super::Bvh;
use super::bound::{Bound, CoarseBound};
use super::node::{Child, Link, Node, WIDTH};
use crate::glam::Vec4;
use crate::{Scalar, Vector};

/// The greatest number of nodes from the root to an item; `change.rs` derives it.
pub(super) const MAX_DEPTH: usize = 36;

/// A level leaves at most three children while the fourth is searched; and all four of the lowest level are stored,
/// near or not.
const STACK: usize = (WIDTH - 1) * (MAX_DEPTH + 1) + 1;

/// The same if the next node is taken before the children of this one are stored. Then the children of a node end at
/// most `2·WIDTH − 2` places above its own: they come after those of the node before it, one of which has been taken.
const STACK_WITHIN: usize = 2 * (WIDTH - 1) * (MAX_DEPTH + 1) + 1;

/// How many items are found before they are tested.
const BATCH: usize = 32;

impl<V: Vector> Bvh<V> {
    /// Calls `visit` for the items whose bound is at most `limit`, mostly the least bound first, and returns the number
    /// of nodes that were tested.
    ///
    /// `visit` takes an item and its bound, and returns the limit from then on, or breaks off. If the bound of an item
    /// is at most the final limit, the item has been visited; other items may have been visited too.
    pub fn search<B: Bound<V>>(
        &self,
        question: &B,
        limit: V::Scalar,
        mut visit: impl FnMut(usize, V::Scalar) -> ControlFlow<(), V::Scalar>,
    ) -> usize {
        let Some(mut limit) = finite(limit) else { return 0 };
        let coarse = question.coarse(&self.frame);
        let mut end = coarse_limit(&coarse, limit);
        // The links still to be searched, the least bound on top, and the next one: the least child of a node, which
        // need not wait for the order of the others. Places that are not read before they are written are all zero
        // bits, which is fast.
        let mut pending = [0; STACK];
        let (mut next, mut top, mut nodes) = (Link::ROOT.after(0.0), 0, 0);
        loop {
            let (link, bound) = Link::with_bound(next);
            match if bound <= end { link.child() } else { Child::None } {
                Child::None => {}
                Child::Item(item) => {
                    let bound = question.bound(&self.boxes[item]);
                    if bound <= limit {
                        let ControlFlow::Continue(least) = visit(item, bound) else { return nodes };
                        let Some(least) = finite(least) else { return nodes };
                        if least != limit {
                            (limit, end) = (least, coarse_limit(&coarse, least));
                        }
                    }
                }
                Child::Node(index) => {
                    nodes += 1;
                    let node = &self.nodes[index];
                    self.fetch(node);
                    let bounds = coarse.bounds(&node.boxes);
                    let near = bounds.cmple(Vec4::splat(end)).bitmask();
                    if near != 0 {
                        let (sorted, least) = sorted(near, node.children, bounds.to_array());
                        pending[top..top + WIDTH].copy_from_slice(&sorted);
                        top += near.count_ones() as usize - 1;
                        next = least;
                        continue;
                    }
                }
            }
            if top == 0 {
                return nodes;
            }
            top -= 1;
            next = pending[top];
        }
    }

    /// Visits the items whose bound is at most `limit`, in no particular order, until `visit` breaks off. Returns the
    /// number of nodes that were tested.
    ///
    /// Nodes do not wait for one another: the next node is known before this one's children are, and is fetched
    /// meanwhile; and no branch depends on which children are near, or on their kind. Each is stored as both a node and
    /// an item, and counts as one.
    pub fn within<B: Bound<V>>(
        &self,
        question: &B,
        limit: V::Scalar,
        mut visit: impl FnMut(usize) -> ControlFlow<()>,
    ) -> usize {
        let Some(limit) = finite(limit) else { return 0 };
        let coarse = question.coarse(&self.frame);
        let end = Vec4::splat(coarse_limit(&coarse, limit));
        // The first place is that of the root; the others are not read before they are written.
        let (mut below, mut found) = ([Link::ROOT; STACK_WITHIN], [Link::NONE; BATCH]);
        let (mut top, mut count, mut nodes, mut next) = (1, 0, 0, None);
        while let Some(link) = next.or_else(|| pop(&below, &mut top)) {
            next = pop(&below, &mut top);
            nodes += 1;
            let node = &self.nodes[link.index()];
            self.fetch(node);
            let near = coarse.bounds(&node.boxes).cmple(end).bitmask();
            for (lane, &child) in node.children.iter().enumerate() {
                let is_near = near >> lane & 1 != 0;
                (below[top], found[count]) = (child, child);
                top += usize::from(is_near & child.is_node());
                count += usize::from(is_near & child.is_item());
            }
            if count > BATCH - WIDTH {
                if self.show(question, limit, &found[..count], &mut visit).is_break() {
                    return nodes;
                }
                count = 0;
            }
        }
        // The search is over, so a break no longer matters.
        let _ = self.show(question, limit, &found[..count], &mut visit);
        nodes
    }

    /// Loads parts of the child nodes of a node before it is known which of them the search enters. Otherwise, in a
    /// tree that does not fit into the caches, a search would spend much of its time waiting for the next node.
    ///
    /// The values are not used: `black_box` keeps the loads, one from either line of the cache. If a child is no node,
    /// the last node is loaded instead, because a branch on the kind of the child would often be predicted wrongly.
    #[inline(always)]
    fn fetch(&self, node: &Node) {
        let last = self.nodes.len() - 1;
        for child in node.children {
            let child = &self.nodes[child.node_or(last)];
            black_box((child.boxes.min(0).x, child.count));
        }
    }

    /// Visits those of some items whose own bound is at most `limit`.
    #[inline(always)]
    fn show<B: Bound<V>>(
        &self,
        question: &B,
        limit: V::Scalar,
        items: &[Link],
        visit: &mut impl FnMut(usize) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut near = items.iter().map(|link| link.index()).filter(|&item| question.bound(&self.boxes[item]) <= limit);
        near.try_for_each(visit)
    }
}

/// Takes the top element.
#[inline(always)]
fn pop(stack: &[Link], top: &mut usize) -> Option<Link> {
    *top = top.checked_sub(1)?;
    Some(stack[*top])
}

/// A limit that bounds can be within; infinity counts as the largest number.
#[inline]
pub(super) fn finite<S: Scalar>(limit: S) -> Option<S> {
    (limit >= S::ZERO).then(|| limit.min(S::max_value()))
}

/// The coarse limit for a limit. A bound equal to the largest number may stand for a larger one.
#[inline]
pub(super) fn coarse_limit<S: Scalar>(coarse: &impl CoarseBound, limit: S) -> f32 {
    coarse.limit(if limit < S::max_value() { limit.as_f64() } else { f64::INFINITY })
}

/// The children with their bounds in descending order, those without a bit in `near` last; and the least of all, which
/// is known before their order is.
///
/// A network of five exchanges without a branch: no processor can predict which of two is less.
#[inline(always)]
fn sorted(near: u32, children: [Link; WIDTH], bounds: [f32; WIDTH]) -> ([u64; WIDTH], u64) {
    let keys: [u64; WIDTH] = core::array::from_fn(|lane| children[lane].after(bounds[lane]));
    let least = keys[0].min(keys[1]).min(keys[2].min(keys[3]));
    let mut sorted: [u64; WIDTH] = core::array::from_fn(|lane| if near & 1 << lane == 0 { 0 } else { keys[lane] });
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        (sorted[i], sorted[j]) = (sorted[i].max(sorted[j]), sorted[i].min(sorted[j]));
    }
    (sorted, least)
}
