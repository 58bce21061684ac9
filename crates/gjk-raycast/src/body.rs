//! Shapes as algorithms see them: a core and a radius, relative to the shape's origin and in [units](crate::unit) of its size.

use convex_support::{Core, CoreKind, Crossing, Hint, LineCrossing, Scalar, SupportMap, Vector};

use crate::segments;
use crate::symmetric::Symmetric;
use crate::unit::{is_moderate, reciprocal_of_power};

/// The support map of a core, whose points remember what they are made of: all that GJK asks of a body.
pub(crate) trait TracedSupport {
    type Vector: Vector;

    /// The support point, relative to the body's origin and in its unit, and the points of both shapes that it is the difference of.
    fn support(&mut self, direction: Self::Vector) -> (Self::Vector, PointPair<Self::Vector>);
    /// The Hessian `H` of the support value, how fast the support point moves as the direction turns, as seen along two changes
    /// `u` and `w`: the entries `u·Hu`, `u·Hw` and `w·Hw`.
    fn hessian(
        &self,
        direction: Self::Vector,
        changes: [Self::Vector; 2],
    ) -> Symmetric<<Self::Vector as Vector>::Scalar>;
    /// Whether that may be anything but zero.
    fn is_curved(&self) -> bool;
}

/// A core and its radius, as casts see them.
pub(crate) trait Body: TracedSupport {
    /// Where the line through `source` along `direction` is in the body, in closed form; lengths in units of `scale`.
    #[inline(always)]
    fn line_crossing(&self, source: Self::Vector, direction: Self::Vector) -> LineCrossing<Self::Vector> {
        self.eroded_line_crossing(source, direction, Scalar::ZERO)
    }
    /// The same, of a set that is in the body even when it is swept by a ball of radius `by`.
    fn eroded_line_crossing(
        &self,
        source: Self::Vector,
        direction: Self::Vector,
        by: <Self::Vector as Vector>::Scalar,
    ) -> LineCrossing<Self::Vector>;
    /// What a point of the core is made of, where [`line_crossing`](Self::line_crossing) is known.
    fn witness(&self, point: Self::Vector) -> PointPair<Self::Vector>;
    /// What positions are relative to, in the world; for a difference, that of the first shape alone, since subtracting
    /// the other's would round.
    fn origin(&self) -> Self::Vector;
    /// The radius around the core, in the world's unit.
    fn radius(&self) -> <Self::Vector as Vector>::Scalar;
    /// A bound on the length of all vectors that support points of the core are computed from, in the world's unit.
    fn extent(&self) -> <Self::Vector as Vector>::Scalar;
    /// The radius of a ball that rolls within all of the body, in the world's unit.
    fn rolling_radius(&self) -> <Self::Vector as Vector>::Scalar;
    /// A bound on what rounding has moved the support points of the core by, in the world's unit.
    fn error(&self) -> <Self::Vector as Vector>::Scalar;
    /// Sets the unit to the given power of two.
    fn set_scale(&mut self, scale: <Self::Vector as Vector>::Scalar);
}

/// One shape.
pub(crate) struct Single<'a, S: SupportMap + ?Sized> {
    shape: &'a S,
    core: Core<S::Vector>,
    hint: Hint,
    per_unit: <S::Vector as Vector>::Scalar,
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
    fn hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> Symmetric<<S::Vector as Vector>::Scalar> {
        let [a, b, d] = self.shape.core_support_hessian(direction, changes).map(|entry| entry * self.per_unit);
        Symmetric { a, b, d }
    }

    #[inline]
    fn is_curved(&self) -> bool {
        matches!(self.core.kind, CoreKind::Curved)
    }
}

impl<S: SupportMap + ?Sized> Body for Single<'_, S> {
    #[inline(always)]
    fn eroded_line_crossing(
        &self,
        source: S::Vector,
        direction: S::Vector,
        by: <S::Vector as Vector>::Scalar,
    ) -> LineCrossing<S::Vector> {
        let to_world = reciprocal_of_power(self.per_unit);
        let radius = self.core.radius - by * to_world;
        in_units(self.shape.core_line_crossing(source * to_world, direction, radius), self.per_unit)
    }

    #[inline(always)]
    fn witness(&self, point: S::Vector) -> PointPair<S::Vector> {
        PointPair { a: point, b: Vector::ZERO }
    }

    fn origin(&self) -> S::Vector {
        self.core.origin
    }

    fn radius(&self) -> <S::Vector as Vector>::Scalar {
        self.core.radius
    }

    fn extent(&self) -> <S::Vector as Vector>::Scalar {
        self.core.extent
    }

    fn rolling_radius(&self) -> <S::Vector as Vector>::Scalar {
        self.core.radius + self.core.rolling_radius
    }

    fn error(&self) -> <S::Vector as Vector>::Scalar {
        self.core.error
    }

    fn set_scale(&mut self, scale: <S::Vector as Vector>::Scalar) {
        self.per_unit = reciprocal_of_power(scale);
    }
}

