//! Two bodies as a search sees them: behind one pointer, so that the search is compiled once for all shapes, and as
//! their difference, which is a [body](crate::body) itself.

use convex_support::{
    CertainCrossing, Core, CoreKind, Hint, LineQuery, Parallelotope, Rounding, Scalar, ScalarOf, SupportMap, Vector,
};

use crate::body::{CastBody, Measures, PointPair, TracedSupport};
use crate::segments;
use crate::symmetric::Symmetric;
use crate::unit::{is_moderate, reciprocal_of_power};

type ScalarIn<T> = <<T as Shapes>::Vector as Vector>::Scalar;

/// A shape behind a pointer, mostly [without line crossings](WithoutLines).
pub(crate) type Shape<'s, V> = &'s dyn SupportMap<Vector = V>;

/// A shape for distances and depths, which need neither its crossings by lines nor its feature.
///
/// All methods of a shape behind a pointer are compiled into a program, whether it calls them or not. The closed forms
/// of line crossings are as much code as the whole search for a distance, so they are left out here.
#[derive(Clone, Copy)]
pub(crate) struct WithoutLines<'s, S: ?Sized>(pub(crate) &'s S);

impl<S: SupportMap + ?Sized> SupportMap for WithoutLines<'_, S> {
    type Vector = S::Vector;

    #[inline]
    fn support(&self, direction: S::Vector) -> S::Vector {
        self.0.support(direction)
    }

    #[inline]
    fn core(&self) -> Core<S::Vector> {
        self.0.core()
    }

    #[inline]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        self.0.core_support(direction, hint)
    }

    #[inline]
    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        self.0.core_support_hessian(direction, changes)
    }

    #[inline]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        self.0.core_closest_point(x)
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<S::Vector>> {
        self.0.core_parallelotope()
    }

    #[inline]
    fn rounding(&self) -> Rounding<S::Vector> {
        self.0.rounding()
    }
}

/// One of two shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Of {
    A,
    B,
}

/// Two shapes for a search: behind one pointer, so that it is compiled once for all shapes, and a support point of
/// their difference is one call.
pub(crate) trait Shapes {
    type Vector: Vector;

    fn cores(&self) -> [Core<Self::Vector>; 2];
    /// The support points of both cores, each along a direction of its own.
    fn support_points(&self, along: [Self::Vector; 2], hints: &mut [Hint; 2]) -> [Aligned<Self::Vector>; 2];
    /// As [`SupportMap::core_support_hessian`] of both, each along a direction of its own. In one call: for each call
    /// that gets them, the changes are copied, and the copy waits until they are in the cache.
    fn support_hessians(&self, along: [Self::Vector; 2], changes: [Self::Vector; 2]) -> [[ScalarIn<Self>; 3]; 2];
    /// As [`SupportMap::core_closest_point`] of one of them.
    fn closest_point(&self, of: Of, x: Self::Vector) -> Option<Self::Vector>;
    /// As [`SupportMap::certain_crossing`] of one of them.
    fn certain_crossing(&self, _: Of, _: LineQuery<Self::Vector>) -> Option<CertainCrossing<Self::Vector>> {
        None
    }
    /// Each of them, for rare queries.
    fn each(&self) -> [Shape<'_, Self::Vector>; 2];
}

/// A vector in memory that shares no 16 bytes with another one. Side by side, the compiler reads the end of one and the
/// beginning of the next by one load, which waits until the two stores that wrote them are in the cache: rounded boxes
/// took 8 % longer.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(16))]
pub(crate) struct Aligned<V>(pub(crate) V);

/// Two shapes of known types, with line crossings or, where those are not needed, [without](WithoutLines).
pub(crate) struct Both<'a, A: ?Sized, B: ?Sized, const LINES: bool = false> {
    a: WithoutLines<'a, A>,
    b: WithoutLines<'a, B>,
    /// Whether they are taken in the other order.
    pub(crate) is_swapped: bool,
}

