//! Ray casts, distances, contacts and continuous collision detection for convex shapes of any kind, which may move
//! and turn, by the Gilbert–Johnson–Keerthi algorithm (GJK): 2D and 3D, `f32` and `f64`, with certified answers.
//!
#![doc = include_str!("../doc/ray.svg")]
//!
//! Shapes are support maps of [`convex_support`]: its primitives, its combinators, or your own. That crate is
//! exported as [`gjk_raycast::convex_support`](convex_support), and glam as `gjk_raycast::convex_support::glam`.
//!
//! ```
//! use convex_support::{Cuboid, Posed, glam::DVec3};
//! use gjk_raycast::{LinearCastOptions, Motion, linear_cast};
//!
//! // A box moves at 10 m/s towards a wall whose face is at x = 9.9. When does it arrive?
//! let parcel = Cuboid::new(DVec3::splat(0.5))?;
//! let wall =
//!     Posed::translated(Cuboid::new(DVec3::new(0.1, 5.0, 5.0))?, DVec3::new(10.0, 0.0, 0.0))?;
//! let motion = Motion { velocity_a: DVec3::new(10.0, 0.0, 0.0), velocity_b: DVec3::ZERO };
//!
//! let cast = linear_cast(&parcel, &wall, motion, LinearCastOptions::default())?;
//! let hit = cast.outcome.hit().ok_or("it arrives")?;
//! assert!((hit.time - 0.94).abs() < 1e-15);
//! assert_eq!(hit.normal, Some(DVec3::NEG_X)); // out of the wall, towards the parcel
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Questions it answers
//! About two shapes:
//! - *How far apart are they, and which points are closest?* [`distance`] (GJK, Algorithm 2 of the paper).
//! - *If they overlap, how deep, and which way out is shortest?* [`signed_distance`] (GJK, then an expanding
//!   polytope).
//! - *In which points do they support each other?* [`contact`], a manifold of up to four points.
//! - *Do they meet?* [`intersects`], which stops at the first separating axis and can start from the last one.
//! - *When do they meet, moving without turning?* [`linear_cast`], a ray cast at their difference.
//! - *When do they meet, moving and turning?* [`motion_cast`], along [rigid motions](RigidMotion), [chains of
//!   joints](ChainMotion) or a [`Trajectory`] of your own.
//! - *By how much do they have to grow, each about a centre, until they touch?* [`growth_distance`], one smooth number
//!   for gaps and overlaps.
//! - *How near do they come on the way, when and where?* [`motion_clearance`].
//! - *How far may one of them go before its distance has to be asked for again?* [`Distance::free_step`].
//! - *The same questions about a shape and an infinite floor or wall:* the methods of [`HalfSpace`].
//!
//! About a robot:
//! - *Is it free at these joint values? How near does it come, and which joint helps?* [`Linkage::is_free`],
//!   [`Linkage::clearance`].
//! - *Is its path free, at every time, and what does it meet first?* [`Linkage::path`].
//! - *The same along a spline?* [`Linkage::path_along`], with a [`JointTrajectory`] that you implement.
//! - *How near does it come to anything on the way, when, and with which link?* [`Linkage::path_clearance`].
//! - *Do two of its links ever meet, at any positions of the joints?* [`Linkage::joint_box`].
//!
//! About a ray and a shape:
//! - *Where does the ray enter?* [`ray_cast`], and [`ray_casts`] for many rays: a closed form, a portal, or Algorithm 3
//!   of the paper, see [`CastMethod`]. *Where does it leave?* [`ray_exit`].
//! - *Where do many rays enter?* [`ray_entries_into`] writes numbers into a slice, for several rays at a time if the
//!   shape has a closed form.
//! - *The same from closest points alone:* [`iterative_ray_cast`] (Algorithm 1), for shapes whose closest points have
//!   a closed form.
//!
//! About many shapes:
//! - *Which is hit first, which is nearest, which are within a distance, which pairs are near each other, and in which
//!   points do they touch?* [`Scene`]; for many rays at once [`Among::ray_casts_into`].
//! - *How far apart is each of many pairs?* [`map_distances_into`] writes one number of each answer into a slice.
//!
//! About an answer:
//! - *How does it change with a pose, a joint, a velocity?* `gradient` of [`Distance`], [`SignedDistance`],
//!   [`GrowthDistance`], [`Impact`] and [`RayHit`]. [`ClosestFeatures`] tells whether the derivative is unique, and has
//!   second derivatives.
//! - *What proves it?* [`distance_certificate`] and its like: a [`Certificate`] for a checker that trusts nothing
//!   else.
//!
//! Every answer says how the iteration ended ([`Status`]). Every distance, depth, λ and time has a lower and an upper
//! bound from the geometry: one from a separating plane, the other from points of the bodies.
//! [`Outcome`] tells a hit, a miss and an undecided cast apart. If a program has to choose, it is safe to treat an
//! undecided cast as a hit at its lower bound. The iterative functions have a variant `…_with` that shows an
//! [observer](Iterate) every iterate.
//!
//! # References
//! Gino van den Bergen, *Ray Casting against General Convex Objects with Application to Continuous Collision
//! Detection*, 2004, is called the paper.
//!
//! # Features
//! - `std` (default): square roots and the like by the processor's instructions; without it by the libm crate, for
//!   `no_std` targets, to the same bits. With it a thread keeps what its deepest query has allocated, so
//!   that the next ones allocate nothing.
//! - `alloc` (with `std`): all questions but [`intersects`], [`distance`], [`ray_cast`], [`ray_exit`] and
//!   [`iterative_ray_cast`]; without it no allocator is needed.
//! - `f64` (default): asks glam for double precision; with glam 0.32, which has no such feature, turn on `glam-032`
//!   instead.
//! - `rayon`: `par_ray_casts`, `Among::par_ray_casts`, `Among::par_pairs_within`, `Among::par_contacts_within` and
//!   `Linkage::par_paths`, which use all threads.
//! - `simd`: [`ray_entries_into`] uses the widest vector instructions of the processor, found at run time by pulp.
//!   The answers are the same.
//! - `paper`: Algorithms 1 to 3 as the paper prints them (module `paper`), and its sub-algorithm and two others beside
//!   the default ([`SubAlgorithm`]).
//! - `hull`, `mint`, `bytemuck`, `approx`, `parry2d`, `parry2d-f64`, `parry3d`, `parry3d-f64`, `proptest`: the
//!   features of [`convex_support`] with these names, for its shapes.
//! - `laws`: what answers say of themselves, as laws that hold for any shapes; with `proptest` as property tests too.
//! - `serde`: options, answers and certificates as data, beside the shapes of `convex-support`.
//!
//! # Answers as data
//! With the feature `serde`, questions and answers can be written in any format of [serde](https://docs.rs/serde) and
//! read back to the last bit: options, rays, motions and poses, half-spaces and [`Body`]; every answer,
//! [`Certificate`] and derivative. For JSON, `serde_json` needs its feature `float_roundtrip`.
//!
//! ```
//! # #[cfg(feature = "serde")] {
//! use convex_support::{Ball, Posed, glam::DVec3};
//! use gjk_raycast::{Ray, RayCast, RayCastOptions, ray_cast};
//!
//! let target = Posed::translated(Ball::new(2.0)?, DVec3::new(10.0, 0.0, 0.0))?;
//! let options = serde_json::from_str(r#"{"max_lambda": 100.0}"#)?; // the others are the defaults
//! let ray = Ray { source: DVec3::ZERO, direction: DVec3::X };
//! let answer = ray_cast(&target, ray, options)?;
//!
//! let saved = serde_json::to_string(&answer)?;
//! assert!(saved.starts_with(r#"{"outcome":{"Hit":{"lambda":8.0,"#));
//! let read: RayCast<DVec3> = serde_json::from_str(&saved)?;
//! assert_eq!(read, answer);
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - An option that is left out has its default, and an unknown option is an error. As in code, an option may have
//!   any value; where its documentation says so, the query takes a negative number for zero.
//! - JSON has no infinity. An infinite bound or limit is `null` there, such as the end of a ray that has none, or an
//!   unknown upper bound. If the support map of a shape returned numbers that are not finite, the answer may have
//!   coordinates that JSON cannot hold, and then it cannot be read back.
//! - Errors can be written but not read, as they name parameters of this crate. Some types cannot be written: the
//!   iterates that observers see; the answers of a [`Trajectory`]; [`ChainMotion`], which borrows its
//!   [`RigidMotion`]s; [`ClosestFeatures`], which can be found again from an answer and its shapes; [`Scene`], which
//!   can be built again from its bodies; and [`Linkage`], with its parts, its questions and its answers.

