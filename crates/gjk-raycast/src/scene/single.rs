//! What a scene needs to know of a single cast, whatever was cast.

use convex_support::{AngularVelocity as _, Scalar as _, SupportMap, Vector};

use super::Body;
use super::result::BodyHit;
use crate::{
    ChainMotion, Impact, LinearCast, LinearCastOptions, Motion, MotionCast, MotionCastOptions, MotionIterate, Outcome,
    Ray, RayCast, RayCastError, RayCastOptions, RayHit, RigidMotion, Status, Trajectory, linear_cast, motion_cast,
    motion_cast_with, ray_cast,
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

impl<V: Vector> From<LinearCast<V>> for SingleAnswer<Impact<V>, V::Scalar> {
    fn from(LinearCast { outcome, lower, upper, status, .. }: LinearCast<V>) -> Self {
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
        observer: impl FnMut(MotionIterate<S::Vector>),
    ) -> Result<MotionCast<S::Vector>, RayCastError> {
        match self {
            Self::Convex(body) => motion_cast_with(shape, motion, body, RigidMotion::default(), options, observer),
            Self::HalfSpace(half_space) => half_space.motion_cast_with(shape, motion, options, observer),
        }
    }

    /// The cast of a shape, `a`, and this body, `b`, as both move: [`motion_cast`](crate::motion_cast()), also of a
    /// half-space.
    ///
    /// # Errors
    /// As of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast_of_both<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: RigidMotion<S::Vector>,
        of_body: RigidMotion<S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<MotionCast<S::Vector>, RayCastError> {
        let half_space = match self {
            Self::Convex(body) => return motion_cast(shape, motion, body, of_body, options),
            Self::HalfSpace(half_space) if of_body == RigidMotion::default() => {
                return half_space.motion_cast(shape, motion, options);
            }
            Self::HalfSpace(half_space) => half_space,
        };
        let cast = half_space.motion_cast(shape, ChainMotion::new(&seen_from(of_body, motion)), options)?;
        let Outcome::Hit(hit) = cast.outcome else { return Ok(cast) };
        let place = of_body.displacement(hit.time);
        let normal = hit.normal.map(|normal| place.rotation() * normal);
        Ok(MotionCast { outcome: Outcome::Hit(Impact { point: place.of(hit.point), normal, ..hit }), ..cast })
    }
}

/// A motion as seen from something that moves: first by the motion, and then back by that of the observer.
pub(super) fn seen_from<V: Vector>(
    RigidMotion { velocity, angular_velocity, center }: RigidMotion<V>,
    motion: RigidMotion<V>,
) -> [RigidMotion<V>; 3] {
    let turned_back = RigidMotion::rotation(angular_velocity.scaled(-V::Scalar::ONE), center);
    [turned_back, RigidMotion::translation(-velocity), motion]
}
