//! The parts of a set (origin, core and radius), and bounds on their rounding.

use crate::numerics::bound::{raised, raised_vector, roundings, roundings_of};
use crate::{Scalar, Vector};

/// The parts of a convex shape: an origin, a smaller shape about it, and the radius of a ball that sweeps the smaller
/// shape.
///
/// In symbols, the set is `o + K ⊕ B(r)` with the origin `o`, the core `K` near zero, and the radius `r`.
///
/// A ball, a capsule and every [rounded](crate::Rounded) shape is a smaller set, its *core*, swept by a ball.
/// Iterative methods converge slowly on round surfaces and finish at once on a point or a segment, so they work on
/// the core and add the radius at the end. They also work relative to the origin of the body, where coordinates and
/// their rounding are small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Core<V: Vector> {
    /// A point near the set; the core is relative to it.
    pub origin: V,
    /// The radius of the ball that sweeps the core.
    pub radius: V::Scalar,
    /// The radius of a ball that rolls around within the core: the core is some smaller convex set swept by this ball.
    /// Any smaller radius is right as well, and 0 always is.
    ///
    /// A ball of radius `r` rolls within a smooth convex body if no radius of curvature is less than `r` (Blaschke's
    /// rolling theorem). If two shapes overlap by less than the balls that roll within them, their penetration depth
    /// can be found as the distance of the smaller sets.
    pub rolling_radius: V::Scalar,
    /// An upper bound on the length of every vector that [`core_support`](crate::SupportMap::core_support) computes
    /// with. Its rounding errors are proportional to this length.
    pub extent: V::Scalar,
    /// An upper bound on the rounding error of the core, as a length, relative to the computed origin: every [support
    /// point](crate::SupportMap::core_support) is at most this far from a point of the exact core, and the support
    /// value along a unit direction falls short of the exact one by no more. The error of the radius is included.
    ///
    /// Every query has this bound at once; [`rounding`](crate::SupportMap::rounding) computes finer ones, coordinate by
    /// coordinate.
    pub error: V::Scalar,
    /// The kind of the core.
    pub kind: CoreKind<V>,
}

impl<V: Vector> Core<V> {
    /// A core about zero whose support points are exact, swept by no ball.
    #[inline(always)]
    #[must_use]
    pub fn exact(kind: CoreKind<V>, extent: V::Scalar) -> Self {
        let zero = V::Scalar::ZERO;
        Self { origin: V::ZERO, radius: zero, rolling_radius: zero, extent, error: zero, kind }
    }

    /// A bound on how far the points of the set are from its origin.
    #[inline(always)]
    #[must_use]
    pub fn size(&self) -> V::Scalar {
        self.extent + self.radius
    }

    /// The core of the set swept by a ball of this radius, as for [`Rounded`](crate::Rounded).
    #[inline(always)]
    #[must_use]
    pub fn rounded(self, radius: V::Scalar) -> Self {
        let sum = self.radius + radius;
        // The sum with zero is exact.
        let is_exact = self.radius == V::Scalar::ZERO || radius == V::Scalar::ZERO;
        let lost = if is_exact { V::Scalar::ZERO } else { roundings(1.0, sum) };
        Self { radius: sum, error: self.error + lost, ..self }
    }
}

/// The kind of a [core](Core).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoreKind<V> {
    /// A single point, relative to the origin. Its distance from a shape that knows its closest points takes no
    /// iteration.
    Point(V),
    /// A segment. The distance of two segments takes no iteration.
    Segment {
        /// The point halfway between its ends, relative to the origin.
        middle: V,
        /// The vector from there to one of the ends.
        half: V,
    },
    /// A polytope, whose support point jumps from vertex to vertex and does not move in between: its Hessian is always
    /// zero.
    Polytope,
    /// Anything else.
    Curved,
}

