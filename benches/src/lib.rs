//! The inputs of the benchmarks, and what is known about the answers.
//!
//! Every workload is drawn from fixed seeds with `+ − × ÷ √` only, so that any program can make the same inputs bit by
//! bit; `tests/digests.rs` compares their fingerprints.
//!
//! - [`shapes`] and [`pairs`]: the eleven shapes, and twelve pairs of them.
//! - [`w1_ray_cast`]: rays against one body, with `λ` in closed form.
//! - [`w2_linear_cast`]: a body moving past or into another, with `λ` by construction.
//! - [`w3_distance`], [`w3b_intersect`]: two bodies, with their distance by construction.
//! - [`w4_enclosing`]: points to be enclosed by an ellipsoid.
//! - [`w5_margin`]: pairs of ellipsoids.
//!
//! The same queries are answered by [`ours`] and by `parry`, `box3d` and `jolt`, where those features are on, each with the
//! inputs in its own types, timed by [`measure`] and compared with the truth by [`score`]. [`rows`] does so for
//! everything, [`report`] prints it beside the [`goals`].

#[cfg(feature = "box3d")]
pub mod box3d;
mod convex_hull;
pub mod digest;
pub mod goals;
#[cfg(feature = "jolt")]
pub mod jolt;
mod line_entry;
pub mod measure;
pub mod ours;
pub mod pairs;
#[cfg(feature = "parry")]
pub mod parry;
mod reference;
pub mod report;
pub mod rng;
pub mod rows;
pub mod score;
pub mod shapes;
pub mod vec3;
pub mod w1_ray_cast;
pub mod w2_linear_cast;
pub mod w3_distance;
pub mod w3b_intersect;
pub mod w4_enclosing;
pub mod w5_margin;

pub use reference::Pose;

/// Compiles and runs the examples of the workspace's README: no other package sees all four crates.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// Compiles and runs the examples of the note on porting, which ask parry the same.
#[cfg(all(doctest, feature = "parry"))]
#[doc = include_str!("../../docs/porting-from-parry.md")]
struct PortingFromParry;
