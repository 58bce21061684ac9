//! Inputs from fixed seeds, and what is true of them.
//!
//! Every workload is drawn with `+ − × ÷ √` only, so that any program can make the same inputs bit by bit;
//! `tests/digests.rs` compares their fingerprints. Nothing here knows how a query is answered: this package depends on
//! `convex-support` alone, to build the shapes that it describes.
//!
//! - [`shapes`] and [`pairs`]: the eleven shapes, and twelve pairs of them.
//! - [`w1_ray_cast`]: rays against one body, with `λ` in closed form.
//! - [`w2_linear_cast`]: a body moving past or into another, with `λ` by construction.
//! - [`w3_distance`], [`w3b_intersect`]: two bodies, with their distance by construction.
//! - [`w4_enclosing`]: points to be enclosed by an ellipsoid.
//! - [`w5_margin`]: pairs of ellipsoids.
//! - [`w6_motion_cast`]: the bodies of W2, turning as they move.
//! - [`line_entry`], [`convex_hull`], [`real`]: truths in closed form, in doubles or in thirty digits.
//! - [`score`]: answers compared with the truth.
//! - [`provenance`]: where and when a measurement was made; [`note`]: the part of a note that it is written to.

pub mod convex_hull;
pub mod digest;
pub mod line_entry;
pub mod note;
pub mod pairs;
pub mod provenance;
pub mod real;
mod reference;
pub mod rng;
pub mod score;
pub mod shapes;
pub mod vec3;
pub mod w1_ray_cast;
pub mod w2_linear_cast;
pub mod w3_distance;
pub mod w3b_intersect;
pub mod w4_enclosing;
pub mod w5_margin;
pub mod w6_motion_cast;

pub use reference::Pose;
