//! Nodes: four boxes side by side, and their children.

use crate::Aabb;
use crate::glam::{Vec3A, Vec4};

/// The number of children of a node.
pub const WIDTH: usize = 4;

/// The boxes of a node's children in the tree's [frame](super::Frame), coordinate by coordinate and side by side, so
/// that the same arithmetic on all four is one vector instruction. A place without a child has `min = ∞` and `max =
/// −∞`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boxes {
    /// For each coordinate, the smallest and the largest. In the plane, the third is zero.
    planes: [[Vec4; 2]; 3],
}

impl Boxes {
    pub(super) const EMPTY: Self = Self { planes: [[Vec4::INFINITY, Vec4::NEG_INFINITY]; 3] };

    /// The smallest values of coordinate `axis`, by child.
    ///
    /// # Panics
    /// If `axis >= 3`.
    #[inline]
    #[must_use]
    pub fn min(&self, axis: usize) -> Vec4 {
        self.planes[axis][0]
    }

    /// The largest values of coordinate `axis`, by child.
    ///
    /// # Panics
    /// If `axis >= 3`.
    #[inline]
    #[must_use]
    pub fn max(&self, axis: usize) -> Vec4 {
        self.planes[axis][1]
    }

    /// The smallest values for side 0, the largest for side 1.
    #[inline]
    pub(super) fn side(&self, axis: usize, side: usize) -> Vec4 {
        self.planes[axis][side]
    }

    /// The box of child `lane`.
    #[inline]
    pub(super) fn get(&self, lane: usize) -> Aabb<Vec3A> {
        let [x, y, z] = &self.planes;
        let side = |side: usize| Vec3A::new(x[side][lane], y[side][lane], z[side][lane]);
        Aabb { min: side(0), max: side(1) }
    }

    #[inline]
    pub(super) fn set(&mut self, lane: usize, b: Aabb<Vec3A>) {
        for (axis, [min, max]) in self.planes.iter_mut().enumerate() {
            (min[lane], max[lane]) = (b.min[axis], b.max[axis]);
        }
    }

    #[inline]
    pub(super) fn clear(&mut self, lane: usize) {
        for [min, max] in &mut self.planes {
            (min[lane], max[lane]) = (f32::INFINITY, f32::NEG_INFINITY);
        }
    }

    /// The box around all four.
    #[inline]
    pub(super) fn union(&self) -> Aabb<Vec3A> {
        let [x, y, z] = self.planes;
        Aabb {
            min: Vec3A::new(x[0].min_element(), y[0].min_element(), z[0].min_element()),
            max: Vec3A::new(x[1].max_element(), y[1].max_element(), z[1].max_element()),
        }
    }
}

/// A child in four bytes: nothing, an item, or a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Link(u32);

/// The kinds of a [`Link`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Child {
    None,
    Item(usize),
    Node(usize),
}

impl Link {
    pub(super) const NONE: Self = Self(u32::MAX);
    pub(super) const ROOT: Self = Self(0);
    const ITEM: u32 = 1 << 31;
    /// Items and nodes are below this, so that [`Slot`]s fit as well.
    pub(super) const END: usize = 1 << 30;

    #[inline]
    pub(super) fn item(item: usize) -> Self {
        Self(index(item) | Self::ITEM)
    }

    #[inline]
    pub(super) fn node(node: usize) -> Self {
        Self(index(node))
    }

    #[inline]
    pub(super) fn is_node(self) -> bool {
        self.0 & Self::ITEM == 0
    }

    #[inline]
    pub(super) fn is_item(self) -> bool {
        !self.is_node() && self != Self::NONE
    }

    /// The number of the node or the item.
    #[inline]
    pub(super) fn index(self) -> usize {
        (self.0 & !Self::ITEM) as usize
    }

    /// The number of the node, if the link is one and not after `last`; else `last`.
    #[inline]
    pub(super) fn node_or(self, last: usize) -> usize {
        (self.0 as usize).min(last)
    }

    #[inline]
    pub(super) fn child(self) -> Child {
        match self {
            Self::NONE => Child::None,
            Self(item) if item & Self::ITEM != 0 => Child::Item((item & !Self::ITEM) as usize),
            Self(node) => Child::Node(node as usize),
        }
    }

    /// A bound and a link as one number, in the order of the bounds, which are not negative.
    #[inline(always)]
    pub(super) fn after(self, bound: f32) -> u64 {
        u64::from(bound.to_bits()) << 32 | u64::from(self.0)
    }

    /// The bound and the link in such a number.
    #[inline(always)]
    pub(super) fn with_bound(number: u64) -> (Self, f32) {
        (Self(number as u32), f32::from_bits((number >> 32) as u32))
    }

    /// Such a number as one in the descending order of the bounds, and back.
    #[inline(always)]
    pub(super) fn descending(number: u64) -> u64 {
        number ^ !u64::from(u32::MAX)
    }
}

/// An index in four bytes.
///
/// # Panics
/// If there are too many items, 2³⁰ or more.
#[inline]
pub(super) fn index(of: usize) -> u32 {
    assert!(of < Link::END, "the numbers of items are below 2³⁰, but {of} is not");
    of as u32
}

/// One of a node's places for a child.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Slot(u32);

impl Slot {
    /// No place: that of the root, and of items that are not in the tree.
    pub(super) const NONE: Self = Self(u32::MAX);
    /// The place of a node that is no longer part of the tree.
    pub(super) const DEAD: Self = Self(u32::MAX - 1);

    #[inline]
    pub(super) fn new(node: usize, lane: usize) -> Self {
        Self(index(node) * WIDTH as u32 + lane as u32)
    }

    #[inline]
    pub(super) fn node(self) -> usize {
        self.0 as usize / WIDTH
    }

    #[inline]
    pub(super) fn lane(self) -> usize {
        self.0 as usize % WIDTH
    }
}

/// A node: its children with their boxes, in two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Node {
    pub(super) boxes: Boxes,
    pub(super) children: [Link; WIDTH],
    /// Its place in its parent; [`Slot::NONE`] for the root.
    pub(super) parent: Slot,
    /// The number of items under it.
    pub(super) count: u32,
}

impl Node {
    pub(super) fn empty(parent: Slot) -> Self {
        Self { boxes: Boxes::EMPTY, children: [Link::NONE; WIDTH], parent, count: 0 }
    }
}
