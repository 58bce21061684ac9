//! A body as a search sees it: a core and a radius, relative to the shape's origin and in [units](crate::unit) of its
//! size. Two bodies are a [`Pair`](crate::pair::Pair), which is searched in the same way.

use convex_support::{CertainCrossing, Core, CoreKind, Hint, LineQuery, Scalar, ScalarOf, SupportMap, Vector};

use crate::symmetric::Symmetric;
use crate::unit::reciprocal_of_power;

/// The scalars of a [`TracedSupport`].
pub(crate) type ScalarFrom<B> = <<B as TracedSupport>::Vector as Vector>::Scalar;

/// The core points of two shapes, each relative to its shape's origin, in units of the scale.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PointPair<V> {
    pub(crate) a: V,
    pub(crate) b: V,
}

/// The support map of a core, whose points keep the points that they come from: all that GJK needs of a body.
pub(crate) trait TracedSupport {
    type Vector: Vector;

    /// The support point, relative to the body's origin and in its unit, and the points of both shapes whose difference
    /// it is.
    fn support(&mut self, direction: Self::Vector) -> (Self::Vector, PointPair<Self::Vector>);
    /// The Hessian `H` of the support value, the rate at which the support point moves as the direction turns, for two
    /// changes `u` and `w`: the entries `u·Hu`, `u·Hw` and `w·Hw`.
    fn hessian(&self, direction: Self::Vector, changes: [Self::Vector; 2]) -> Symmetric<ScalarFrom<Self>>;
    /// Whether the Hessian may be nonzero.
    fn is_curved(&self) -> bool;
}

/// A core and its radius, for casts.
pub(crate) trait CastBody: TracedSupport {
    /// Where a line of the world [certainly enters](SupportMap::certain_crossing) the body.
    fn certain_crossing(&self, line: LineQuery<Self::Vector>) -> Option<CertainCrossing<Self::Vector>>;
    /// The part of the [Hessian](TracedSupport::hessian) that comes from the first shape.
    fn hessian_of_first(&self, direction: Self::Vector, changes: [Self::Vector; 2]) -> Symmetric<ScalarFrom<Self>> {
        self.hessian(direction, changes)
    }
    /// The points of the shapes that a point of the core comes from, if a crossing is known.
    fn witness(&self, point: Self::Vector) -> PointPair<Self::Vector>;
    /// The parts of the body, in the world's unit. For a difference each is the sum, except for the origin, which is
    /// that of the first shape alone, because subtracting the other's would round.
    fn measures(&self) -> Measures<Self::Vector>;
    /// Sets the unit to the given power of two.
    fn set_scale(&mut self, scale: ScalarFrom<Self>);
}

/// The lengths that all errors of a body are relative to, in the world's unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measures<V: Vector> {
    /// The point to which positions are relative.
    pub(crate) origin: V,
    pub(crate) radius: V::Scalar,
    /// A bound on the length of all vectors that support points of the core are computed from.
    pub(crate) extent: V::Scalar,
    /// The radius of a ball that rolls within all of the body.
    pub(crate) rolling_radius: V::Scalar,
    /// A bound on how far rounding has moved the support points of the core.
    pub(crate) error: V::Scalar,
}

/// One shape.
pub(crate) struct Single<'a, S: SupportMap + ?Sized> {
    shape: &'a S,
    core: Core<S::Vector>,
    hint: Hint,
    per_unit: ScalarOf<S>,
}

impl<'a, S: SupportMap + ?Sized> Single<'a, S> {
    #[inline]
    pub(crate) fn new(shape: &'a S) -> Self {
        Self { shape, core: shape.core(), hint: Hint::new(), per_unit: Scalar::ONE }
    }
}

impl<S: SupportMap + ?Sized> TracedSupport for Single<'_, S> {
    type Vector = S::Vector;

    #[inline(always)]
    fn support(&mut self, direction: S::Vector) -> (S::Vector, PointPair<S::Vector>) {
        self.hint.rewind();
        let a = self.shape.core_support(direction, &mut self.hint) * self.per_unit;
        (a, self.witness(a))
    }

    #[inline(always)]
    fn hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> Symmetric<ScalarOf<S>> {
        Symmetric::of(self.shape.core_support_hessian(direction, changes).map(|entry| entry * self.per_unit))
    }

    #[inline]
    fn is_curved(&self) -> bool {
        matches!(self.core.kind, CoreKind::Curved)
    }
}

impl<S: SupportMap + ?Sized> CastBody for Single<'_, S> {
    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<S::Vector>) -> Option<CertainCrossing<S::Vector>> {
        self.shape.certain_crossing(line)
    }

    #[inline(always)]
    fn witness(&self, point: S::Vector) -> PointPair<S::Vector> {
        PointPair { a: point, b: Vector::ZERO }
    }

    #[inline(always)]
    fn measures(&self) -> Measures<S::Vector> {
        let Core { origin, radius, extent, error, rolling_radius, .. } = self.core;
        Measures { origin, radius, extent, rolling_radius: radius + rolling_radius, error }
    }

    fn set_scale(&mut self, scale: ScalarOf<S>) {
        self.per_unit = reciprocal_of_power(scale);
    }
}
