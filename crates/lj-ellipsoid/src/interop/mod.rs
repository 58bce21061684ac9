//! Points and ellipsoids of other crates.

#[cfg(feature = "convex-support")]
mod convex_support;
