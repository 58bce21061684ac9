//! The free margin of ellipsoids: how far a robot's link is from an obstacle, and which way that grows; 2D and 3D, `f32` and
//! `f64`, on [glam](https://docs.rs/glam)'s vectors.
//!
//! The margin of E₁ about E₂ is how much E₁, grown about its centre, needs to touch E₂ (Rimon and Boyd, *Obstacle collision
//! detection using best ellipsoid fit*, 1997): positive where they are disjoint, 0 where they touch, negative where they
//! overlap, and continuously differentiable throughout.
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
//! - [`free_margin`]: value, multiplier and nearest point; [`free_margin_with`] to watch it converge.
//! - [`distance`], [`distance_bracket`]: the Euclidean distance, exact or bounded, certified either way.
//! - [`scaling`]: the common scale at which both touch, symmetric, informative at any depth.
//! - [`EllipsoidPair`]: the same three with their derivatives. Each answers `gradient` and `hessian`, and these `_of_second`, by the
//!   motion of either body, as a wrench or per joint.
//! - [`free_margins`], [`map_margins`], [`map_pairs`], and into a column [`map_margins_into`]: many pairs; margins side by side in vector registers.
//!
//! # Along a motion
//! - [`MarginTracker`]: one pair. [`Clearance`]: many links against many obstacles; [`clearance`] is its plain reference.
//!
//! # The paper's own routes, corrected
//! - Feature `paper`: `paper::free_margin_eigen`, `paper::InverseIterationTracker`, `paper::eigenvalue_gradient`.
//!
//! # Features
//! - `std` (default): floating-point functions from the standard library; `libm`: the same from the libm crate, for `no_std`
//!   targets. `alloc` is needed in any case.
//! - `paper`: the paper's own routes, with eigenvalues by faer.
//! - `rayon`: [`free_margins`] and [`clearance`] use all cores. The answers are the same to the last bit.
//! - `serde`: options, answers, derivatives and trackers as data, beside convex-support's shapes. An option that is left out has its
//!   default. Errors can be written and not read. Left out are [`EllipsoidPair`] and [`Answer`], which are made of their ellipsoids, and
//!   [`Clearance`], whose bounds only its own steps can vouch for.
//! - `simd`: batches take the widest vector instructions of the processor, found at run time by pulp. The answers are the same.

#![no_std]
#![allow(clippy::needless_range_loop, reason = "the formulas of this crate index several small arrays at once")]
#![allow(clippy::doc_markdown, reason = "formulas are not code")]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("ellip-margin needs floating-point functions: enable the feature `std` or `libm`");

extern crate alloc;
#[cfg(any(feature = "std", test))]
extern crate std;

mod batch;
mod clearance;
mod derivative;
mod distance;
mod ellipsoid_pair;
mod error;
mod hierarchy;
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
mod wedge;

pub use convex_support;

pub use batch::{free_margins, free_margins_into, map_margins, map_margins_into, map_pairs};
pub use clearance::{Clearance, ClearanceResult, LeftOut, NearPair, clearance};
pub use derivative::{MotionGradient, MotionHessian, ShapeGradient};
pub use distance::{Distance, DistanceBracket, distance, distance_bracket};
pub use ellipsoid_pair::{Answer, EllipsoidPair};
pub use error::InvalidQuery;
pub use margin::{Margin, free_margin, free_margin_with};
pub use options::{MarginOptions, Method, Status};
pub use scaling::{Scaling, scaling};
pub use track::MarginTracker;
pub use wedge::Wedge;

/// The README's example, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
