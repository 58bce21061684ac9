//! A bounding volume hierarchy, the tree of boxes of a [`Bvh`]: finds the boxes that a question concerns, without
//! testing each.
//!
//! [`outer_box`] is the box of a shape with room for rounding. A question is a [`Bound`]: a [`BoxDistance`], a
//! [`SweptBox`], or one of yours. To ask shapes and not boxes, take a `Scene` of gjk-raycast.

mod bound;
mod build;
mod change;
mod frame;
mod nearest_pairs;
mod node;
mod outer_box;
mod pairs;
mod search;

use alloc::vec::Vec;

use self::node::{Node, Slot};
use crate::{Aabb, Vector};

pub use bound::{Bound, BoxDistance, CoarseBound, CoarseBoxDistance, CoarseSweptBox, SweptBox};
pub use frame::{CoarseUnit, Frame};
pub use nearest_pairs::NearestPairs;
pub use node::{Boxes, WIDTH};
pub use outer_box::outer_box;
pub use pairs::PairSearch;

/// A tree over the boxes of items, which the caller names by numbers from 0 to 2³⁰ − 1.
///
/// The tree is [built](Self::new) by the surface area heuristic. Boxes may move ([`refit`](Self::refit),
/// [`set`](Self::set)), and items may be added and removed ([`insert`](Self::insert), [`remove`](Self::remove)).
///
/// [`search`](Self::search) finds the items that a question concerns, by a [`Bound`], nearest first;
/// [`within`](Self::within) finds them in any order. [`pairs_within`](Self::pairs_within) and
/// [`pairs_between`](Self::pairs_between) find pairs of boxes that are near each other, and
/// [`nearest_pairs`](Self::nearest_pairs) the nearest ones first.
///
/// A node holds the boxes of its four children side by side, in single precision and in the coordinates of a
/// [`Frame`], so that one pass of arithmetic bounds all four. A child is a node or an item. The items that a question
/// visits depend only on the items' own boxes. The depth stays below 36 whatever the boxes and their order, since a
/// part that has become lopsided is rebuilt. So a question needs only a stack of fixed size, and allocates nothing.
///
/// Boxes must be finite, with `min ≤ max`. If a box is not, its own item may not be found, and others may be found more
/// slowly; nothing panics.
///
/// ```
/// use core::ops::ControlFlow;
/// use convex_support::{Aabb, BoxDistance, Bvh, glam::DVec2};
///
/// let square = |x: f64| Aabb { min: DVec2::new(x, 0.0), max: DVec2::new(x + 1.0, 1.0) };
/// let tree = Bvh::new(&[square(0.0), square(4.0), square(9.0)]);
/// let mut nearest = None;
/// tree.search(&BoxDistance::new(square(6.0)), f64::INFINITY, |item, bound| {
///     nearest = Some((item, bound));
///     ControlFlow::Continue(bound) // what is farther need not be shown
/// });
/// let (item, bound) = nearest.ok_or("three boxes")?;
/// assert_eq!(item, 1);
/// assert!(bound <= 1.0 && bound > 0.999_999); // conservative: rounded towards zero
/// # Ok::<(), &str>(())
/// ```
#[doc(alias("aabb_tree", "dynamic_tree", "broad_phase"))]
#[derive(Clone, Debug)]
pub struct Bvh<V: Vector> {
    /// Node 0 is the root. Children come after their parents, so that one pass from the end visits them first.
    nodes: Vec<Node>,
    /// The frame of the nodes.
    frame: Frame<V>,
    /// The box of each item.
    boxes: Vec<Aabb<V>>,
    /// The place of each item.
    slots: Vec<Slot>,
    /// The number of nodes that are no longer part of the tree.
    dead: usize,
    /// The measure of how well the tree culls, when it was last built.
    built_cost: f64,
}

impl<V: Vector> Bvh<V> {
    /// The number of items.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes[0].count as usize
    }

    /// Whether there are no items.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A box around all items, by the box of the root, so that it is a little larger than need be: by 2⁻²¹ of its
    /// distance from the tree's origin. `None` if there are no items.
    #[must_use]
    pub fn around(&self) -> Option<Aabb<V>> {
        (!self.is_empty()).then(|| self.frame.in_world(&self.nodes[0].boxes.union()))
    }

    /// The box of an item; `None` if it is not in the tree.
    #[must_use]
    pub fn get(&self, item: usize) -> Option<Aabb<V>> {
        let slot = *self.slots.get(item)?;
        (slot != Slot::NONE).then(|| self.boxes[item])
    }
}

impl<V: Vector> Default for Bvh<V> {
    fn default() -> Self {
        Self::new(&[])
    }
}
