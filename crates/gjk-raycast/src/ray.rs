//! Rays, and the velocities of moving shapes, from which rays are made.

use core::error::Error;
use core::fmt::{self, Display, Formatter};

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::{LinearCastOptions, RayCastOptions, RigidMotion};

/// The ray of the points `source + λ·direction`, λ ≥ 0. The direction need not be of unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ray<V> {
    /// Its start.
    pub source: V,
    /// Its direction, which is the unit of λ.
    pub direction: V,
}

impl<V: Vector> Ray<V> {
    /// The point at parameter `lambda`.
    #[must_use]
    pub fn at(&self, lambda: V::Scalar) -> V {
        self.source + self.direction * lambda
    }

    /// The same ray, assembled from its coordinates.
    ///
    /// If some call takes a ray as a whole, in a rare case or behind `dyn`, the ray is kept in memory as it came,
    /// written in pieces of two numbers from its beginning. A direction read from there lies across two of them, and a
    /// processor waits until both are written, longer than a closed form takes. From coordinates, the compiler writes
    /// to memory what each call needs.
    #[inline(always)]
    pub(crate) fn by_coordinates(self) -> Self {
        let copied = |v: V| V::from_fn(|i| v.get(i));
        Self { source: copied(self.source), direction: copied(self.direction) }
    }

    /// The error of a ray that cannot be cast, with these options.
    pub(crate) fn check(&self, options: &RayCastOptions<V>) -> Result<(), RayCastError> {
        // Zero times what is not finite is NaN; a sum that overflows is looked at coordinate by coordinate.
        if (self.source + self.direction).dot(V::ZERO) != V::Scalar::ZERO {
            check_finite("source", self.source)?;
            check_finite("direction", self.direction)?;
        }
        if self.direction == V::ZERO {
            return Err(RayCastError::ZeroDirection);
        }
        check_numbers([("min_lambda", options.min_lambda), ("max_lambda", options.max_lambda)])
    }
}

/// The error of options that are NaN, in which every comparison would be as false as its opposite.
pub(crate) fn check_numbers<S: Scalar>(options: [(&'static str, S); 2]) -> Result<(), RayCastError> {
    match options.iter().find(|(_, value)| value.is_nan()) {
        Some(&(parameter, _)) => Err(RayCastError::NonFinite { parameter, index: 0 }),
        None => Ok(()),
    }
}

pub(crate) fn check_finite<V: Vector>(parameter: &'static str, vector: V) -> Result<(), RayCastError> {
    match (0..V::DIM).find(|&i| !vector.get(i).is_finite()) {
        Some(index) => Err(RayCastError::NonFinite { parameter, index }),
        None => Ok(()),
    }
}

/// The error of limits that are invalid for a cast of two bodies. With an infinite target distance any two bodies
/// would touch at any time, and a body swept by it would not be a body.
pub(crate) fn check_limits<S: Scalar>(max_time: S, target_distance: S) -> Result<(), RayCastError> {
    let target = if target_distance < S::infinity() { target_distance } else { S::nan() };
    check_numbers([("max_time", max_time), ("target_distance", target)])
}

/// The velocities of two shapes, in units of length per unit of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Motion<V> {
    /// The velocity of `a`.
    pub velocity_a: V,
    /// The velocity of `b`.
    pub velocity_b: V,
}

impl<V: Vector> Motion<V> {
    /// The motions of both bodies.
    #[must_use]
    pub fn translations(self) -> [RigidMotion<V>; 2] {
        [self.velocity_a, self.velocity_b].map(RigidMotion::translation)
    }

    /// The error of a motion that is invalid, or cannot be cast with these options.
    pub(crate) fn check(&self, options: &LinearCastOptions<V>) -> Result<(), RayCastError> {
        check_finite("velocity_a", self.velocity_a)?;
        check_finite("velocity_b", self.velocity_b)?;
        check_limits(options.max_time, options.target_distance)
    }
}

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
