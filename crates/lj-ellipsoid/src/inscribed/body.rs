//! The queries of the body itself, half-spaces or a hull, that the answer needs.

use crate::numerics::dimension::Dimension;
use crate::shape::Shape;

/// The body itself, from which the rows in round coordinates were computed.
pub(crate) trait Body<D: Dimension> {
    /// Scales the semi-axes so that the ellipsoid touches the body, proved to be inside; `None` if nothing is left of
    /// it.
    fn touch(&self, shape: &mut Shape<D>) -> Option<()>;

    /// How far the body extends beyond row `i`, in units of the slack of the row at the origin, beside the errors of
    /// the row. The weight is its importance.
    fn beyond(&self, i: usize, weight: f64) -> f64;
}
