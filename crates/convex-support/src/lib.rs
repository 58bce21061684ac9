//! Convex shapes as support maps, for collision detection, ray casting and motion planning: 2D and 3D, `f32` and `f64`,
//! on [glam](https://docs.rs/glam)'s vectors.
//!
#![doc = include_str!("../doc/support.svg")]
//!
//! A convex shape is described by one function, its [support mapping](SupportMap): which of its points lies farthest
//! along a given direction. This function is enough for ray casts, distances and continuous collision detection. It
//! also composes: the Minkowski sum, the difference (the configuration space obstacle), the hull, a pose, an affine
//! map and rounding each take a few lines, given the support mappings of their parts.
//!
//! ```
//! use convex_support::{Ball, Cuboid, Difference, Posed, glam::DVec3, support_value};
//!
//! // A ball of radius 0.5 touches a box where its centre is on the surface of their difference.
//! let wall = Cuboid::new(DVec3::new(1.0, 4.0, 4.0))?;
//! let wall = Posed::translated(wall, DVec3::new(10.0, 0.0, 0.0))?;
//! let ball = Ball::new(0.5)?;
//! let obstacle = Difference::new(wall, ball);
//! // From the left, the centre stops at x = 8.5.
//! assert_eq!(support_value(&obstacle, DVec3::NEG_X), -8.5);
//! # Ok::<(), convex_support::InvalidShape>(())
//! ```
//!
//! # What is here
//! - Shapes in 2D and 3D: [`Point`], [`Segment`], [`Triangle`], [`Ball`], [`Cuboid`], [`Capsule`], [`Ellipsoid`],
//!   [`Polytope`]; in 3D also [`Cylinder`] and [`Cone`].
//! - Combinators, which make shapes of shapes: [`Posed`], [`Affine`], [`MinkowskiSum`], [`Difference`], [`Hull`],
//!   [`Rounded`]. They can be nested, and take shapes by value, by reference, or boxed as
//!   `Box<dyn SupportMap<Vector = DVec3>>`.
//! - Functions of every shape: [`bounding_box`], [`bounding_sphere`], [`outer_box`]; and of shapes with a closed
//!   form: [`closest_point`], [`line_crossing`].
//! - The traits: [`SupportMap`], to be implemented for shapes of your own; and [`Vector`], [`Rotation`] and
//!   [`Scalar`], which glam's types implement.
//! - A tree of boxes, [`Bvh`], for questions about many shapes.
//!
//! Constructors check their numbers and return [`InvalidShape`] if one is wrong; after that, support mappings never
//! fail.
//!
//! # Features
//! - `std` (default): square roots and the like by the processor's instructions; without it by the libm crate, for
//!   `no_std` targets, to the same bits.
//! - `alloc` (with `std`): [`Polytope`], [`Bvh`], and shapes behind `Box`, `Rc` and `Arc`. Without it no allocator is
//!   needed.
//! - `f64` (default): asks glam for double precision; with glam 0.32, which has no such feature, turn on `glam-032`
//!   instead.
//! - `hull`: `Polytope::hull_of`, the exact convex hull of raw points, for polytopes of thousands of vertices; and
//!   `Faceted`, a hull with its half-spaces.
//! - `serde`: shapes, boxes, spheres and crossings as data, checked as they are read. Errors can be written but not
//!   read.
//! - `parry2d`, `parry2d-f64`, `parry3d`, `parry3d-f64`: conversions of parry's shapes to shapes of this crate and
//!   back, and of its compounds and meshes to their convex pieces.
//! - `mint`, `bytemuck`, `approx`: the features of glam with these names, for its vectors: conversions from and to
//!   mint's, as bytes for buffers of a GPU, and comparison up to a tolerance.
//! - `simd`: loops over many lines, or many pairs of ellipsoids, use the widest vector instructions of the processor,
//!   found at run time by pulp. The answers are the same. The crates that depend on this one have a feature of the
//!   same name.
//! - `proptest`: for property tests, the module `laws`, which tests a shape of your own, and the module `strategies`,
//!   which generates shapes and poses of wild aspect and scale.