impl<'a, A: ?Sized, B: ?Sized, const LINES: bool> Both<'a, A, B, LINES> {
    #[inline(always)]
    pub(crate) fn new(a: &'a A, b: &'a B) -> Self {
        Self { a: WithoutLines(a), b: WithoutLines(b), is_swapped: false }
    }

    /// Converts one of the two to the order of the call.
    #[inline(always)]
    fn named(&self, of: Of) -> Of {
        if self.is_swapped == (of == Of::A) { Of::B } else { Of::A }
    }
}

impl<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized, const LINES: bool> Shapes
    for Both<'_, A, B, LINES>
{
    type Vector = A::Vector;

    #[inline(always)]
    fn cores(&self) -> [Core<A::Vector>; 2] {
        let mut cores = [self.a.0.core(), self.b.0.core()];
        if self.is_swapped {
            cores.reverse();
        }
        cores
    }

    #[inline(always)]
    fn support_points(
        &self,
        [along_a, along_b]: [A::Vector; 2],
        [hint_a, hint_b]: &mut [Hint; 2],
    ) -> [Aligned<A::Vector>; 2] {
        let (along_a, along_b) = if self.is_swapped { (along_b, along_a) } else { (along_a, along_b) };
        let (a, b) = (self.a.0.core_support(along_a, hint_a), self.b.0.core_support(along_b, hint_b));
        if self.is_swapped { [Aligned(b), Aligned(a)] } else { [Aligned(a), Aligned(b)] }
    }

    #[inline(always)]
    fn support_hessians(&self, [along_a, along_b]: [A::Vector; 2], changes: [A::Vector; 2]) -> [[ScalarOf<A>; 3]; 2] {
        let (along_a, along_b) = if self.is_swapped { (along_b, along_a) } else { (along_a, along_b) };
        let a = self.a.0.core_support_hessian(along_a, changes);
        let b = self.b.0.core_support_hessian(along_b, changes);
        if self.is_swapped { [b, a] } else { [a, b] }
    }

    #[inline(always)]
    fn closest_point(&self, of: Of, x: A::Vector) -> Option<A::Vector> {
        match self.named(of) {
            Of::A => self.a.0.core_closest_point(x),
            Of::B => self.b.0.core_closest_point(x),
        }
    }

    #[inline(always)]
    fn certain_crossing(&self, of: Of, line: LineQuery<A::Vector>) -> Option<CertainCrossing<A::Vector>> {
        match self.named(of) {
            _ if !LINES => None,
            Of::A => self.a.0.certain_crossing(line),
            Of::B => self.b.0.certain_crossing(line),
        }
    }

    #[inline(always)]
    fn each(&self) -> [Shape<'_, A::Vector>; 2] {
        if self.is_swapped { [&self.b, &self.a] } else { [&self.a, &self.b] }
    }
}

impl<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> Both<'_, A, B> {
    /// The two bodies in order, and their cores, which are given in the order of the call.
    #[inline(always)]
    pub(crate) fn in_order(mut self, [a, b]: [&Core<A::Vector>; 2]) -> (Self, [&Core<A::Vector>; 2]) {
        self.is_swapped = comes_first(b, a);
        let cores = if self.is_swapped { [b, a] } else { [a, b] };
        (self, cores)
    }
}

/// Whether a body comes before another: it is larger, or as large and its origin is greater.
///
/// If bodies touch, rounding decides what is found, and the difference `A − B` is not rounded like `B − A`. The larger
/// body comes first, in either order of the call, so that all queries about one pair decide alike.
#[inline(always)]
fn comes_first<V: Vector>(a: &Core<V>, b: &Core<V>) -> bool {
    if a.extent != b.extent {
        return a.extent > b.extent;
    }
    if a.radius != b.radius {
        return a.radius > b.radius;
    }
    let other = (0..V::DIM).find(|&i| a.origin.get(i) != b.origin.get(i));
    other.is_some_and(|i| a.origin.get(i) > b.origin.get(i))
}