/// The difference of two shapes, whose support points remember both shapes' points.
pub(crate) struct Pair<'a, A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> {
    pub(crate) a: &'a A,
    pub(crate) b: &'a B,
    pub(crate) core_a: Core<A::Vector>,
    pub(crate) core_b: Core<A::Vector>,
    hint_a: Hint,
    hint_b: Hint,
    per_unit: <A::Vector as Vector>::Scalar,
}

impl<'a, A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> Pair<'a, A, B> {
    #[inline]
    pub(crate) fn new(a: &'a A, b: &'a B) -> Self {
        Self::of_cores(a, b, [a.core(), b.core()])
    }

    /// The same of shapes that have been asked for their cores.
    #[inline(always)]
    pub(crate) fn of_cores(a: &'a A, b: &'a B, [core_a, core_b]: [Core<A::Vector>; 2]) -> Self {
        Self { a, b, core_a, core_b, hint_a: Hint::new(), hint_b: Hint::new(), per_unit: Scalar::ONE }
    }
}

impl<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> Pair<'_, A, B> {
    /// A bound on all lengths that rounding errors are relative to, for bodies whose origins differ by `offset`.
    #[inline]
    pub(crate) fn size(&self, offset: A::Vector) -> <A::Vector as Vector>::Scalar {
        self.extent() + self.radius() + offset.norm()
    }

    /// Points of the cores that are closest to one another, in units of the scale, where one core is a point and the other
    /// says its closest one, or both are segments. For bodies of the given [size](Self::size) whose origins differ by `offset`, both in the world's unit.
    #[inline(always)]
    pub(crate) fn closest_points(
        &self,
        offset: A::Vector,
        size: <A::Vector as Vector>::Scalar,
    ) -> Option<PointPair<A::Vector>> {
        let (a, b) = match (self.core_a.kind, self.core_b.kind) {
            (CoreKind::Point(a), CoreKind::Point(b)) => (a, b),
            (CoreKind::Point(a), _) => (a, self.b.core_closest_point(a + offset)?),
            (_, CoreKind::Point(b)) => (self.a.core_closest_point(b - offset)?, b),
            (CoreKind::Segment { middle: a, half: u }, CoreKind::Segment { middle: b, half: w }) => {
                let (x, y) = segments::closest_points(u, w, offset - (b - a));
                (a + x, b + y)
            }
            _ => return None,
        };
        // What closed forms compute of larger or smaller numbers may have left the range of the scalar.
        is_moderate(size).then(|| PointPair { a: a * self.per_unit, b: b * self.per_unit })
    }

    /// The vector between the [closest points](Self::closest_points) of bodies whose origins differ by `offset` in the unit, which is along the
    /// normal of the plane between them.
    #[inline(always)]
    pub(crate) fn vector_between(&self, PointPair { a, b }: PointPair<A::Vector>, offset: A::Vector) -> A::Vector {
        let v = a - b + offset;
        let between = |[u, w]: [A::Vector; 2], [x, y]: [A::Vector; 2]| {
            let [u, w, x, y] = [u, w, x, y].map(|v| v * self.per_unit);
            segments::normal_between([u, w], [x, y], [a, b], v)
        };
        match (self.core_a.kind, self.core_b.kind) {
            (CoreKind::Segment { middle: x, half: u }, CoreKind::Segment { middle: y, half: w }) => {
                between([u, w], [x, y])
            }
            // A point is a segment without length.
            (CoreKind::Segment { middle: x, half: u }, CoreKind::Point(y)) => between([u, Vector::ZERO], [x, y]),
            (CoreKind::Point(x), CoreKind::Segment { middle: y, half: w }) => between([Vector::ZERO, w], [x, y]),
            _ => v,
        }
    }
}

/// The core points of two shapes, each relative to its shape's origin, in units of the scale.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PointPair<V> {
    pub(crate) a: V,
    pub(crate) b: V,
}

