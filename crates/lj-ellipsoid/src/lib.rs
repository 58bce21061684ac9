//! lj-ellipsoid

mod design;
mod dimension;
mod dual_reduced;
mod ellipsoid;
mod ellipsoid_algorithm;
mod enclosing;
mod error;
mod frame;
#[cfg(feature = "faer")]
mod interop_faer;
mod khachiyan;
mod linalg;
mod newton;
mod options;
mod points;
mod solution;
mod start;
mod working_set;

pub use ellipsoid::Ellipsoid;
pub use enclosing::{Enclosing, EnclosingIterate, enclosing, enclosing_with};
pub use error::{EnclosingError, InscribedError};
#[cfg(feature = "faer")]
pub use faer;
#[cfg(feature = "faer")]
pub use interop_faer::{EllipsoidDyn, EnclosingDyn, enclosing_dyn, enclosing_dyn_with, rows_to_matrix};
pub use options::{EnclosingMethod, EnclosingOptions, FlatPolicy, InscribedOptions, Status};
pub use solution::Weight;