#![no_std]
#![forbid(unsafe_code)]
// On docs.rs, each item says which feature it needs.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
// Questions that need an allocator share much with the others.
#![cfg_attr(not(feature = "alloc"), allow(dead_code, unused_imports, reason = "some questions are left out"))]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "comparisons are written so that NaN ends the loop they are in")]

#[cfg(any(feature = "alloc", test))]
extern crate alloc;
#[cfg(any(feature = "std", test))]
extern crate std;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod body;
mod boxes;
mod cast;
#[cfg(feature = "alloc")]
pub mod certificate;
#[cfg(feature = "alloc")]
mod contact;
mod curvature;
#[cfg(feature = "serde")]
mod data;
#[cfg(feature = "alloc")]
pub mod derivative;
mod distance;
mod gjk;
#[cfg(feature = "alloc")]
mod growth_distance;
#[cfg(feature = "alloc")]
mod half_space;
mod intersects;
mod iterative_ray_cast;
#[cfg(feature = "laws")]
pub mod laws;
#[cfg(feature = "alloc")]
mod linear_cast;
#[cfg(feature = "alloc")]
pub mod linkage;
#[cfg(feature = "alloc")]
pub mod motion;
mod observer;
mod options;
mod outcome;
mod pair;
mod pair_gradient;
#[cfg(feature = "paper")]
pub mod paper;
mod ray;
mod ray_cast;
#[cfg(feature = "alloc")]
mod ray_casts;
mod ray_exit;
#[cfg(feature = "alloc")]
pub mod scene;
mod segments;
mod separation;
#[cfg(feature = "alloc")]
mod signed_distance;
mod simplex;
#[cfg(feature = "alloc")]
mod start_in_contact;
mod symmetric;
mod unit;
mod warm_start;

