//! The free margin of ellipsoids: how far a robot's link is from an obstacle, and which way that grows.

#![no_std]
#![allow(clippy::needless_range_loop, reason = "the formulas of this crate index several small arrays at once")]
#![allow(clippy::doc_markdown, reason = "formulas are not code")]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("ellip-margin needs floating-point functions: enable the feature `std` or `libm`");

extern crate alloc;
#[cfg(any(feature = "std", test))]
extern crate std;

mod clearance;
mod distance;
mod double_double;
#[cfg(feature = "eigen")]
pub mod eigen;
mod eigenvalue;
mod error;
mod gradient;
mod hessian;
mod hierarchy;
mod inverse_iteration;
mod margin;
mod options;
mod pair;
mod polynomial;
mod scaling;
mod secular;
mod svd;
mod track;
mod wedge;

pub use convex_support;

pub use clearance::{Clearance, ClearanceResult, LeftOut, NearPair, clearance};
pub use distance::{Distance, DistanceBracket, distance, distance_bracket};
pub use eigenvalue::{EigenvalueGradient, eigenvalue_gradient};
pub use error::InvalidQuery;
pub use gradient::{MarginGradient, ShapeGradient};
pub use inverse_iteration::InverseIterationTracker;
pub use margin::{Margin, free_margin, free_margin_with};
pub use options::{MarginOptions, Method, Status};
pub use scaling::{Scaling, scaling};
pub use track::MarginTracker;
pub use wedge::Wedge;
