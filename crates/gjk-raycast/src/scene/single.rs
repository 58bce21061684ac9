//! What a scene needs to know of a single cast, whatever was cast.

use convex_support::{SupportMap, Vector};

use super::Body;
use super::result::BodyHit;
use crate::{
    LinearCast, LinearCastOptions, LinearHit, Motion, MotionCast, MotionCastOptions, MotionHit, Outcome, Ray, RayCast,
    RayCastError, RayCastOptions, RayHit, RigidMotion, Status, Trajectory, linear_cast, motion_cast, ray_cast,
};

/// The answer of one cast: `H` is a hit, `S` its λ or time.
pub(super) struct SingleAnswer<H, S> {
    /// The hit, with its λ or time.
    pub(super) hit: Option<(S, H)>,
    pub(super) is_undecided: bool,
    pub(super) lower: S,
    pub(super) upper: S,
    pub(super) status: Status,
}

impl<H, S> SingleAnswer<H, S> {
    /// The hit as that of a body.
    pub(super) fn of(self, body: usize) -> Option<BodyHit<H, S>> {
        let Self { hit, lower, upper, status, .. } = self;
        hit.map(|(_, hit)| BodyHit { body, hit, lower, upper, status })
    }
}

impl<V: Vector> From<RayCast<V>> for SingleAnswer<RayHit<V>, V::Scalar> {
    fn from(RayCast { outcome, lower, upper, status, .. }: RayCast<V>) -> Self {
        let is_undecided = matches!(outcome, Outcome::Undecided);
        Self { hit: outcome.hit().map(|hit| (hit.lambda, hit)), is_undecided, lower, upper, status }
    }
}

impl<V: Vector> From<LinearCast<V>> for SingleAnswer<LinearHit<V>, V::Scalar> {
    fn from(LinearCast { outcome, lower, upper, status, .. }: LinearCast<V>) -> Self {
        let is_undecided = matches!(outcome, Outcome::Undecided);
        Self { hit: outcome.hit().map(|hit| (hit.time, hit)), is_undecided, lower, upper, status }
    }
}

impl<V: Vector> From<MotionCast<V>> for SingleAnswer<MotionHit<V>, V::Scalar> {
    fn from(MotionCast { outcome, lower, upper, status, .. }: MotionCast<V>) -> Self {
        let is_undecided = matches!(outcome, Outcome::Undecided);
        Self { hit: outcome.hit().map(|hit| (hit.time, hit)), is_undecided, lower, upper, status }
    }
}

impl<S: SupportMap> Body<S> {
    #[inline]
    pub(super) fn ray_cast(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
    ) -> Result<RayCast<S::Vector>, RayCastError> {
        match self {
            Self::Convex(body) => ray_cast(body, ray, options),
            Self::HalfSpace(half_space) => half_space.ray_cast(ray, options),
        }
    }

    /// The cast of a shape against this body.
    #[inline]
    pub(super) fn linear_cast<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<S::Vector>,
        options: LinearCastOptions<S::Vector>,
    ) -> Result<LinearCast<S::Vector>, RayCastError> {
        match self {
            Self::Convex(body) => linear_cast(shape, body, motion, options),
            Self::HalfSpace(half_space) => half_space.linear_cast(shape, motion, options),
        }
    }

    /// The cast of a shape that moves and turns against this body, which is at rest.
    pub(crate) fn motion_cast<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: &impl Trajectory<Vector = S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<MotionCast<S::Vector>, RayCastError> {
        match self {
            Self::Convex(body) => motion_cast(shape, motion, body, RigidMotion::default(), options),
            Self::HalfSpace(half_space) => half_space.motion_cast(shape, motion, options),
        }
    }
}
