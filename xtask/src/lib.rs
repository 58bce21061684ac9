//! The query format, the engine that answers it, and what is common to reports: `cargo xtask`, and the package `studies`.
//!
//! Shapes are `dyn SupportMap` here, so that every algorithm is compiled for four vector types and no pair of shapes.
#![allow(
    missing_docs,
    reason = "a field of this unpublished package is told by its name, where nothing more is to say"
)]

pub mod docs;
pub mod engine;
pub mod footprint;
pub mod fuzz;
pub mod mesh;
pub mod plot;
pub mod query;
pub mod validate;
pub mod wire;
