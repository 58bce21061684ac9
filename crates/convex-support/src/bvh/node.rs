//! Nodes: four boxes side by side, and what is in them.

use num_traits::Float as _;

use super::lanes::Lanes;
use crate::{Aabb, Scalar, Vector};

/// The number of children of a node.
pub const WIDTH: usize = 4;

/// Four numbers of a space side by side.
pub(super) type LanesOf<V> = <<V as Vector>::Scalar as Scalar>::Lanes;

/// The boxes of a node's children, coordinate by coordinate and side by side, so that the same arithmetic on all four is
/// one vector instruction. A place without a child has `min = ∞` and `max = −∞`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boxes<V: Vector> {
    /// By coordinate, of which only [`Vector::DIM`] are used; then the smallest and the largest.
    planes: [[LanesOf<V>; 2]; 3],
}

impl<V: Vector> Boxes<V> {
    pub(super) fn empty() -> Self {
        Self { planes: [[Lanes::splat(V::Scalar::infinity()), Lanes::splat(V::Scalar::neg_infinity())]; 3] }
    }

    /// The smallest values of coordinate `axis`, by child.
    ///
    /// # Panics
    /// If `axis >= DIM`.
    #[inline]
    #[must_use]
    pub fn min(&self, axis: usize) -> LanesOf<V> {
        self.planes[axis][0]
    }

    /// The largest values of coordinate `axis`, by child.
    ///
    /// # Panics
    /// If `axis >= DIM`.
    #[inline]
    #[must_use]
    pub fn max(&self, axis: usize) -> LanesOf<V> {
        self.planes[axis][1]
    }

    /// The smallest values for side 0, the largest for side 1.
    #[inline]
    pub(super) fn side(&self, axis: usize, side: usize) -> LanesOf<V> {
        self.planes[axis][side]
    }

    /// The box of child `lane`.
    ///
    /// # Panics
    /// If `lane >= WIDTH`.
    #[inline]
    #[must_use]
    pub fn get(&self, lane: usize) -> Aabb<V> {
        Aabb {
            min: V::from_fn(|axis| self.planes[axis][0].get(lane)),
            max: V::from_fn(|axis| self.planes[axis][1].get(lane)),
        }
    }

    #[inline]
    pub(super) fn set(&mut self, lane: usize, b: Aabb<V>) {
        for axis in 0..V::DIM {
            self.planes[axis][0].set(lane, b.min.get(axis));
            self.planes[axis][1].set(lane, b.max.get(axis));
        }
    }

    #[inline]
    pub(super) fn clear(&mut self, lane: usize) {
        for axis in 0..V::DIM {
            self.planes[axis][0].set(lane, V::Scalar::infinity());
            self.planes[axis][1].set(lane, V::Scalar::neg_infinity());
        }
    }

    /// The box around all four.
    #[inline]
    pub(super) fn union(&self) -> Aabb<V> {
        (1..WIDTH).fold(self.get(0), |sum, lane| sum.union(&self.get(lane)))
    }
}

/// The lesser of two; the second where one is NaN. One machine instruction, which `Float::min` is not.
#[inline]
pub(super) fn lesser<S: Scalar>(a: S, b: S) -> S {
    if a < b { a } else { b }
}

/// A child in four bytes: nothing, an item, or a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Link(u32);

/// What a [`Link`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Child {
    None,
    Item(usize),
    Node(usize),
}

impl Link {
    pub(super) const NONE: Self = Self(u32::MAX);
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
    pub(super) fn child(self) -> Child {
        match self {
            Self::NONE => Child::None,
            Self(item) if item & Self::ITEM != 0 => Child::Item((item & !Self::ITEM) as usize),
            Self(node) => Child::Node(node as usize),
        }
    }
}

/// An index in four bytes.
///
/// # Panics
/// If there are too many items, 2³⁰ or more.
#[inline]
fn index(of: usize) -> u32 {
    assert!(of < Link::END, "a tree holds fewer than 2³⁰ items, and {of} is not the number of one");
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

/// A node: its children with their boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node<V: Vector> {
    pub(super) boxes: Boxes<V>,
    pub(super) children: [Link; WIDTH],
    /// Its place in its parent; [`Slot::NONE`] for the root.
    pub(super) parent: Slot,
    /// The number of items under it.
    pub(super) count: u32,
}

impl<V: Vector> Node<V> {
    pub(super) fn empty(parent: Slot) -> Self {
        Self { boxes: Boxes::empty(), children: [Link::NONE; WIDTH], parent, count: 0 }
    }
}
