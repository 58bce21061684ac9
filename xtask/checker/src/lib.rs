//! Whether a certificate proves what an answer claims, in interval arithmetic of 256 bits.
//!
//! It shares nothing with the libraries, neither a solver nor a shape: a query is read once more here, from its JSON,
//! and what a certificate proves follows from the query's own numbers. `docs/evidence.md` says how, and what the
//! numbers of a query mean.

mod body;
mod certificate;
mod claims;
mod clearance;
mod free;
mod growth;
mod interval;
mod joint_box;
mod motion;
mod moving;
mod near;
mod path;
mod planes;
mod question;
mod reader;
mod robot;
#[cfg(test)]
mod tests;

pub use self::certificate::Bounds;
pub use self::claims::{Proof, Verdict, judge};
pub use self::free::Parts;
pub use self::interval::Interval;
pub use self::planes::Solid;
pub use self::reader::{Points, Reader, Unread};
