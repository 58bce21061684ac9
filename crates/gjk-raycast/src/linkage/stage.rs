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
    /// How far that is from the axis of the joint before it.
    pub(super) off_axis: V::Scalar,
    /// A unit vector in its own frame.
    pub(super) axis: V,
    pub(super) motion: StageMotion<V>,
    /// The place of its value among the joint values.
    pub(super) column: usize,
}

/// How a stage moves.
#[derive(Clone, Debug)]
pub(super) enum StageMotion<V: Vector> {
    /// By an angle about the axis. With `A` the matrix of the product with it, the rotation is `1 + sin·A + (1 − cos)·A²`
    /// (Rodrigues); `sine` and `versine` are its terms as the fixed rotation turns them.
    Turn { sine: V::Matrix, versine: V::Matrix },
    /// Along the axis, as the fixed rotation turns it.
    Slide { along: V },
}

impl<V: Vector> JointStage<V> {
    /// The stage of a joint that is at `fixed`; `None` for one that does not move, or whose axis is none.
    pub(super) fn new(fixed: LinkFrame<V>, kind: JointKind<V>, column: usize) -> Option<Self> {
        match kind {
            JointKind::Fixed => None,
            JointKind::Revolute(axis) => Some(Self::about(fixed, axial::vector::<V>(axis).unit()?, true, column)),
            JointKind::Prismatic(axis) => Some(Self::about(fixed, axis.unit()?, false, column)),
        }
    }

    fn about(fixed: LinkFrame<V>, axis: V, turns: bool, column: usize) -> Self {
        let product = axial::matrix(axis);
        let sine = fixed.rotation * product;
        let turn = StageMotion::Turn { sine, versine: sine * product };
        let motion = if turns { turn } else { StageMotion::Slide { along: fixed.rotation * axis } };
        Self { arm: fixed.translation.norm(), off_axis: V::Scalar::ZERO, fixed, axis, motion, column }
    }

    /// The stage that moves as this one does, from another frame on; or that takes it back, with the sign -1.
    pub(super) fn from(&self, fixed: LinkFrame<V>, sign: V::Scalar) -> Self {
        Self::about(fixed, self.axis * sign, self.turns(), self.column)
    }

    pub(super) fn turns(&self) -> bool {
        matches!(self.motion, StageMotion::Turn { .. })
    }

    /// Its axis and its origin, by its frame as it has moved.
    pub(super) fn placed(&self, frame: &LinkFrame<V>) -> [V; 2] {
        let axis = if self.turns() { axial::turned(&frame.rotation, self.axis) } else { frame.rotation * self.axis };
        [axis, frame.translation]
    }

    /// How fast a point goes along `n`, as its value changes, where its axis and origin are these.
    pub(super) fn rise(&self, [axis, origin]: [V; 2], n: V, point: V) -> V::Scalar {
        n.dot(if self.turns() { axial::turning(axis, point - origin) } else { axis })
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
