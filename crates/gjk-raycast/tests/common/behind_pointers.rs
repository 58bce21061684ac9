//! The queries asked of shapes behind pointers, by the names and with the answers of their own.
//!
//! What is inlined for every pair of shapes takes seconds to compile, pair by pair. Behind pointers each query is
//! compiled once for a vector, and a test asks of as many kinds of shapes as it likes.

use convex_support::{SupportMap, Vector};
use gjk_raycast::{
    Distance, DistanceOptions, IntersectOptions, Intersection, LinearCast, LinearCastOptions, Motion, MotionCast,
    MotionCastOptions, Ray, RayCast, RayCastError, RayCastOptions, RayExit, SignedDistance, SignedDistanceOptions,
    Trajectory,
};

type Shape<'s, V> = &'s dyn SupportMap<Vector = V>;

pub(crate) fn ray_cast<S: SupportMap>(
    target: &S,
    ray: Ray<S::Vector>,
    options: RayCastOptions<S::Vector>,
) -> Result<RayCast<S::Vector>, RayCastError> {
    let target: Shape<'_, S::Vector> = target;
    gjk_raycast::ray_cast(target, ray, options)
}

pub(crate) fn ray_exit<S: SupportMap>(
    target: &S,
    ray: Ray<S::Vector>,
    options: RayCastOptions<S::Vector>,
) -> Result<RayExit<S::Vector>, RayCastError> {
    let target: Shape<'_, S::Vector> = target;
    gjk_raycast::ray_exit(target, ray, options)
}

pub(crate) fn linear_cast<A: SupportMap, B: SupportMap<Vector = A::Vector>>(
    a: &A,
    b: &B,
    motion: Motion<A::Vector>,
    options: LinearCastOptions<A::Vector>,
) -> Result<LinearCast<A::Vector>, RayCastError> {
    let [a, b] = pointers(a, b);
    gjk_raycast::linear_cast(a, b, motion, options)
}

pub(crate) fn motion_cast<A: SupportMap, B: SupportMap<Vector = A::Vector>>(
    a: &A,
    motion_a: impl Trajectory<Vector = A::Vector>,
    b: &B,
    motion_b: impl Trajectory<Vector = A::Vector>,
    options: MotionCastOptions<A::Vector>,
) -> Result<MotionCast<A::Vector>, RayCastError> {
    let [a, b] = pointers(a, b);
    gjk_raycast::motion_cast(a, motion_a, b, motion_b, options)
}

pub(crate) fn distance<A: SupportMap, B: SupportMap<Vector = A::Vector>>(
    a: &A,
    b: &B,
    options: DistanceOptions<A::Vector>,
) -> Distance<A::Vector> {
    let [a, b] = pointers(a, b);
    gjk_raycast::distance(a, b, options)
}

pub(crate) fn signed_distance<A: SupportMap, B: SupportMap<Vector = A::Vector>>(
    a: &A,
    b: &B,
    options: SignedDistanceOptions<A::Vector>,
) -> SignedDistance<A::Vector> {
    let [a, b] = pointers(a, b);
    gjk_raycast::signed_distance(a, b, options)
}

pub(crate) fn intersects<A: SupportMap, B: SupportMap<Vector = A::Vector>>(
    a: &A,
    b: &B,
    options: IntersectOptions<A::Vector>,
) -> Intersection<A::Vector> {
    let [a, b] = pointers(a, b);
    gjk_raycast::intersects(a, b, options)
}

fn pointers<'s, V: Vector>(
    a: &'s impl SupportMap<Vector = V>,
    b: &'s impl SupportMap<Vector = V>,
) -> [Shape<'s, V>; 2] {
    [a, b]
}