/// The difference of two shapes, whose support points keep both shapes' points.
///
/// It borrows the cores. A copy that is made right after they were written waits until all of them is in the cache,
/// which took 7 % of the distance of two boxes.
pub(crate) struct Pair<'a, T: Shapes + ?Sized> {
    pub(crate) shapes: &'a T,
    pub(crate) core_a: &'a Core<T::Vector>,
    pub(crate) core_b: &'a Core<T::Vector>,
    hints: [Hint; 2],
    per_unit: ScalarIn<T>,
    /// The radius of a ball that the difference is swept by; the first core's radius includes it.
    swept: ScalarIn<T>,
    /// The radii of balls by which the cores are reduced, in units of the scale.
    pub(crate) peeled: [ScalarIn<T>; 2],
}

/// The difference of any two shapes.
pub(crate) type AnyPair<'a, V> = Pair<'a, dyn Shapes<Vector = V> + 'a>;

impl<V: Vector> AnyPair<'_, V> {
    /// The [closest points](Self::closest_points) for searches, which mostly have none, compiled once for all of them.
    #[inline(never)]
    pub(crate) fn closest_points_for_search(&self, offset: V, size: V::Scalar) -> Option<PointPair<V>> {
        self.closest_points(offset, size)
    }
}

impl<'a, T: Shapes + ?Sized> Pair<'a, T> {
    #[inline(always)]
    pub(crate) fn new(shapes: &'a T, [core_a, core_b]: [&'a Core<T::Vector>; 2]) -> Self {
        Self {
            shapes,
            core_a,
            core_b,
            hints: [Hint::new(), Hint::new()],
            per_unit: Scalar::ONE,
            swept: Scalar::ZERO,
            peeled: [Scalar::ZERO; 2],
        }
    }
}

