//! Points and ellipsoids of other crates.

#[cfg(feature = "convex-support")]
mod convex_support;
#[cfg(feature = "faer")]
pub(crate) mod faer;
