//! The frame of an instance, in which questions search its tree, and the room that rounding takes there.

use convex_support::{Matrix as _, Scalar, Vector};

/// The frame of an instance, as questions see it.
pub(crate) struct InstanceFrame<V: Vector> {
    pub(super) rotation: V::Matrix,
    pub(super) translation: V,
    pub(super) reach: V::Scalar,
}

impl<V: Vector> InstanceFrame<V> {
    /// A vector of the world.
    pub(super) fn vector(&self, v: V) -> V {
        self.rotation.transpose_mul(v)
    }

    /// A point of the world; its error, and that of members in the world, are within the [room](Self::room) of it.
    pub(super) fn point(&self, x: V) -> V {
        self.rotation.transpose_mul(x - self.translation)
    }

    /// The half extents of a box along the axes of the frame around one along the world's.
    pub(super) fn half_extents(&self, half: V) -> V {
        V::from_fn(|i| self.rotation.col(i).abs().dot(half))
    }

    /// The size of the region that a question about points this far from the world's origin has to be enlarged by.
    pub(super) fn room(&self, x: V) -> V::Scalar {
        room(self.reach + x.abs().dot(V::ONE))
    }

    /// The offset along a normal of the world.
    pub(super) fn offset(&self, normal: V, offset: V::Scalar) -> V::Scalar {
        offset - normal.dot(self.translation)
    }
}

/// Room for the rounding of poses. The image of a point loses a few ε of the coordinates, and so do the single query of
/// a member and the [box](outer_box) of it: 32 ε of the numbers that define it, which are no more than its coordinates.
/// Taking a question back loses as much.
pub(super) fn room<S: Scalar>(reach: S) -> S {
    S::from_f64(128.0) * S::EPSILON * reach
}
