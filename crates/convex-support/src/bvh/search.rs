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

/// A level leaves at most three children behind while the fourth is looked into.
const STACK: usize = (WIDTH - 1) * MAX_DEPTH + 1;

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
        // The root, and places that are not read before they are written: all bits zero, which is soon done.
        let mut stack = [(Link::node(0), V::Scalar::ZERO); STACK];
        let (mut top, mut nodes) = (1, 0);
        while top > 0 {
            top -= 1;
            let (link, bound) = stack[top];
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
                    let (mut near, bounds) = (bounds.at_most(limit), bounds.to_array());
                    let bottom = top;
                    while near != 0 {
                        let lane = near.trailing_zeros() as usize;
                        near &= near - 1;
                        // Sorted with the least on top.
                        let (bound, mut place) = (bounds[lane], top);
                        while place > bottom && stack[place - 1].1 < bound {
                            stack[place] = stack[place - 1];
                            place -= 1;
                        }
                        stack[place] = (node.children[lane], bound);
                        top += 1;
                    }
                }
            }
        }
        nodes
    }
}