impl<V> PointPair<V> {
    /// The same of the two in the other order.
    pub(crate) fn reversed(self) -> Self {
        Self { a: self.b, b: self.a }
    }
}

impl<V: Vector> PointPair<V> {
    /// The sum with a multiple of another.
    #[inline]
    pub(crate) fn plus(self, other: Self, weight: V::Scalar) -> Self {
        Self { a: self.a + other.a * weight, b: self.b + other.b * weight }
    }
}

impl<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> TracedSupport for Pair<'_, A, B> {
    type Vector = A::Vector;

    #[inline(always)]
    fn support(&mut self, direction: A::Vector) -> (A::Vector, PointPair<A::Vector>) {
        self.hint_a.rewind();
        self.hint_b.rewind();
        let a = self.a.core_support(direction, &mut self.hint_a) * self.per_unit;
        let b = self.b.core_support(-direction, &mut self.hint_b) * self.per_unit;
        (a - b, PointPair { a, b })
    }

    #[inline(always)]
    fn hessian(&self, direction: A::Vector, changes: [A::Vector; 2]) -> Symmetric<<A::Vector as Vector>::Scalar> {
        let a = self.a.core_support_hessian(direction, changes);
        let b = self.b.core_support_hessian(-direction, changes);
        let sum = |i: usize| (a[i] + b[i]) * self.per_unit;
        Symmetric { a: sum(0), b: sum(1), d: sum(2) }
    }

    #[inline]
    fn is_curved(&self) -> bool {
        matches!(self.core_a.kind, CoreKind::Curved) || matches!(self.core_b.kind, CoreKind::Curved)
    }
}

impl<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> Body for Pair<'_, A, B> {
    /// Known where one of the cores is a point, and the difference is the other body moved, or turned round and moved.
    #[inline(always)]
    fn eroded_line_crossing(
        &self,
        source: A::Vector,
        direction: A::Vector,
        by: <A::Vector as Vector>::Scalar,
    ) -> LineCrossing<A::Vector> {
        let to_world = reciprocal_of_power(self.per_unit);
        let (source, radius) = (source * to_world, self.radius() - by * to_world);
        let crossing = match (self.core_a.kind, self.core_b.kind) {
            (_, CoreKind::Point(b)) => self.a.core_line_crossing(source + b, direction, radius),
            (CoreKind::Point(a), _) => match self.b.core_line_crossing(a - source, -direction, radius) {
                LineCrossing::Crosses(at) => LineCrossing::Crosses(Crossing { normal: -at.normal, ..at }),
                other => other,
            },
            _ => LineCrossing::Unknown,
        };
        in_units(crossing, self.per_unit)
    }

    #[inline(always)]
    fn witness(&self, point: A::Vector) -> PointPair<A::Vector> {
        match (self.core_a.kind, self.core_b.kind) {
            (_, CoreKind::Point(b)) => PointPair { a: point + b * self.per_unit, b: b * self.per_unit },
            (CoreKind::Point(a), _) => PointPair { a: a * self.per_unit, b: a * self.per_unit - point },
            _ => PointPair::default(),
        }
    }

    fn origin(&self) -> A::Vector {
        self.core_a.origin
    }

    #[inline]
    fn radius(&self) -> <A::Vector as Vector>::Scalar {
        self.core_a.radius + self.core_b.radius
    }

    #[inline]
    fn extent(&self) -> <A::Vector as Vector>::Scalar {
        self.core_a.extent + self.core_b.extent
    }

    fn rolling_radius(&self) -> <A::Vector as Vector>::Scalar {
        self.radius() + (self.core_a.rolling_radius + self.core_b.rolling_radius)
    }

    #[inline]
    fn error(&self) -> <A::Vector as Vector>::Scalar {
        self.core_a.error + self.core_b.error
    }

    fn set_scale(&mut self, scale: <A::Vector as Vector>::Scalar) {
        self.per_unit = reciprocal_of_power(scale);
    }
}

/// A crossing in units of the scale.
#[inline(always)]
fn in_units<V: Vector>(crossing: LineCrossing<V>, per_unit: V::Scalar) -> LineCrossing<V> {
    match crossing {
        LineCrossing::Crosses(Crossing { entry, exit, normal }) => {
            LineCrossing::Crosses(Crossing { entry: entry * per_unit, exit: exit * per_unit, normal })
        }
        other => other,
    }
}
