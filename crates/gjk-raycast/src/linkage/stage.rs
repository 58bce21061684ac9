//! A joint that moves, and the way to it from the one before.

use convex_support::{Matrix as _, Scalar, Vector};

use super::frame::LinkFrame;
use super::joint::JointKind;
use crate::axial;

/// The way from one moving joint to the next, and how that moves: `x ↦ fixed·motion(value)·x`.
#[derive(Clone, Debug)]
pub(super) struct JointStage<V: Vector> {
    /// Its frame in that of the moving joint before it, at the value 0.
    pub(super) fixed: LinkFrame<V>,
    /// How far its origin is from that of the joint before it.
    pub(super) arm: V::Scalar,
    pub(super) motion: StageMotion<V>,
    /// The place of its value among the joint values.
    pub(super) column: usize,
}

/// How a stage moves.
#[derive(Clone, Debug)]
pub(super) enum StageMotion<V: Vector> {
    /// By an angle about a unit axis. With `A` the matrix of the product with the axis, the rotation is
    /// `1 + sin·A + (1 − cos)·A²` (Rodrigues); `sine` and `versine` are its terms as the fixed rotation turns them.
    Turn { axis: V, sine: V::Matrix, versine: V::Matrix },
    /// Along a unit axis, in its own frame, and as the fixed rotation turns it.
    Slide { axis: V, along: V },
}

impl<V: Vector> JointStage<V> {
    /// The stage of a joint that is at `fixed`; `None` for one that does not move, or whose axis is none.
    pub(super) fn new(fixed: LinkFrame<V>, kind: JointKind<V>, column: usize) -> Option<Self> {
        let arm = fixed.translation.norm();
        let motion = match kind {
            JointKind::Fixed => return None,
            JointKind::Revolute(axis) => Self::turning(&fixed, axial::vector::<V>(axis).unit()?),
            JointKind::Prismatic(axis) => Self::sliding(&fixed, axis.unit()?),
        };
        Some(Self { fixed, arm, motion, column })
    }

    fn turning(fixed: &LinkFrame<V>, axis: V) -> StageMotion<V> {
        let product = axial::matrix(axis);
        let sine = fixed.rotation * product;
        StageMotion::Turn { axis, sine, versine: sine * product }
    }

    fn sliding(fixed: &LinkFrame<V>, axis: V) -> StageMotion<V> {
        StageMotion::Slide { axis, along: fixed.rotation * axis }
    }

    /// The stage that moves as this one does, from another frame on; or that takes it back, with the sign -1.
    pub(super) fn from(&self, fixed: LinkFrame<V>, sign: V::Scalar) -> Self {
        let motion = match self.motion {
            StageMotion::Turn { axis, .. } => Self::turning(&fixed, axis * sign),
            StageMotion::Slide { axis, .. } => Self::sliding(&fixed, axis * sign),
        };
        Self { arm: fixed.translation.norm(), fixed, motion, column: self.column }
    }

    /// Its axis, by its frame as it has moved.
    pub(super) fn axis_in(&self, frame: &LinkFrame<V>) -> V {
        match self.motion {
            StageMotion::Turn { axis, .. } => axial::turned(&frame.rotation, axis),
            StageMotion::Slide { axis, .. } => frame.rotation * axis,
        }
    }

    /// The rotation of a stage that turns, from its fixed part's on.
    #[inline(always)]
    pub(super) fn rotation(
        &self,
        sine: &V::Matrix,
        versine: &V::Matrix,
        (sin, cos): (V::Scalar, V::Scalar),
    ) -> V::Matrix {
        let rest = V::Scalar::ONE - cos;
        V::Matrix::from_cols_fn(|j| self.fixed.rotation.col(j) + sine.col(j) * sin + versine.col(j) * rest)
    }
}
