//! Rays that cannot be cast.

use core::error::Error;
use core::fmt::{self, Display, Formatter};

/// Why a ray or a motion was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum RayCastError {
    /// The direction of the ray is the zero vector, so that it has no hit parameter. To ask whether a point is in a
    /// shape, use [`intersects`](crate::intersects).
    ZeroDirection,
    /// A coordinate is NaN or infinite.
    NonFinite {
        /// The name of the vector, such as `"source"`, `"velocity_a"` or `"motion_a"`, or of the option.
        parameter: &'static str,
        /// Which coordinate, counted from 0.
        index: usize,
    },
    /// The closest point of the set, which [`iterative_ray_cast`](crate::iterative_ray_cast) works with, is not known:
    /// the shape has no closed form of it. [`ray_cast`](crate::ray_cast) needs only support points.
    NoClosestPoint,
}

impl Display for RayCastError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::ZeroDirection => f.write_str("the direction of the ray is the zero vector"),
            Self::NonFinite { parameter, index } => write!(f, "{parameter} is NaN or infinite at index {index}"),
            Self::NoClosestPoint => {
                f.write_str("the shape has no closed form of its closest point: use `ray_cast`, which needs none")
            }
        }
    }
}

impl Error for RayCastError {}
