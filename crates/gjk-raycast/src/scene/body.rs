//! A body of a scene, and its single queries.

use convex_support::{AngularVelocity as _, Scalar as _, ScalarOf, SupportMap, Vector};

use crate::motion::{ProvedSteps, clearance_within};
use crate::{
    ChainMotion, Contact, Distance, DistanceOptions, HalfSpace, Impact, LinearCast, LinearCastOptions, Motion,
    MotionCast, MotionCastOptions, MotionClearance, MotionClearanceOptions, MotionIterate, Ray, RayCast, RayCastError,
    RayCastOptions, RigidMotion, SignedDistance, SignedDistanceOptions, Trajectory, contact, distance, linear_cast,
    motion_cast_with, motion_clearance, ray_cast, signed_distance,
};

/// A body of a [`Scene`](crate::Scene): a bounded shape, or a half-space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "S: serde::Serialize, HalfSpace<S::Vector>: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "S: serde::Deserialize<'de>, HalfSpace<S::Vector>: serde::Deserialize<'de>"))
)]
pub enum Body<S: SupportMap> {
    /// A bounded convex body.
    Convex(S),
    /// All on one side of a plane.
    HalfSpace(HalfSpace<S::Vector>),
}

impl<S: SupportMap> Body<S> {
    /// The bounded body, if it is one.
    #[must_use]
    pub fn convex(&self) -> Option<&S> {
        match self {
            Self::Convex(body) => Some(body),
            Self::HalfSpace(_) => None,
        }
    }

