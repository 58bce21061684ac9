//! Derivatives: how an answer changes as bodies are moved, and whether it does so smoothly.
//!
//! With `s` the signed distance, `n` the normal out of B towards A, and `a − b = s·n` the closest points, all first
//! derivatives are forces at points: since `s` is the largest `min n·A − max n·B` over unit normals, it changes as that
//! does with `n` held,
//!
//! > ds = n·(δa − δb),   δa and δb the displacements of the closest points,
//!
//! and a hit, at which `s = 0`, is put off by `dt = −n·(δa − δb)/(n·w)`, with `w` the velocity of `a` relative to `b`.
//! This needs only the answer. Whether the normal and the points are the only ones, and how they move, depends on the
//! shapes: [`ClosestFeatures`].

mod closest_features;
mod features_of;
mod gradient;
mod hessian;
mod look;
mod overlap;
mod smoothness;
mod velocities;

pub use closest_features::ClosestFeatures;
pub use gradient::{GrowthGradient, ImpactGradient, RayCastGradient, RigidMotionGradient};
pub use hessian::PairHessian;
pub use smoothness::Smoothness;
pub use velocities::ClosestVelocities;
