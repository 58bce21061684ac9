//! Everything that is held of margins from outside the crate.
//!
//! One program of all files: what they ask is compiled once.

mod batches;
mod clearances;
mod common;
mod data;
mod derivatives;
mod distances;
mod gradients;
mod invariances;
mod paper;
mod situations;
mod tracking;