    #[inline]
    pub(super) fn distance_from<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: DistanceOptions<S::Vector>,
    ) -> Distance<S::Vector> {
        match self {
            Self::Convex(body) => distance(shape, body, options),
            Self::HalfSpace(half_space) => half_space.distance_from(shape),
        }
    }

    /// The distance of a shape, `a`, from this body, `b`, or minus its depth, by
    /// [`signed_distance`](crate::signed_distance()) or, for a half-space, by
    /// [`HalfSpace::signed_distance`](crate::HalfSpace::signed_distance), which needs no options.
    pub fn signed_distance<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        options: SignedDistanceOptions<S::Vector>,
    ) -> SignedDistance<S::Vector> {
        match self {
            Self::Convex(body) => signed_distance(shape, body, options),
            Self::HalfSpace(half_space) => half_space.signed_distance(shape),
        }
    }

    /// The contact of a shape, `a`, with this body, `b`, by [`contact`](crate::contact()) or, for a half-space, by
    /// [`HalfSpace::contact`](crate::HalfSpace::contact), which needs no options; `None` if they are farther apart than
    /// `within`. [`Among::contacts_of`](crate::Among::contacts_of) does this for all bodies that are near.
    pub fn contact<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        within: ScalarOf<S>,
        options: SignedDistanceOptions<S::Vector>,
    ) -> Option<Contact<S::Vector>> {
        match self {
            Self::Convex(body) => contact(shape, body, within, options),
            Self::HalfSpace(half_space) => half_space.contact(shape, within),
        }
    }

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

    /// The least distance of a shape, `a`, and this body, `b`, as both move, by
    /// [`motion_clearance`](crate::motion_clearance()); the body may be a half-space.
    ///
    /// # Errors
    /// Those of [`motion_clearance`](crate::motion_clearance()).
    pub fn motion_clearance_of_both<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: RigidMotion<S::Vector>,
        of_body: RigidMotion<S::Vector>,
        options: MotionClearanceOptions<S::Vector>,
    ) -> Result<MotionClearance<S::Vector>, RayCastError> {
        let half_space = match self {
            Self::Convex(body) => return motion_clearance(shape, motion, body, of_body, options),
            Self::HalfSpace(half_space) => half_space,
        };
        let ask = |motion: &dyn Trajectory<Vector = _>| half_space.motion_clearance(shape, motion, options);
        in_frame(of_body, motion, ask, |least| {
            let place = of_body.displacement(least.time);
            let [point_a, point_b] = [least.point_a, least.point_b].map(|point| place.of(point));
            let normal = least.normal.map(|normal| place.rotation() * normal);
            MotionClearance { point_a, point_b, normal, ..least }
        })
    }

    /// The least distance of a shape that moves and turns from this body, which is at rest, as far as it is less than a
    /// limit.
    pub(crate) fn clearance_within<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: &impl Trajectory<Vector = S::Vector>,
        options: MotionClearanceOptions<S::Vector>,
        limit: ScalarOf<S>,
    ) -> Result<MotionClearance<S::Vector>, RayCastError> {
        match self {
            Self::Convex(body) => clearance_within(shape, motion, body, RigidMotion::default(), options, limit, |_| {}),
            Self::HalfSpace(half_space) => half_space.clearance_within(shape, motion, options, limit, |_| {}),
        }
    }

    /// The cast of a shape, `a`, and this body, `b`, as both move, by [`motion_cast`](crate::motion_cast()); the body
    /// may be a half-space.
    ///
    /// # Errors
    /// Those of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast_of_both<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: RigidMotion<S::Vector>,
        of_body: RigidMotion<S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<MotionCast<S::Vector>, RayCastError> {
        self.watched_cast_of_both(shape, motion, of_body, options, |_| {})
    }

    /// [`motion_cast_of_both`](Self::motion_cast_of_both) with an observer that sees its proof: times between which one
    /// plane keeps the two apart, by more than the target distance, and its normals at both, as those of a
    /// [`FreeInterval`](crate::FreeInterval). They are in the world or, of a half-space, as it sees them. If the cast
    /// misses, they cover all of the time.
    ///
    /// # Errors
    /// Those of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast_of_both_with<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: RigidMotion<S::Vector>,
        of_body: RigidMotion<S::Vector>,
        options: MotionCastOptions<S::Vector>,
        mut observer: impl FnMut([ScalarOf<S>; 2], [S::Vector; 2]),
    ) -> Result<MotionCast<S::Vector>, RayCastError> {
        let mut steps = ProvedSteps::NONE;
        let see = |there: MotionIterate<S::Vector>| steps.see(&there, &mut observer);
        let cast = self.watched_cast_of_both(shape, motion, of_body, options, see)?;
        steps.end(&cast, observer);
        Ok(cast)
    }

    fn watched_cast_of_both<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: RigidMotion<S::Vector>,
        of_body: RigidMotion<S::Vector>,
        options: MotionCastOptions<S::Vector>,
        observer: impl FnMut(MotionIterate<S::Vector>),
    ) -> Result<MotionCast<S::Vector>, RayCastError> {
        let half_space = match self {
            Self::Convex(body) => return motion_cast_with(shape, motion, body, of_body, options, observer),
            Self::HalfSpace(half_space) => half_space,
        };
        let ask = |motion: &dyn Trajectory<Vector = _>| half_space.motion_cast_with(shape, motion, options, observer);
        in_frame(of_body, motion, ask, |cast| {
            let outcome = cast.outcome.map(|hit| {
                let place = of_body.displacement(hit.time);
                let normal = hit.normal.map(|normal| place.rotation() * normal);
                Impact { point: place.of(hit.point), normal, ..hit }
            });
            MotionCast { outcome, ..cast }
        })
    }
}

/// Asks about a motion as a moving frame sees it, and brings the answer back to the world. A frame at rest is the
/// world.
fn in_frame<V: Vector, R>(
    of_frame: RigidMotion<V>,
    motion: RigidMotion<V>,
    ask: impl FnOnce(&dyn Trajectory<Vector = V>) -> Result<R, RayCastError>,
    back: impl FnOnce(R) -> R,
) -> Result<R, RayCastError> {
    if of_frame == RigidMotion::default() {
        return ask(&motion);
    }
    ask(&ChainMotion::new(&seen_from(of_frame, motion))).map(back)
}

/// A motion relative to a moving frame: first the motion, and then the inverse of the frame's.
pub(super) fn seen_from<V: Vector>(
    RigidMotion { velocity, angular_velocity, center }: RigidMotion<V>,
    motion: RigidMotion<V>,
) -> [RigidMotion<V>; 3] {
    let turned_back = RigidMotion::rotation(angular_velocity.scaled(-V::Scalar::ONE), center);
    [turned_back, RigidMotion::translation(-velocity), motion]
}
