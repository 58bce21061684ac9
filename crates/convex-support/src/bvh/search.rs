//! Items in the order of a bound, with a limit that shrinks.

use core::ops::ControlFlow;

use super::Bvh;
use super::bound::{Bound, RoughBound};
use super::node::{Child, Link, WIDTH};
use crate::glam::Vec4;
use crate::{Scalar, Vector};

/// The greatest number of nodes from the root to an item; `change.rs` says why.
pub(super) const MAX_DEPTH: usize = 36;

/// A level leaves at most three children behind while the fourth is looked into; and of the lowest all four are written, near or not.
const STACK: usize = (WIDTH - 1) * (MAX_DEPTH + 1) + 1;

impl<V: Vector> Bvh<V> {
    /// Shows the items whose bound is at most `limit`, mostly the least bound first, and returns the number of nodes that
    /// were looked into.
    ///
    /// `visit` is given an item and its bound, and answers with the limit from then on, or breaks off. An item whose bound
    /// exceeds the limit that holds at the end may have been shown or not; every other has been.
    pub fn search<B: Bound<V>>(
        &self,
        question: &B,
        limit: V::Scalar,
        mut visit: impl FnMut(usize, V::Scalar) -> ControlFlow<(), V::Scalar>,
    ) -> usize {
        let Some(mut limit) = finite(limit) else { return 0 };
        let rough = question.rough(&self.frame);
        let mut end = rough_limit(&rough, limit);
        // What remains to be looked at, the least bound on top. Places that are not read before they are written are all bits zero, which
        // is soon done.
        let mut pending = [0; STACK];
        pending[0] = Link::ROOT.after(0.0);
        let (mut top, mut nodes) = (1, 0);
        while top > 0 {
            top -= 1;
            let (link, bound) = Link::with_bound(pending[top]);
            if bound > end {
                continue;
            }
            match link.child() {
                Child::None => {}
                Child::Item(item) => {
                    let bound = question.bound(&self.boxes[item]);
                    if bound <= limit {
                        let ControlFlow::Continue(next) = visit(item, bound) else { return nodes };
                        let Some(next) = finite(next) else { return nodes };
                        if next != limit {
                            (limit, end) = (next, rough_limit(&rough, next));
                        }
                    }
                }
                Child::Node(index) => {
                    nodes += 1;
                    let node = &self.nodes[index];
                    let bounds = rough.bounds(&node.boxes);
                    let near = bounds.cmple(Vec4::splat(end)).bitmask();
                    if near != 0 {
                        let sorted = sorted(near, node.children, bounds.to_array());
                        pending[top..top + WIDTH].copy_from_slice(&sorted);
                        top += near.count_ones() as usize;
                    }
                }
            }
        }
        nodes
    }

    /// Shows the items whose bound is at most `limit`, in no particular order, until `visit` breaks off. Returns the number of nodes that
    /// were looked into.
    pub fn within<B: Bound<V>>(
        &self,
        question: &B,
        limit: V::Scalar,
        mut visit: impl FnMut(usize) -> ControlFlow<()>,
    ) -> usize {
        let Some(limit) = finite(limit) else { return 0 };
        let rough = question.rough(&self.frame);
        let end = Vec4::splat(rough_limit(&rough, limit));
        // The root, and places that are not read before they are written.
        let mut below = [0; STACK];
        let (mut top, mut nodes) = (1, 0);
        while top > 0 {
            top -= 1;
            nodes += 1;
            let node = &self.nodes[below[top]];
            let mut near = rough.bounds(&node.boxes).cmple(end).bitmask();
            while near != 0 {
                let child = node.children[near.trailing_zeros() as usize].child();
                near &= near - 1;
                match child {
                    Child::None => {}
                    Child::Item(item) => {
                        if question.bound(&self.boxes[item]) <= limit && visit(item).is_break() {
                            return nodes;
                        }
                    }
                    Child::Node(index) => {
                        below[top] = index;
                        top += 1;
                    }
                }
            }
        }
        nodes
    }
}

/// A limit that something can be within; infinity is as good as the largest number.
#[inline]
pub(super) fn finite<S: Scalar>(limit: S) -> Option<S> {
    (limit >= S::ZERO).then(|| limit.min(S::max_value()))
}

/// The rough limit for a limit. A bound that is the largest number may stand for a larger one.
#[inline]
fn rough_limit<S: Scalar>(rough: &impl RoughBound, limit: S) -> f32 {
    rough.limit(if limit < S::max_value() { limit.as_f64() } else { f64::INFINITY })
}

/// The children with their bounds in descending order, of which those that the bits of `near` leave out come last.
///
/// A network of five exchanges, none of which branches: which of two is the lesser nobody can foretell.
#[inline(always)]
fn sorted(near: u32, children: [Link; WIDTH], bounds: [f32; WIDTH]) -> [u64; WIDTH] {
    let mut sorted: [u64; WIDTH] =
        core::array::from_fn(|lane| if near & 1 << lane == 0 { 0 } else { children[lane].after(bounds[lane]) });
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        (sorted[i], sorted[j]) = (sorted[i].max(sorted[j]), sorted[i].min(sorted[j]));
    }
    sorted
}
