//! The Löwner–John ellipsoids: the one of least volume around points, and the one of greatest volume inside a
//! polytope. Each comes with a certified bound on how far its volume is from the optimum.
//!
#![doc = include_str!("../doc/pair.svg")]
//!
//! Which ellipsoid encloses this bar, and how well does it fit?
//!
//! ```
//! use lj_ellipsoid::{EnclosingOptions, InscribedOptions, enclosing, inscribed_in_hull};
//!
//! // The corners of a bar, 6 × 2 × 1, standing somewhere in the world.
//! let bar: Vec<[f64; 3]> = (0..8u8)
//!     .map(|i| [10.0 + f64::from(i & 1) * 6.0, f64::from(i >> 1 & 1) * 2.0, f64::from(i >> 2)])
//!     .collect();
//!
//! let outer = enclosing(&bar, EnclosingOptions::default())?;
//! // Every point is inside, as evaluated in f64.
//! assert!(bar.iter().all(|&corner| outer.ellipsoid.contains(corner)));
//! assert!(outer.log_det_gap <= 1e-9); // certified: no ellipsoid around the points is smaller by more than this
//! assert!((outer.ellipsoid.semi_axes()[0] - 3.0 * 3f64.sqrt()).abs() < 1e-9);
//!
//! let inner = inscribed_in_hull(&bar, InscribedOptions::default())?;
//! // The ratio of the volumes to the power of 1/3, which is between 1/3 and 1.
//! let tightness = inner.ellipsoid.tightness(&outer.ellipsoid);
//! assert!((tightness - 1.0 / 3f64.sqrt()).abs() < 1e-8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is here
//! Around points: [`enclosing()`]; [`enclosing_with`] shows an observer every iterate, and [`MovingPoints`] keeps the
//! answer while points are added, removed and moved. [`EnclosingMethod`] selects one of four algorithms. Points that
//! span no volume are an error; with [`FlatPolicy::AffineHull`] their ellipsoid is a disc, a segment or a point.
//!
//! Inside a polytope: [`inscribed()`] for an intersection of half-spaces, [`inscribed_in_hull()`] for the hull of
//! points in 2D and 3D.
//!
//! Points are anything that converts into `[f64; N]`: arrays, glam's `DVec2` and `DVec3`, or a type of your own. If the
//! dimension is known only at run time, points are slices of one length: [`enclosing_dyn`], [`inscribed_dyn`].
//!
//! # Promises of every answer
//! The gap is *certified*: it is computed from the duality of the problem, not from the size of the last step, and
//! the rounding of its own evaluation is added. [`Status`] tells whether it is as small as was asked for. Whatever
//! the status, the enclosing ellipsoid contains every point and the inscribed one stays within every half-space or
//! hull. Both are proved for the returned doubles, and hold as evaluated in `f64`. All tolerances are relative:
//! scaling the input by a power of two changes no bit of any mantissa except that of [`log_det`](Ellipsoid::log_det),
//! as long as lengths are from 2⁻⁴⁵⁰ to 2⁴⁵⁰.
//!
//! # Features
//! None is on by default.
//!
//! - `rayon`: passes over many points use all cores. The answer is the same to the last bit.
//! - `convex-support`: conversions to that crate's `Ellipsoid`.
//! - `serde`: options, half-spaces and answers as data, in any format of [serde](https://docs.rs/serde), read back to
//!   the last bit (`serde_json` needs its feature `float_roundtrip` for this). An option that is left out has its
//!   default, and an unknown gap is `null`. Reading checks that options are in range, and that an ellipsoid has the
//!   right dimension, finite numbers, semi-axes in order and orthonormal axes. Errors can be written but not read.
//!   The iterates of observers cannot be written, nor can [`MovingPoints`], which can be built again from its points.
//!
//! ```
//! # #[cfg(feature = "serde")] {
//! use lj_ellipsoid::{Enclosing, enclosing};
//!
//! let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]];
//! let options = serde_json::from_str(r#"{"epsilon": 1e-7, "method": "Khachiyan"}"#)?;
//! let answer = enclosing(&points, options)?;
//! let saved = serde_json::to_string(&answer)?;
//! let read: Enclosing<2> = serde_json::from_str(&saved)?;
//! assert_eq!(read, answer);
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]
// On docs.rs, each item says which feature it needs.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]
#![allow(
    clippy::needless_range_loop,
    reason = "formulas index several arrays at once; the loops read as the sums they compute"
)]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0)` is how NaN takes the same exit as zero")]

#[cfg(feature = "serde")]
mod data;
mod dynamic;
mod ellipsoid;
mod enclosing;
mod error;
mod inscribed;
mod interop;
mod numerics;
mod options;
mod points;
mod shape;
mod weight;

pub use dynamic::{
    EllipsoidDyn, EnclosingDyn, InscribedDyn, enclosing_dyn, enclosing_dyn_with, inscribed_dyn, inscribed_in_hull_dyn,
};
pub use ellipsoid::Ellipsoid;
pub use enclosing::moving_points::MovingPoints;
pub use enclosing::{Enclosing, EnclosingIterate, enclosing, enclosing_with};
pub use error::{EnclosingError, InscribedError};
pub use inscribed::in_hull::{inscribed_in_hull, inscribed_in_hull_with};
pub use inscribed::{HalfSpace, Inscribed, InscribedIterate, inscribed, inscribed_with};
pub use options::{EnclosingMethod, EnclosingOptions, FlatPolicy, InscribedOptions, Status};
pub use weight::Weight;

/// The README's example, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;
