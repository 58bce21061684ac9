//! lj-ellipsoid
#![allow(
    clippy::needless_range_loop,
    reason = "formulas index several arrays at once; the loops read as the sums they compute"
)]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0)` is how NaN takes the same exit as zero")]

mod design;
mod dimension;
mod dual_reduced;
mod ellipsoid;
mod ellipsoid_algorithm;
mod enclosing;
mod error;
mod frame;
mod hull;
mod inscribed;
mod inscribed_in_hull;
mod interior;
#[cfg(feature = "faer")]
mod interop_faer;
mod khachiyan;
mod linalg;
mod moving_points;
mod newton;
mod options;
mod points;
mod scan;
mod solution;
mod start;
mod violators;
mod working_set;

pub use ellipsoid::Ellipsoid;
pub use enclosing::{Enclosing, EnclosingIterate, enclosing, enclosing_with};
pub use error::{EnclosingError, InscribedError};
#[cfg(feature = "faer")]
pub use faer;
pub use inscribed::{Halfspace, Inscribed, InscribedIterate, inscribed, inscribed_with};
pub use inscribed_in_hull::{inscribed_in_hull, inscribed_in_hull_with};
#[cfg(feature = "faer")]
pub use interop_faer::{
    EllipsoidDyn, EnclosingDyn, InscribedDyn, enclosing_dyn, enclosing_dyn_with, inscribed_dyn, inscribed_in_hull_dyn,
    rows_to_matrix,
};
pub use moving_points::MovingPoints;
pub use options::{EnclosingMethod, EnclosingOptions, FlatPolicy, InscribedOptions, Status};
pub use solution::Weight;
