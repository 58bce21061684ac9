//! Items in the order of a bound, with a limit that shrinks.

use core::ops::ControlFlow;

use num_traits::Float as _;

use super::bound::Bound;
use super::lanes::Lanes;
use super::node::{Child, Link, WIDTH};
use super::{Bvh, node::lesser};
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
        let huge = V::Scalar::max_value();
        // NaN stays NaN, which nothing is within.
        let mut limit = lesser(huge, limit);
        let (mut pending, mut nodes) = (Pending::root(), 0);
        while let Some((link, bound)) = pending.pop() {
            let is_near = bound <= limit;
            if !is_near {
                continue;
            }
            match link.child() {
                Child::None => {}
                Child::Item(item) => match visit(item, bound) {
                    ControlFlow::Continue(next) => limit = lesser(huge, next),
                    ControlFlow::Break(()) => return nodes,
                },
                Child::Node(index) => {
                    nodes += 1;
                    let node = &self.nodes[index];
                    let bounds = question.bounds(&node.boxes);
                    pending.push_sorted(bounds.at_most(limit), node.children, bounds.to_array());
                }
            }
        }
        nodes
    }

    /// Shows the items whose bound is at most `limit`, and perhaps others whose bound [rounding cannot tell](Bound::near) from it, in no
    /// particular order, until `visit` breaks off. Returns the number of nodes that were looked into.
    pub fn within<B: Bound<V>>(
        &self,
        question: &B,
        limit: V::Scalar,
        mut visit: impl FnMut(usize) -> ControlFlow<()>,
    ) -> usize {
        let limit = lesser(V::Scalar::max_value(), limit);
        // Nothing is within NaN.
        let is_any = limit >= V::Scalar::ZERO;
        if !is_any {
            return 0;
        }
        // The root, and places that are not read before they are written.
        let mut below = [0; STACK];
        let (mut top, mut nodes) = (1, 0);
        while top > 0 {
            top -= 1;
            nodes += 1;
            let node = &self.nodes[below[top]];
            let mut near = question.near(&node.boxes, limit);
            while near != 0 {
                let child = node.children[near.trailing_zeros() as usize].child();
                near &= near - 1;
                match child {
                    Child::None => {}
                    Child::Item(item) => {
                        if visit(item).is_break() {
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

/// Children that remain to be looked at, each with its bound.
struct Pending<S> {
    links: [Link; STACK],
    bounds: [S; STACK],
    top: usize,
}

impl<S: Scalar> Pending<S> {
    /// The root alone. Places that are not read before they are written are all bits zero, which is soon done.
    #[inline(always)]
    fn root() -> Self {
        Self { links: [Link::node(0); STACK], bounds: [S::ZERO; STACK], top: 1 }
    }

    #[inline(always)]
    fn push(&mut self, link: Link, bound: S) {
        (self.links[self.top], self.bounds[self.top]) = (link, bound);
        self.top += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<(Link, S)> {
        self.top = self.top.checked_sub(1)?;
        Some((self.links[self.top], self.bounds[self.top]))
    }

    /// Those children that the bits of `near` say, the one with the least bound on top.
    #[inline(always)]
    fn push_sorted(&mut self, near: u32, children: [Link; WIDTH], bounds: [S; WIDTH]) {
        if near.count_ones() > 2 {
            for (lane, place) in places(near, bounds).into_iter().enumerate() {
                (self.links[self.top + place], self.bounds[self.top + place]) = (children[lane], bounds[lane]);
            }
            self.top += near.count_ones() as usize;
        } else if near != 0 {
            // Mostly there are one or two, and one is both the first and the last: it is then written over, which takes no branch.
            let (first, last) = (near.trailing_zeros() as usize, near.ilog2() as usize);
            let (far, close) = if bounds[first] < bounds[last] { (last, first) } else { (first, last) };
            self.push(children[far], bounds[far]);
            self.top -= usize::from(far == close);
            self.push(children[close], bounds[close]);
        }
    }
}

/// The places of four bounds in descending order, of which those that the bits of `near` leave out come last.
///
/// Every two are compared, and none of it branches: which of them is the lesser nobody can foretell.
#[inline(always)]
fn places<S: Scalar>(near: u32, bounds: [S; WIDTH]) -> [usize; WIDTH] {
    let keys: [S; WIDTH] =
        core::array::from_fn(|lane| if near & 1 << lane == 0 { S::neg_infinity() } else { bounds[lane] });
    let mut places = [0; WIDTH];
    for i in 0..WIDTH {
        for j in i + 1..WIDTH {
            let is_behind = keys[j] > keys[i];
            places[i] += usize::from(is_behind);
            places[j] += usize::from(!is_behind);
        }
    }
    places
}
