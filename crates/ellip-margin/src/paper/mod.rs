//! The paper's own methods for the margin, corrected, for comparison and teaching: feature `paper`.
//!
//! - [`free_margin_eigen`]: the minimal eigenvalue of a 2N×2N matrix, found among all of them by faer (Section 3).
//! - [`InverseIterationTracker`]: the same eigenvalue along a trajectory, from that of the pose before (Section 4).
//! - [`eigenvalue_gradient`]: its gradient (Corollary 4.1).
//!
//! [`free_margin`](crate::free_margin) and [`EllipsoidPair`](crate::EllipsoidPair) are faster and keep their digits
//! where these lose them; see `docs/free-margin.md` in the repository.

mod eigen;
mod eigenvalue;
mod inverse_iteration;

pub use self::eigen::free_margin_eigen;
pub use self::eigenvalue::{EigenvalueGradient, eigenvalue_gradient};
pub use self::inverse_iteration::InverseIterationTracker;