impl<V> CoreKind<V> {
    /// The kind of a Minkowski sum.
    #[inline]
    pub(crate) fn plus(self, other: Self, points: impl FnOnce(V, V) -> V) -> Self {
        match (self, other) {
            (Self::Point(a), Self::Point(b)) => Self::Point(points(a, b)),
            (Self::Point(a), Self::Segment { middle, half }) => Self::Segment { middle: points(a, middle), half },
            (Self::Segment { middle, half }, Self::Point(b)) => Self::Segment { middle: points(middle, b), half },
            (Self::Curved, _) | (_, Self::Curved) => Self::Curved,
            _ => Self::Polytope,
        }
    }
}

impl<V: Vector> CoreKind<V> {
    /// The kind of the core's image under a linear map, moved by the rounding error of the origin.
    #[inline(always)]
    pub(crate) fn image(self, map: impl Fn(V) -> V, lost: V) -> Self {
        match self {
            Self::Point(at) => Self::Point(map(at) + lost),
            // The middle of most is zero, and stays where it is.
            Self::Segment { middle, half } => {
                let middle = if middle == V::ZERO { lost } else { map(middle) + lost };
                Self::Segment { middle, half: map(half) }
            }
            kind => kind,
        }
    }
}

/// Bounds on the rounding errors of the support points of a core.
///
/// Let `K` be the exact core that the constructors' arguments define, relative to the computed
/// [origin](Core::origin), with the error of the radius included. Let `k(d)` be the computed [support
/// point](crate::SupportMap::core_support). Then, with `|·|` taken coordinate by coordinate,
///
/// > |k(d) − x| ≤ error for a point x of K, and  max { d·y : y ∈ K } ≤ d·k(d) + |d|·error.
///
/// The first makes an upper bound of a distance rigorous, and the second a lower bound. A rotation counts as the
/// exactly normalised quaternion or the exact angle, a matrix as it is given, and points as they are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding<V: Vector> {
    /// A bound on the coordinates of all points of the core.
    pub extent: V,
    /// The bound on the error of each coordinate.
    pub error: V,
    /// A bound on the length of the error. A rotation keeps it, whereas the bound on the coordinates grows by up to
    /// `√3`.
    pub error_length: V::Scalar,
}

impl<V: Vector> Rounding<V> {
    /// A core of the given extents, all of whose support points are exact and farthest.
    #[must_use]
    pub fn exact(extent: V) -> Self {
        Self { extent, error: V::ZERO, error_length: V::Scalar::ZERO }
    }

    /// A core of the given extents whose support points are wrong by a few units in the last place of the extents.
    #[must_use]
    pub fn relative(extent: V, units: f64) -> Self {
        Self::exact(raised_vector(extent)).with_error(roundings_of(2.0 * units, extent))
    }

    /// The same with a further error.
    #[must_use]
    pub(crate) fn with_error(self, error: V) -> Self {
        let error_length = raised(self.error_length + error.norm());
        Self { error: raised_vector(self.error + error), error_length, ..self }
    }

    /// The same with the error of a radius, which may be in any direction.
    #[must_use]
    pub(crate) fn with_radius_error(self, error: V::Scalar) -> Self {
        let error_length = raised(self.error_length + error);
        Self { error: raised_vector(self.error + V::splat(error)), error_length, ..self }
    }

    /// With what sweeping the core by a ball adds to it, where that becomes part of the core.
    #[must_use]
    pub(crate) fn swept(self, radius: V::Scalar) -> Self {
        if radius == V::Scalar::ZERO {
            return self;
        }
        // The unit vector times the radius is right to 6 roundings, and the sum is rounded once.
        let extent = raised_vector(self.extent + V::splat(radius));
        Self { extent, ..self }.with_error(V::splat(roundings(6.0, radius)) + roundings_of(1.0, extent))
    }

    /// The same with all bounds raised by what their own computation may have lost.
    #[must_use]
    pub(crate) fn raised(self) -> Self {
        Self {
            extent: raised_vector(self.extent),
            error: raised_vector(self.error),
            error_length: raised(self.error_length),
        }
    }
}
