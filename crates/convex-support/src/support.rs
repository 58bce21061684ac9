//! The support mapping, which all convex shapes here have in common.

use num_traits::Float as _;

use crate::ball_support::swept;
use crate::numerics::bound::roundings;
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, Feature, Hint, LineQuery, Parallelotope, Rounding, Scalar,
    Vector,
};

/// A nonempty, closed, bounded convex set, known by its support mapping.
///
/// The *support point* `s(d)` in direction `d` is a point of the set farthest along `d`, and the *support value*
/// `h(d) = d·s(d)` is how far that is:
///
/// > s(d) ∈ C,  h(d) = d·s(d) = max { d·x : x ∈ C }.
///
#[doc = include_str!("../doc/support.svg")]
///
/// Support mappings compose: the support point of a Minkowski sum is the sum of the support points, that of an affine
/// image `M·C + t` is `M·s(Mᵀd) + t`, and that of a hull is the farther of two. The combinators of this crate are
/// these formulas.
///
/// # Implementing it
/// A shape of your own needs only [`support`](Self::support):
///
/// ```
/// use convex_support::{SupportMap, glam::DVec2, support_value};
///
/// /// The square |x| + |y| ≤ 1.
/// struct Diamond;
///
/// impl SupportMap for Diamond {
///     type Vector = DVec2;
///
///     fn support(&self, d: DVec2) -> DVec2 {
///         if d.x.abs() > d.y.abs() {
///             DVec2::new(d.x.signum(), 0.0)
///         } else {
///             DVec2::new(0.0, d.y.signum())
///         }
///     }
/// }
///
/// assert_eq!(Diamond.support(DVec2::new(-3.0, 1.0)), DVec2::NEG_X);
/// assert_eq!(support_value(&Diamond, DVec2::new(-3.0, 1.0)), 3.0);
/// ```
///
/// An implementor must obey these laws (up to rounding), and may only assume that `d` is finite:
/// - `support(d)` is a point of one and the same set for every `d`, and no point of that set is farther along `d`;
/// - if several points are equally far, any one may be returned; for `d = 0` any point of the set may;
/// - only the direction of `d` matters, not its length;
/// - the same argument gives the same answer, and the provided methods describe the same set.
///
/// With the feature `proptest`, `laws::hold` tests whether a shape obeys them.
///
/// Queries assume that a support point is right to four units in the last place of the shape's extent. If yours is
/// less accurate, say so in [`core`](Self::core) and [`rounding`](Self::rounding): the bounds of an answer are
/// certain only if these are right.
///
/// The other methods are optional, and only make queries faster. They describe how the shape splits into a core and a
/// radius ([`core`](Self::core)), its curvature, its closest points, and its crossings by lines. They are about the
/// core; for a whole shape, use [`closest_point`](crate::closest_point) and [`line_crossing`](crate::line_crossing).
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a convex shape",
    note = "implement `SupportMap` for it: only `support` is required"
)]
#[doc(alias("support_function", "support_mapping"))]
pub trait SupportMap {
    /// The space the set lives in: dimension and precision.
    type Vector: Vector;

    /// A point of the set farthest along `direction`, which need not be of unit length.
    fn support(&self, direction: Self::Vector) -> Self::Vector;

    /// The parts of the set: an origin, a core and a radius. Algorithms call this once for each query.
    ///
    /// The provided method takes the whole set for the core, with its origin at zero and a radius of 0, and assumes
    /// that support points are right to four units in the last place of its extent. A shape with another origin or a
    /// radius implements this and [`core_support`](Self::core_support).
    #[inline(always)]
    fn core(&self) -> Core<Self::Vector> {
        let extent = extent_along_axes(|d| self.support(d)).norm();
        Core { error: roundings(8.0, extent), ..Core::exact(CoreKind::Curved, extent) }
    }

    /// A point of the core farthest along `direction`, relative to the [origin](Core::origin).
    ///
    /// `hint` carries the result of the previous call, so that a large polytope need not start its search afresh. It
    /// never changes how far along `direction` the answer lies. The provided method is [`support`](Self::support).
    #[inline]
    fn core_support(&self, direction: Self::Vector, hint: &mut Hint) -> Self::Vector {
        let _ = hint;
        self.support(direction)
    }

    /// The curvature of the core: the entries `u·Hu`, `u·Hw` and `w·Hw` of the Hessian `H` of its support value at
    /// `direction`, which is the derivative of the support point by the direction.
    ///
    /// The provided method returns zeros, which is right at the vertices of a polytope. If a curved shape implements
    /// it, iterative methods double their digits with each step; otherwise they gain only a few.
    #[inline]
    fn core_support_hessian(&self, direction: Self::Vector, [u, w]: [Self::Vector; 2]) -> [ScalarOf<Self>; 3] {
        let _ = (direction, u, w);
        [Scalar::ZERO; 3]
    }

