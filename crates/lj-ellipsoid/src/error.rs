//! The errors of sets of points or half-spaces.

use thiserror::Error;

/// Why there is no minimum-volume ellipsoid around the given points.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum EnclosingError {
    /// There are no points, or they have no coordinates.
    #[error("no points to enclose")]
    Empty,
    /// A coordinate is NaN or infinite.
    #[error("coordinate {coordinate} of point {index} is {value}")]
    NonFinite {
        /// The index of the point.
        index: usize,
        /// The index of its coordinate.
        coordinate: usize,
        /// The value.
        value: f64,
    },
    /// All points lie in an affine subspace of `rank` dimensions, up to rounding: the ellipsoid has no volume. Ask for
    /// [`FlatPolicy::AffineHull`](crate::FlatPolicy::AffineHull) to get the ellipsoid within that subspace.
    #[error("the points are flat: they span {rank} of {dimension} dimensions")]
    Flat {
        /// The dimension of the affine hull of the points; 0 if all are equal.
        rank: usize,
        /// The dimension of the space.
        dimension: usize,
    },
    /// [`EnclosingOptions::epsilon`](crate::EnclosingOptions::epsilon) is zero, negative or NaN.
    #[error("epsilon must be positive, not {value}")]
    InvalidEpsilon {
        /// The value given.
        value: f64,
    },
    /// [`EnclosingOptions::flat_tolerance`](crate::EnclosingOptions::flat_tolerance) is negative or NaN.
    #[error("the flat tolerance must not be negative or NaN, but it is {value}")]
    InvalidFlatTolerance {
        /// The value given.
        value: f64,
    },
    /// The points are valid, but the lengths or their inverse squares leave the range of `f64`.
    #[error("the ellipsoid of these points is out of the range of f64")]
    OutOfRange,
}

/// Why there is no maximum-volume ellipsoid inside the given body.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum InscribedError {
    /// There are no half-spaces or points, or they have no coordinates.
    #[error("no half-spaces or points to inscribe into")]
    Empty,
    /// A coordinate of a point, or of a normal, is NaN or infinite, or an offset is (then `coordinate` is the
    /// dimension).
    #[error("coordinate {coordinate} of half-space or point {index} is {value}")]
    NonFinite {
        /// The index of the half-space or point.
        index: usize,
        /// The index of the coordinate; the dimension stands for the offset.
        coordinate: usize,
        /// The value.
        value: f64,
    },
    /// The normal of a half-space is zero.
    #[error("the normal of half-space {index} is zero")]
    ZeroNormal {
        /// The index of the half-space.
        index: usize,
    },
    /// The normals do not positively span the space: the half-spaces certainly have no bounded intersection. (It may be
    /// empty: this is not tested.)
    #[error("the intersection of the half-spaces is unbounded")]
    Unbounded,
    /// Doubles do not tell whether, or how far away, the intersection of the half-spaces ends: along some direction the
    /// normals have hardly anything of their length. Axes in doubles are turned by 1e-16 of their length, so that a
    /// body 1e16 times as long as thick cannot be described, unless it lies along the coordinates.
    #[error(
        "the intersection of the half-spaces is unbounded, or so long that doubles do not tell (a ratio of {ratio:e})"
    )]
    NearlyUnbounded {
        /// The part of the normals along that direction, over that along others; 0 if it is nothing but rounding.
        ratio: f64,
    },
    /// The intersection has no interior: it is empty, or flat.
    #[error("the intersection of the half-spaces is empty or flat")]
    EmptyInterior,
    /// No point with coordinates in doubles is known inside, or no ellipsoid with axes in doubles: the intersection is
    /// empty or flat, or thinner than the spacing of doubles where it lies (about the origin, than 1e-16 of its length,
    /// or 1e-154).
    #[error("the intersection of the half-spaces is empty, or too thin for doubles (a ratio of {ratio:e})")]
    NearlyEmpty {
        /// A bound on its thinness: the shortest over the longest axis of the last body known around it.
        ratio: f64,
    },
    /// All points lie in an affine subspace of `rank` dimensions, up to rounding: their hull has no interior.
    #[error("the points are flat: they span {rank} of {dimension} dimensions")]
    Flat {
        /// The dimension of the affine hull of the points.
        rank: usize,
        /// The dimension of the space.
        dimension: usize,
    },
    /// The hull of points is implemented in two and three dimensions; give half-spaces in others.
    #[error("the convex hull of points is available in 2 and 3 dimensions, not in {dimension}")]
    HullDimension {
        /// The dimension of the points.
        dimension: usize,
    },
    /// [`InscribedOptions::epsilon`](crate::InscribedOptions::epsilon) is zero, negative or NaN.
    #[error("epsilon must be positive, not {value}")]
    InvalidEpsilon {
        /// The value given.
        value: f64,
    },
    /// The input is valid, but lengths or their inverse squares leave the range of `f64`.
    #[error("the ellipsoid in this body is out of the range of f64")]
    OutOfRange,
}