#![no_std]
#![forbid(unsafe_code)]
// On docs.rs, each item says which feature it needs.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

#[cfg(not(any(feature = "f64", feature = "glam-032")))]
compile_error!(
    "convex-support needs double precision: turn on the feature `f64` of the crate that your Cargo.toml names, \
     convex-support or one that is written over it; it is on by default. A program that is held to glam 0.32, which \
     has no such feature, turns on `glam-032` instead, and runs `cargo update --package glam@0.34 --precise 0.32.1`"
);

#[cfg(any(feature = "alloc", test))]
extern crate alloc;
#[cfg(any(feature = "std", test))]
extern crate std;

mod angular_velocity;
mod ball_support;
mod bounds;
#[cfg(feature = "alloc")]
pub mod bvh;
mod closest_point;
mod combinators;
mod compiled_once;
mod core_set;
mod error;
mod forward;
mod hint;
#[cfg(any(feature = "parry2d", feature = "parry2d-f64", feature = "parry3d", feature = "parry3d-f64"))]
mod interop_parry;
#[cfg(feature = "serde")]
mod interop_serde;
#[cfg(feature = "proptest")]
pub mod laws;
mod line_crossing;
mod motion_derivative;
#[doc(hidden)]
pub mod numerics;
mod parallelotope;
mod rotation;
mod scalar;
mod sealed;
mod shapes;
#[cfg(feature = "proptest")]
#[allow(clippy::disallowed_methods, reason = "random shapes need not be the same everywhere")]
pub mod strategies;
mod support;
mod support_feature;
mod vector;

pub use glam;

pub use bounds::{Aabb, BoundingSphere, bounding_box, bounding_sphere};
// All of it is at the root as well, and shown in its module alone: the first page stays short.
#[cfg(feature = "alloc")]
#[doc(hidden)]
pub use bvh::{
    Bound, BoxDistance, Boxes, Bvh, CoarseBound, CoarseBoxDistance, CoarseSweptBox, CoarseUnit, Frame, NearestPairs,
    PairSearch, SweptBox, WIDTH, outer_box,
};
pub use closest_point::closest_point;
pub use combinators::{Affine, Difference, Hull, MinkowskiSum, Posed, Rounded};
#[doc(hidden)]
pub use compiled_once::of_vectors;
pub use core_set::{Core, CoreKind, Rounding};
pub use error::InvalidShape;
pub use hint::Hint;
#[cfg(feature = "parry2d")]
pub use interop_parry::parry2d;
#[cfg(feature = "parry2d-f64")]
pub use interop_parry::parry2d_f64;
#[cfg(feature = "parry3d")]
pub use interop_parry::parry3d;
#[cfg(feature = "parry3d-f64")]
pub use interop_parry::parry3d_f64;
pub use line_crossing::crossed_by_line::{CrossedByLine, line_crossing};
#[doc(hidden)]
pub use line_crossing::lanes::{LINES, Lines};
pub use line_crossing::{CertainCrossing, Crossing, LineCrossing, LineQuery};
#[doc(hidden)]
pub use line_crossing::{Close, CloseLine};
pub use motion_derivative::{MotionGradient, MotionHessian};
pub use parallelotope::Parallelotope;
pub use scalar::Scalar;
#[cfg(feature = "hull")]
pub use shapes::Faceted;
#[cfg(feature = "alloc")]
pub use shapes::Polytope;
pub use shapes::triangle_point::TriangleFeature;
pub use shapes::{Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Point, Segment, Triangle};
pub use support::{ScalarOf, SupportMap, support_value};
pub use support_feature::{Feature, Rim};
pub use vector::{AngularVelocity, Matrix, Rotation, Spin, Vector, Vector3};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