    /// The point of the core closest to `x`, both relative to the [origin](Core::origin), or `x` itself if it is in the
    /// core. `None`, as the provided method returns, if it would cost more than a few support points.
    ///
    /// It must be a point of the core. Algorithms check by a support point whether it is the closest one.
    #[inline]
    fn core_closest_point(&self, x: Self::Vector) -> Option<Self::Vector> {
        let _ = x;
        None
    }

    /// Where a line enters the whole set, swept by a further ball: an answer in closed form that is certain. It must
    /// hold for any rounding of the shape and of this computation, and for every line that passes within the
    /// [error](LineQuery::error) of the given one near the shape. `None`, as the provided method returns, if nothing is
    /// certain.
    ///
    /// Algorithms trust it without a check. They call it in plain numbers first. If the answer is `None`, they call it
    /// in [twice the precision](LineQuery::is_close), and then they search.
    #[inline]
    fn certain_crossing(&self, line: LineQuery<Self::Vector>) -> Option<CertainCrossing<Self::Vector>> {
        let _ = line;
        None
    }

    /// Its answer in twice the precision, about a line in such numbers: shapes of others are asked by this, so that a
    /// line loses nothing on the way through poses and maps.
    #[doc(hidden)]
    #[inline]
    fn close_crossing(&self, line: &CloseLine) -> Close {
        let _ = line;
        None
    }

    /// Adds to a feature the points of the core that lie within a slab behind its supporting plane, relative to the
    /// [origin](Core::origin): those vertices `p` with `direction·p ≥ h(direction) − slab`. So a face against the
    /// plane, or nearly so, adds its corners, and an edge its ends. The provided method adds the support point alone,
    /// as is right for a smooth surface.
    ///
    /// Where two shapes touch, their contact points follow from both features.
    fn core_support_feature(&self, direction: Self::Vector, slab: ScalarOf<Self>, feature: &mut Feature<Self::Vector>) {
        let _ = slab;
        feature.push(self.core_support(direction, &mut Hint::new()), 0);
    }

    /// The core as a parallelotope, relative to the [origin](Core::origin), if it is one and not a single point;
    /// `None`, as the provided method returns, otherwise.
    ///
    /// Its points must be as near to those of the exact core as [`rounding`](Self::rounding) says of support points. If
    /// the cores of two shapes that overlap are parallelotopes, the depth is found in closed form.
    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<Self::Vector>> {
        None
    }

    /// Bounds on the rounding errors of the core's support points. Algorithms call this once, at the end of a query, to
    /// prove the answer.
    ///
    /// The provided method finds the size of the core by support points along the axes, and assumes that every support
    /// point is right to four units in the last place of that size.
    fn rounding(&self) -> Rounding<Self::Vector> {
        Rounding::relative(extent_along_axes(|d| self.core_support(d, &mut Hint::new())), 4.0)
    }
}

/// The support value along `direction`: the largest dot product `h(d) = d·s(d)` of `direction` and a point of the
/// set, in units of length times the length of `direction`.
///
/// ```
/// use convex_support::{Ball, glam::DVec3, support_value};
///
/// let ball = Ball::<DVec3>::new(2.0)?;
/// assert_eq!(support_value(&ball, DVec3::new(0.0, 3.0, 0.0)), 6.0);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[inline]
pub fn support_value<S: SupportMap + ?Sized>(shape: &S, direction: S::Vector) -> ScalarOf<S> {
    direction.dot(shape.support(direction))
}

/// The larger of the support values along each axis, forwards and backwards.
#[inline]
fn extent_along_axes<V: Vector>(support: impl Fn(V) -> V) -> V {
    V::from_fn(|i| {
        let reach = |d: V| d.dot(support(d)).abs();
        // NaN, from a support map that is none, makes the whole extent NaN.
        let (ahead, behind) = (reach(V::axis(i)), reach(-V::axis(i)));
        if ahead < behind || behind.is_nan() { behind } else { ahead }
    })
}

/// The scalar of the space a shape lives in.
pub type ScalarOf<S> = <<S as SupportMap>::Vector as Vector>::Scalar;

/// The support point of `origin + core ⊕ ball(radius)`, for shapes that are defined by their core.
#[inline]
pub(crate) fn support_of_parts<S: SupportMap + ?Sized>(shape: &S, direction: S::Vector) -> S::Vector {
    let Core { origin, radius, .. } = shape.core();
    origin + shape.core_support(direction, &mut Hint::new()) + swept(radius, direction)
}

/// The sum of two Hessians.
#[inline(always)]
pub(crate) fn sum_of_hessians<S: Scalar>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}
