//! The way from the world, or from another link, to a link.

use alloc::vec::Vec;

use convex_support::numerics::bound::raised;
use convex_support::{Scalar, Vector};

use super::frame::LinkFrame;
use super::stage::JointStage;
use crate::motion::Bounds;

/// The moving joints on the way from one frame to a link, and the link's frame beyond the last of them.
#[derive(Clone, Debug)]
pub(super) struct Route<V: Vector> {
    pub(super) stages: Vec<JointStage<V>>,
    pub(super) tail: LinkFrame<V>,
    /// How far the last joint of the link's own way from the world is from the last of this one, beside those of the
    /// links: not at all, but where the way leads back only.
    pub(super) rim: V::Scalar,
}

impl<V: Vector> Route<V> {
    pub(super) fn new(mut stages: Vec<JointStage<V>>, tail: LinkFrame<V>) -> Self {
        for k in 1..stages.len() {
            let (axis, arm) = (stages[k - 1].axis, stages[k].fixed.translation);
            stages[k].off_axis = if V::DIM == 3 { arm - axis * axis.dot(arm) } else { arm }.norm();
        }
        Self { stages, tail, rim: V::Scalar::ZERO }
    }

    /// The bounds for points that it carries, if its joints change at these rates, and slide no farther than `slides`.
    pub(super) fn bounds(
        &self,
        rates: impl Fn(usize) -> V::Scalar,
        slides: impl Fn(usize) -> V::Scalar,
    ) -> Bounds<V::Scalar> {
        let (mut bounds, mut next) = (Bounds::REST, [V::Scalar::ZERO; 2]);
        for stage in self.stages.iter().rev() {
            if stage.turns() {
                bounds.turn(rates(stage.column), next[1]);
            } else {
                bounds.slide(rates(stage.column), slides(stage.column));
            }
            bounds.lengthen(next[0]);
            next = [stage.arm, stage.off_axis];
        }
        bounds
    }

    /// The route to a frame from another, each given by its way from the world: back along the one to where they part,
    /// and on along the other.
    ///
    /// With `F` for what is fixed and `M` for what moves, `(F₁M₁…FₙMₙT)⁻¹` is `T⁻¹·Mₙ⁻¹·Fₙ⁻¹·…·M₁⁻¹·F₁⁻¹`: the stages
    /// of the way back have the fixed parts of the stages after them.
    pub(super) fn between(from: &Self, to: &Self) -> Self {
        let shared = from.stages.iter().zip(&to.stages).take_while(|(a, b)| a.column == b.column).count();
        let mut fixed = from.tail.inverse();
        let mut stages = Vec::with_capacity(from.stages.len() + to.stages.len() - 2 * shared);
        for stage in from.stages[shared..].iter().rev() {
            stages.push(stage.from(fixed, -V::Scalar::ONE));
            fixed = stage.fixed.inverse();
        }
        for (i, stage) in to.stages[shared..].iter().enumerate() {
            let before = if i == 0 { fixed.then(&stage.fixed) } else { stage.fixed };
            stages.push(stage.from(before, V::Scalar::ONE));
        }
        if to.stages.len() > shared {
            return Self::new(stages, to.tail);
        }
        let rim = from.stages.get(shared).map_or(V::Scalar::ZERO, |stage| raised(stage.arm));
        Self { rim, ..Self::new(stages, fixed.then(&to.tail)) }
    }
}
