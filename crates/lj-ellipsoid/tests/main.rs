//! Everything that is held of ellipsoids around and inside points from outside the crate.
//!
//! One program of all files: what they ask is compiled once.

mod common;
mod data;
mod laws;
mod moving_points;
mod options;
mod situations;
mod thin;