impl<T: Shapes + ?Sized> Pair<'_, T> {
    /// The difference swept by a ball, by which the first core is [rounded](Core::rounded) already.
    #[inline(always)]
    pub(crate) fn swept(self, radius: ScalarIn<T>) -> Self {
        Self { swept: radius, ..self }
    }

    pub(crate) fn forget_hints(&mut self) {
        self.hints = [Hint::new(), Hint::new()];
    }

    #[inline(always)]
    pub(crate) fn radius(&self) -> ScalarIn<T> {
        self.core_a.radius + self.core_b.radius
    }

    #[inline(always)]
    pub(crate) fn extent(&self) -> ScalarIn<T> {
        self.core_a.extent + self.core_b.extent
    }

    /// The sum of the errors of the support points.
    #[inline(always)]
    pub(crate) fn error(&self) -> ScalarIn<T> {
        self.core_a.error + self.core_b.error
    }

    /// A bound on all lengths that rounding errors are relative to, for bodies whose origins differ by `offset`.
    #[inline]
    pub(crate) fn size(&self, offset: T::Vector) -> ScalarIn<T> {
        self.extent() + self.radius() + offset.norm()
    }

    /// Points of the cores that are closest to one another, in units of the scale, if one core is a point and the other
    /// has a closed form for its closest point, or both are segments. For bodies of the given [size](Self::size) whose
    /// origins differ by `offset`, both in the world's unit.
    #[inline(always)]
    pub(crate) fn closest_points(&self, offset: T::Vector, size: ScalarIn<T>) -> Option<PointPair<T::Vector>> {
        let (a, b) = match (self.core_a.kind, self.core_b.kind) {
            (CoreKind::Point(a), CoreKind::Point(b)) => (a, b),
            (CoreKind::Point(a), _) => (a, self.shapes.closest_point(Of::B, a + offset)?),
            (_, CoreKind::Point(b)) => (self.shapes.closest_point(Of::A, b - offset)?, b),
            (CoreKind::Segment { middle: a, half: u }, CoreKind::Segment { middle: b, half: w }) => {
                let (x, y) = segments::closest_points(u, w, offset - (b - a));
                (a + x, b + y)
            }
            _ => return None,
        };
        // For larger or smaller numbers the closed forms may have left the range of the scalar.
        is_moderate(size).then(|| PointPair { a: a * self.per_unit, b: b * self.per_unit })
    }

    /// Both cores as parallelotopes, relative to their origins, if they are; a point is one without edges.
    #[inline]
    pub(crate) fn parallelotopes(&self) -> Option<[Parallelotope<T::Vector>; 2]> {
        let of = |shape: Shape<'_, T::Vector>, core: &Core<T::Vector>| match core.kind {
            CoreKind::Point(at) => Some(Parallelotope::point(at)),
            CoreKind::Segment { .. } | CoreKind::Polytope => shape.core_parallelotope(),
            CoreKind::Curved => None,
        };
        let [a, b] = self.shapes.each();
        Some([of(a, self.core_a)?, of(b, self.core_b)?])
    }

    /// The same for two bodies that may overlap, with origins that differ by `offset` in the unit.
    #[inline(always)]
    pub(crate) fn parallelotopes_within_reach(&self, offset: T::Vector) -> Option<[Parallelotope<T::Vector>; 2]> {
        let reach = self.extent() * self.per_unit;
        // Balls about the cores are apart.
        if offset.length_squared() > reach * reach { None } else { self.parallelotopes() }
    }

    /// The vector between the [closest points](Self::closest_points) of bodies whose origins differ by `offset` in the
    /// unit, which is along the normal of the plane between them.
    #[inline(always)]
    pub(crate) fn vector_between(&self, PointPair { a, b }: PointPair<T::Vector>, offset: T::Vector) -> T::Vector {
        let v = a - b + offset;
        let between = |[u, w]: [T::Vector; 2], [x, y]: [T::Vector; 2]| {
            let [u, w, x, y] = [u, w, x, y].map(|v| v * self.per_unit);
            segments::normal_between([u, w], [x, y], [a, b], v)
        };
        match (self.core_a.kind, self.core_b.kind) {
            (CoreKind::Segment { middle: x, half: u }, CoreKind::Segment { middle: y, half: w }) => {
                between([u, w], [x, y])
            }
            // A point counts as a segment without length.
            (CoreKind::Segment { middle: x, half: u }, CoreKind::Point(y)) => between([u, Vector::ZERO], [x, y]),
            (CoreKind::Point(x), CoreKind::Segment { middle: y, half: w }) => between([Vector::ZERO, w], [x, y]),
            _ => v,
        }
    }
}

impl<V> PointPair<V> {
    /// The same for the two in the other order.
    pub(crate) fn reversed(self) -> Self {
        Self { a: self.b, b: self.a }
    }
}

impl<V: Vector> PointPair<V> {
    pub(crate) const ZERO: Self = Self { a: V::ZERO, b: V::ZERO };

    /// The sum with a multiple of another.
    #[inline]
    pub(crate) fn plus(self, other: Self, weight: V::Scalar) -> Self {
        Self { a: self.a + other.a * weight, b: self.b + other.b * weight }
    }
}

impl<T: Shapes + ?Sized> TracedSupport for Pair<'_, T> {
    type Vector = T::Vector;

    #[inline(always)]
    fn support(&mut self, direction: T::Vector) -> (T::Vector, PointPair<T::Vector>) {
        for hint in &mut self.hints {
            hint.rewind();
        }
        let points = self.shapes.support_points([direction, -direction], &mut self.hints);
        let [a, b] = points.map(|Aligned(point)| point * self.per_unit);
        let [from_a, from_b] = self.peeled;
        if !(from_a + from_b > Scalar::ZERO) {
            return (a - b, PointPair { a, b });
        }
        // The support point of a core reduced by a ball, along a unit vector `u`, is that of the whole less `r·u`.
        let u = direction.unit().unwrap_or(direction);
        let (a, b) = (a - u * from_a, b + u * from_b);
        (a - b, PointPair { a, b })
    }

    #[inline(always)]
    fn hessian(&self, direction: T::Vector, changes: [T::Vector; 2]) -> Symmetric<ScalarIn<T>> {
        let [a, b] = self.shapes.support_hessians([direction, -direction], changes);
        let whole = [0, 1, 2].map(|i| (a[i] + b[i]) * self.per_unit);
        without_ball(Symmetric::of(whole), self.peeled[0] + self.peeled[1], direction, changes)
    }

    #[inline]
    fn is_curved(&self) -> bool {
        matches!(self.core_a.kind, CoreKind::Curved) || matches!(self.core_b.kind, CoreKind::Curved)
    }
}