// What the public modules have is at the root as well, and shown in its module alone: the first page stays short.
// `tests/names.rs` says that it is all here.
pub use convex_support;
pub use convex_support::{MotionGradient, MotionHessian};

#[cfg(feature = "alloc")]
#[doc(hidden)]
pub use certificate::{
    Certificate, WeightedSupport, distance_certificate, growth_distance_certificate, intersection_certificate,
    linear_cast_certificate, ray_cast_certificate,
};
#[cfg(feature = "alloc")]
pub use contact::{Contact, ContactPoint, contact, contact_after};
#[cfg(feature = "alloc")]
#[doc(hidden)]
pub use derivative::{
    ClosestFeatures, ClosestVelocities, GrowthGradient, ImpactGradient, PairHessian, RayCastGradient,
    RigidMotionGradient, Smoothness,
};
pub use distance::{DistanceOptions, FreeStep, distance, distance_with, map_distances_into};
#[cfg(feature = "alloc")]
pub use growth_distance::{GrowthDistance, GrowthError, GrowthOptions, growth_distance};
#[cfg(feature = "alloc")]
pub use half_space::HalfSpace;
pub use intersects::{IntersectOptions, Intersection, intersects, intersects_with};
pub use iterative_ray_cast::{iterative_ray_cast, iterative_ray_cast_with};
#[cfg(feature = "alloc")]
pub use linear_cast::{LinearCast, LinearCastOptions, Motion, linear_cast, linear_cast_with};
#[cfg(feature = "alloc")]
#[doc(hidden)]
pub use linkage::{
    BodyPair, ConfigurationWorkspace, FaceStop, FreeBox, FreeInterval, GrownBox, Joint, JointBounds, JointBox,
    JointBoxOutcome, JointKind, JointState, JointTrajectory, Link, LinkClearance, LinkFrame, Linkage, LinkageError,
    Met, NearestOnPath, Path, PathClearance, PathContact, PathWorkspace,
};
#[cfg(feature = "alloc")]
#[doc(hidden)]
pub use motion::{
    ChainMotion, Displacement, MotionCast, MotionCastOptions, MotionClearance, MotionClearanceOptions, MotionIterate,
    MovingBall, Pose, RigidMotion, Trajectory, TurningPlane, motion_cast, motion_cast_with, motion_clearance,
    motion_clearance_with,
};
pub use observer::{Iterate, Status};
pub use outcome::{Cast, Impact, Miss, Outcome, RayCastError, StartInContact};
pub use pair_gradient::PairGradient;
pub use ray::{CastMethod, Ray, RayCast, RayCastOptions, RayHit};
pub use ray_cast::{ray_cast, ray_cast_with};
#[cfg(feature = "alloc")]
pub use ray_casts::{RayEntry, ray_casts, ray_entries_into};
#[cfg(feature = "rayon")]
pub use ray_casts::{par_ray_casts, par_ray_entries_into};
pub use ray_exit::{RayExit, ray_exit};
#[cfg(feature = "alloc")]
#[doc(hidden)]
pub use scene::{
    Among, Body, BodyContact, BodyDistance, BodyHandle, BodyHit, BodySignedDistance, Group, Instance, PairContact,
    PairDistance, PairImpact, Scene, SceneAnyHit, SceneAnyWithin, SceneCast, SceneDistance, SceneError,
    SceneFirstContact, SceneHits, SceneLinearCast, SceneMotionCast, ScenePair, SceneRayCast, SceneSignedDistance, Work,
};
pub use separation::{Distance, SignedDistance, SignedDistanceOptions};
#[cfg(feature = "alloc")]
pub use signed_distance::{signed_distance, signed_distance_with};
pub use simplex::SubAlgorithm;
pub use warm_start::WarmStart;
