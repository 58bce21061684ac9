//! What a linkage is made of.

use convex_support::{SupportMap, Vector};

use crate::Pose;

/// A joint of a [`Linkage`](crate::Linkage): where its frame is in that of its parent, and how it moves from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint<V: Vector> {
    /// The index of the joint that carries it, which comes before it; `None` for the world.
    pub parent: Option<usize>,
    /// Its frame in its parent's, at the value 0.
    pub pose: Pose<V>,
    /// How it moves from there.
    pub kind: JointKind<V>,
}

/// How a joint moves what it carries, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind<V: Vector> {
    /// Not at all: it has no value.
    Fixed,
    /// It turns about an axis through the origin by its value, in radians, after the right-hand rule. Of the axis only
    /// the direction counts; in 2D it is a number, of which the sign does.
    Revolute(V::AngularVelocity),
    /// It slides along an axis by its value. Of the axis only the direction counts.
    Prismatic(V),
}

/// A link of a [`Linkage`](crate::Linkage): bodies that one joint carries.
#[derive(Clone, Debug, PartialEq)]
pub struct Link<S: SupportMap> {
    /// The index of the joint; `None` for the world.
    pub joint: Option<usize>,
    /// The bodies, in the frame of the joint. There may be none.
    pub bodies: alloc::vec::Vec<S>,
}

impl<V: Vector> Joint<V> {
    /// A joint that turns about an axis, at a pose in its parent's frame.
    #[must_use]
    pub fn revolute(parent: Option<usize>, pose: Pose<V>, axis: V::AngularVelocity) -> Self {
        Self { parent, pose, kind: JointKind::Revolute(axis) }
    }

    /// A joint that slides along an axis.
    #[must_use]
    pub fn prismatic(parent: Option<usize>, pose: Pose<V>, axis: V) -> Self {
        Self { parent, pose, kind: JointKind::Prismatic(axis) }
    }

    /// A joint that does not move.
    #[must_use]
    pub fn fixed(parent: Option<usize>, pose: Pose<V>) -> Self {
        Self { parent, pose, kind: JointKind::Fixed }
    }
}