impl<T: Shapes + ?Sized> CastBody for Pair<'_, T> {
    /// Known if one of the cores is a point, which has an error. A point of the line is in the difference if `b`, moved
    /// there by its origin, meets `a`.
    // Called through a pointer; a linker that resolves it would copy all of this to each call.
    #[inline(never)]
    fn certain_crossing(&self, line: LineQuery<T::Vector>) -> Option<CertainCrossing<T::Vector>> {
        let (core_a, core_b, zero) = (self.core_a, self.core_b, T::Vector::ZERO);
        let (of, line) = match (core_a.kind, core_b.kind) {
            (_, CoreKind::Point(b)) => {
                let line = line.seen_from([zero, -b]).within(core_b.error);
                (Of::A, line.sweeping(core_b.radius).sweeping(self.swept))
            }
            (CoreKind::Point(a), _) => {
                // Relative to `b`, `a` moves, and backwards.
                let from_b = line.seen_from([core_b.origin, zero]);
                let line = LineQuery { source: -from_b.source, direction: -from_b.direction, ..from_b };
                let line = line.seen_from([-core_a.origin, -a]).within(core_a.error);
                (Of::B, line.sweeping(core_a.radius))
            }
            _ => return None,
        };
        // Called at one place, because it is compiled for each pair of shapes.
        let crossing = self.shapes.certain_crossing(of, line)?;
        Some(if of == Of::B { crossing.with_normal(|n| -n) } else { crossing })
    }

    fn hessian_of_first(&self, direction: T::Vector, changes: [T::Vector; 2]) -> Symmetric<ScalarIn<T>> {
        let [whole, _] = self.shapes.support_hessians([direction, -direction], changes);
        without_ball(Symmetric::of(whole.map(|entry| entry * self.per_unit)), self.peeled[0], direction, changes)
    }

    #[inline(always)]
    fn witness(&self, point: T::Vector) -> PointPair<T::Vector> {
        match (self.core_a.kind, self.core_b.kind) {
            (_, CoreKind::Point(b)) => PointPair { a: point + b * self.per_unit, b: b * self.per_unit },
            (CoreKind::Point(a), _) => PointPair { a: a * self.per_unit, b: a * self.per_unit - point },
            _ => PointPair::ZERO,
        }
    }

    #[inline(always)]
    fn measures(&self) -> Measures<T::Vector> {
        let [radius, extent, error] = [self.radius(), self.extent(), self.error()];
        let rolling_radius = radius + (self.core_a.rolling_radius + self.core_b.rolling_radius);
        Measures { origin: self.core_a.origin, radius, extent, rolling_radius, error }
    }

    fn set_scale(&mut self, scale: ScalarIn<T>) {
        self.per_unit = reciprocal_of_power(scale);
    }
}

/// The Hessian without that of a ball of the given radius, at a direction and along two changes of it.
fn without_ball<V: Vector>(
    hessian: Symmetric<V::Scalar>,
    radius: V::Scalar,
    direction: V,
    changes: [V; 2],
) -> Symmetric<V::Scalar> {
    let Some(e) = direction.unit().filter(|_| radius > Scalar::ZERO) else { return hessian };
    let across = |change: V| change - e * change.dot(e);
    let (u, w) = (across(changes[0]), across(changes[1]));
    let bend = radius / direction.norm();
    let Symmetric { a, b, d } = hessian;
    Symmetric { a: a - bend * u.dot(u), b: b - bend * u.dot(w), d: d - bend * w.dot(w) }
}
