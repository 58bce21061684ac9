//! Ray casts, distances, contacts and continuous collision detection, of bodies that turn too, for general convex shapes, by
//! the Gilbert–Johnson–Keerthi algorithm (GJK): 2D and 3D, `f32` and `f64`, with certified answers.
//!
//! Shapes are support maps of [`convex_support`]: its primitives, its combinators, or your own.
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
//! - *How far apart are two shapes, and where are they closest?* [`distance`] (GJK, Algorithm 2 of the paper).
//! - *How far apart, or how deep in one another, and which way out?* [`signed_distance`] (GJK, then expanding polytopes).
//! - *In which points do they carry each other?* [`contact`], a manifold of up to four points.
//! - *Do they meet?* [`intersects`], which stops at the first separating axis and can start from the last one.
//! - *Where does a ray enter a shape?* [`ray_cast`] (Algorithm 3).
//! - *Many rays at once?* [`ray_casts`]. Many pairs, into a column? [`map_distances_into`].
//! - *Many bodies?* [`Scene`]: the first hit, the nearest, all within a distance, and pairs.
//! - *Where does a ray leave a shape?* [`ray_exit`].
//! - *When do two shapes meet that move without turning?* [`linear_cast`] (Algorithm 3 on their difference).
//! - *When do two shapes meet that move and turn?* [`motion_cast`], along [rigid motions](RigidMotion), [chains of joints](ChainMotion)
//!   or a [`Trajectory`] of your own.
//! - *And a shape and a floor without an end?* The methods of [`HalfSpace`].
//! - *How does an answer change with a pose, a joint, a velocity?* `gradient()` of [`SignedDistance`], [`LinearHit`], [`MotionHit`], [`RayHit`];
//!   and whether that is smooth, with second derivatives, [`ClosestFeatures`].
//! - *The same from closest points alone:* [`iterative_ray_cast`] (Algorithm 1), for shapes with a closed form.
//! - *What proves an answer?* [`distance_certificate`] and the like: a [`Certificate`] for a checker that trusts nothing.
//!
//! Each has a variant `…_with` that shows an [observer](Iterate) every iterate, and every answer says how it ended
//! ([`Status`]) and carries bounds on the value that come from the geometry: a separating plane below, points of the
//! bodies above.
//!
//! # References
//! Gino van den Bergen, *Ray Casting against General Convex Objects with Application to Continuous Collision
//! Detection*, 2004, referred to as the paper.
//!
//! # Features
//! - `std` (default): floating-point functions from the standard library.
//! - `libm`: the same from the libm crate, for `no_std` targets.
//! - `f64` (default): as of `convex-support`, to be left out with glam 0.32.
//! - `rayon`: batches on all threads, `par_ray_casts`, `Scene::par_ray_casts` and `Among::par_pairs_within`.
//! - `serde`: options, answers and certificates as data, beside the shapes of `convex-support`.
//!
//! # Answers as data
//! With the feature `serde`, what is asked and what is answered can be written and read back, to the last bit, by any format of
//! [serde](https://docs.rs/serde): options, rays, motions and poses, half-spaces and [`Body`]; every answer, [`Certificate`] and derivative.
//! For JSON, `serde_json` needs its feature `float_roundtrip`.
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
//! - An option that is left out has its default, and one that does not exist is an error. As in code, any number may be given, and the
//!   query takes what is below zero for zero where the option says so.
//! - JSON has no infinity. A bound or a limit that is infinite is `null` there: a ray without an end, an upper bound that is not known.
//!   Where a shape's support map returned numbers that are not finite, the answer has points that JSON cannot tell, and is not read back.
//! - Errors can be written and not read, as they name parameters of this crate. Left out are what observers are shown, what a
//!   [`Trajectory`] answers, [`ChainMotion`], whose joints are [`RigidMotion`]s, [`ClosestFeatures`], which an answer and its shapes give
//!   again, and [`Scene`], which is made of its bodies.

#![no_std]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "comparisons are written so that NaN ends the loop they are in")]

extern crate alloc;
#[cfg(any(feature = "std", test))]
extern crate std;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod body;
mod cast;
mod certificate;
mod contact;
mod curvature;
#[cfg(feature = "serde")]
mod data;
mod derivative;
mod distance;
mod distances;
mod double;
mod error;
mod gjk;
mod half_space;
mod intersects;
mod iterative_ray_cast;
mod linear_cast;
mod motion;
mod options;
mod ray;
mod ray_cast;
mod ray_casts;
mod ray_exit;
mod result;
mod scene;
mod segments;
mod shape;
mod simplex;
mod start_in_contact;
mod symmetric;
mod unit;

pub use convex_support;

pub use certificate::{
    Certificate, WeightedSupport, distance_certificate, intersection_certificate, linear_cast_certificate,
    ray_cast_certificate,
};
pub use contact::{
    Contact, ContactPoint, SignedDistance, SignedDistanceOptions, contact, signed_distance, signed_distance_with,
};
pub use derivative::{
    ClosestFeatures, ClosestVelocities, LinearCastGradient, MotionCastGradient, MotionGradient, MotionHessian,
    PairGradient, PairHessian, RayCastGradient, RigidMotionGradient, Smoothness,
};
pub use distance::{distance, distance_with};
pub use distances::map_distances_into;
pub use error::RayCastError;
pub use half_space::HalfSpace;
pub use intersects::{intersects, intersects_with};
pub use iterative_ray_cast::{iterative_ray_cast, iterative_ray_cast_with};
pub use linear_cast::{Motion, linear_cast, linear_cast_with};
pub use motion::{
    ChainMotion, Displacement, MotionCast, MotionCastOptions, MotionHit, MotionIterate, MovingBall, Pose, RigidMotion,
    Trajectory, TurningPlane, motion_cast, motion_cast_with,
};
pub use options::{CastMethod, DistanceOptions, IntersectOptions, LinearCastOptions, RayCastOptions, StartInContact};
pub use ray::Ray;
pub use ray_cast::{ray_cast, ray_cast_with};
#[cfg(feature = "rayon")]
pub use ray_casts::par_ray_casts;
pub use ray_casts::ray_casts;
pub use ray_exit::ray_exit;
pub use result::{
    Distance, Intersection, Iterate, LinearCast, LinearHit, Miss, Outcome, RayCast, RayExit, RayHit, Status,
};
pub use scene::{
    Among, Body, BodyDistance, BodyHit, PairDistance, Scene, SceneAnyHit, SceneCast, SceneDistance, SceneError,
    SceneHits, SceneLinearCast, SceneMotionCast, SceneRayCast, Work,
};
pub use simplex::SubAlgorithm;
