//! The query format, the engine that answers it, and what is common to reports: `cargo xtask`, and the package
//! `studies`.
//!
//! Shapes are `dyn SupportMap` here, so that every algorithm is compiled for four vector types and no pair of shapes.
#![allow(
    missing_docs,
    reason = "a field of this unpublished package is told by its name, where nothing more is to say"
)]

pub mod columns;
mod draw;
pub mod engine;
pub mod mesh;
pub mod output;
pub mod plot;
pub mod prove;
pub mod query;
pub mod wire;

// All else are tasks of a command line. The page in a browser, for `target_os` "unknown", has none.
#[cfg(feature = "studies")]
pub mod bits;
#[cfg(not(target_os = "unknown"))]
mod claims;
#[cfg(not(target_os = "unknown"))]
pub mod docs;
#[cfg(not(target_os = "unknown"))]
pub mod follow;
#[cfg(not(target_os = "unknown"))]
pub mod footprint;
#[cfg(feature = "studies")]
pub mod fuzz;
#[cfg(not(target_os = "unknown"))]
pub mod judge;
#[cfg(not(target_os = "unknown"))]
pub mod museum;
#[cfg(not(target_os = "unknown"))]
pub mod page;
#[cfg(not(target_os = "unknown"))]
pub mod paths;
#[cfg(not(target_os = "unknown"))]
pub mod table;
#[cfg(not(target_os = "unknown"))]
pub mod validate;

/// The folder of the embedded suite: what is validated where no files are named.
pub const EMBEDDED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/suite");

/// Compiles and runs the examples of the workspace's README: no library sees all four crates.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// Compiles and runs the examples of the note on porting, which ask parry the same.
#[cfg(all(doctest, feature = "parry"))]
#[doc = include_str!("../../docs/porting.md")]
struct Porting;

/// Compiles and runs the examples of the note on choosing a method.
#[cfg(doctest)]
#[doc = include_str!("../../docs/choosing-a-method.md")]
struct ChoosingAMethod;

/// Compiles and runs the example of the note on derivatives.
#[cfg(doctest)]
#[doc = include_str!("../../docs/derivatives.md")]
struct Derivatives;
