//! Everything that is held of shapes and their support maps from outside the crate.
//!
//! One program of all files: what they ask is compiled once.

mod bad_input;
mod bvh;
mod certain_crossing;
mod closest_point;
mod exact;
mod faceted;
mod hessian;
mod hull;
mod laws;
mod line_crossing;
mod primitives;
mod rounding;
mod serde;
mod support_feature;
