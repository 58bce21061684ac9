//! The inputs of the benchmarks, and what is known about the answers.
//!
//! Every workload is drawn from fixed seeds with `+ − × ÷ √` only, so that any program can make the same inputs bit by
//! bit; `tests/digests.rs` compares their fingerprints.
//!
//! - [`shapes`]: the eleven shapes.
//! - [`w1_ray_cast`]: rays against one body, with `λ` in closed form.
//! - [`w4_enclosing`]: points to be enclosed by an ellipsoid.
//! - [`w5_margin`]: pairs of ellipsoids.

mod convex_hull;
pub mod digest;
mod line_entry;
pub mod rng;
pub mod shapes;
pub mod vec3;
pub mod w1_ray_cast;
pub mod w4_enclosing;
pub mod w5_margin;
