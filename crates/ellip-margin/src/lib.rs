//! The free margin of ellipsoids: how far a robot's link is from an obstacle, and in which direction this distance
//! grows; in 2D and 3D, `f32` and `f64`, on [glam](https://docs.rs/glam)'s vectors.
//!
#![doc = include_str!("../doc/margin.svg")]
//!
//! The margin `m` of E₁ about E₂ says how much E₁ has to grow about its own centre to touch E₂: by the factor √(1 +
//! m) (Rimon and Boyd, *Obstacle collision detection using best ellipsoid fit*, 1997). It is positive where they are
//! disjoint, 0 where they touch, negative where they overlap, and continuously differentiable throughout. It is −1 if
//! the centre of E₁ lies in E₂.
//!
//! ```
//! use ellip_margin::convex_support::{Ellipsoid, glam::DVec2};
//! use ellip_margin::{EllipsoidPair, MarginOptions};
//!
//! // May this link move up? The obstacle is above it.
//! let link = Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 0.5), 0.0)?;
//! let obstacle = Ellipsoid::new(DVec2::new(1.0, 2.0), DVec2::new(1.0, 0.5), 0.7)?;
//! let m = EllipsoidPair::new(&link, &obstacle, MarginOptions::default()).margin();
//! assert!(m.margin > 0.0 && m.gradient().translation.y < 0.0);
//! # Ok::<(), convex_support::InvalidShape>(())
//! ```
//!
//! # One pair
//! - [`free_margin`]: the margin, its multiplier and the nearest point; [`free_margin_with`] shows an observer each
//!   iterate.
//! - [`distance`]: the Euclidean distance, between certified bounds; [`distance_bracket`]: only bounds, in less time.
//! - [`scaling`]: the common scale at which the two touch if both are scaled about their own centres. It is symmetric,
//!   and has a slope at any depth of overlap.
//! - [`EllipsoidPair`]: these three with their derivatives. Each answer has `gradient` and `hessian` by the motion of
//!   the first body, and `gradient_of_second` and `hessian_of_second` by that of the second.
//!
//! # Many pairs
//! - [`free_margins`] computes margins side by side in vector registers, and [`map_margins_into`] writes one number of
//!   each into a slice; [`map_margins`] and [`map_pairs`] give each answer to a closure.
//!
//! # Along a motion
//! - [`MarginTracker`] follows one pair.
//! - [`Clearance`] finds the least margin of many links about many obstacles; [`clearance`] finds the same by solving
//!   all pairs.
//!
//! # The paper's own methods, corrected
//! - With the feature `paper`: `paper::free_margin_eigen`, `paper::InverseIterationTracker`,
//!   `paper::eigenvalue_gradient`.
//!
//! # Features
//! - `std` (default): square roots and the like by the processor's instructions; without it by the libm crate, for
//!   `no_std` targets with `alloc`, to the same bits.
//! - `f64` (default): asks glam for double precision; with glam 0.32, which has no such feature, turn on `glam-032`
//!   instead.
//! - `hull`, `mint`, `bytemuck`, `approx`, `parry2d`, `parry2d-f64`, `parry3d`, `parry3d-f64`, `proptest`: the
//!   features of [`convex_support`] with these names, for its shapes.
//! - `paper`: the paper's own methods, with eigenvalues by faer.
//! - `rayon`: [`free_margins`] and [`clearance`] use all cores. The answers are the same to the last bit.
//! - `serde`: options, answers, derivatives and trackers as data, beside convex-support's shapes. An option that is
//!   left out has its default. Errors can be written but not read. [`EllipsoidPair`] and [`Answer`] cannot be
//!   written, since they can be built again from their ellipsoids; nor can [`Clearance`], since its bounds are only
//!   right if its own steps computed them.
//! - `simd`: batches use the widest vector instructions of the processor, found at run time by pulp. The answers are
//!   the same.

#![no_std]
#![forbid(unsafe_code)]
// On docs.rs, each item says which feature it needs.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![allow(clippy::needless_range_loop, reason = "the formulas of this crate index several small arrays at once")]
#![allow(clippy::doc_markdown, reason = "formulas are not code")]

extern crate alloc;
#[cfg(any(feature = "std", test))]
extern crate std;

/// Calls a function of the vector type and of the dimension as a number.
macro_rules! in_dimension {
    ($function:ident::<$V:ident>($($argument:expr),*)) => {
        if $V::DIM == 2 { $function::<$V, 2>($($argument),*) } else { $function::<$V, 3>($($argument),*) }
    };
}

mod batch;
mod clearance;
mod derivative;
mod distance;
mod ellipsoid_pair;
mod error;
mod margin;
mod numerics;
mod options;
mod pair;
#[cfg(feature = "paper")]
pub mod paper;
mod polynomial;
mod scaling;
mod secular;
mod track;

pub use convex_support;

pub use batch::{free_margins, free_margins_into, map_margins, map_margins_into, map_pairs};
pub use clearance::{Clearance, ClearanceResult, LeftOut, NearPair, clearance};
pub use convex_support::{MotionGradient, MotionHessian};
pub use derivative::shape::ShapeGradient;
pub use distance::{Distance, DistanceBracket, distance, distance_bracket};
pub use ellipsoid_pair::{Answer, EllipsoidPair};
pub use error::InvalidQuery;
pub use margin::{Margin, free_margin, free_margin_with};
pub use options::{MarginOptions, Method, Status};
pub use scaling::{Scaling, scaling};
pub use track::MarginTracker;

/// The README's example, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
