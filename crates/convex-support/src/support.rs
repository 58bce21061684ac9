//! The support mapping, the one thing every convex shape here has in common.

use num_traits::Float as _;

use crate::vector::is_comfortable;
use crate::{Hint, Scalar, Vector};

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
/// image `M·C + t` is `M·s(Mᵀd) + t`, and that of a hull is the farther of two. The combinators of this crate are these
/// formulas.
///
/// # Implementing it
/// [`support`](Self::support) is all a shape of your own needs:
///
/// ```
/// use convex_support::{SupportMap, glam::DVec2};
///
/// /// The square |x| + |y| ≤ 1.
/// struct Diamond;
///
/// impl SupportMap for Diamond {
///     type Vector = DVec2;
///
///     fn support(&self, d: DVec2) -> DVec2 {
///         if d.x.abs() > d.y.abs() { DVec2::new(d.x.signum(), 0.0) } else { DVec2::new(0.0, d.y.signum()) }
///     }
/// }
///
/// assert_eq!(Diamond.support(DVec2::new(-3.0, 1.0)), DVec2::NEG_X);
/// assert_eq!(Diamond.support_value(DVec2::new(-3.0, 1.0)), 3.0);
/// ```
///
/// An implementor must obey these laws (up to rounding), and may rely on nothing about `d` but that callers make it
/// finite:
/// - `support(d)` is a point of one and the same set for every `d`, and no point of that set is farther along `d`;
/// - where several points are, any one may be returned; for `d = 0` any point of the set may;
/// - only the direction of `d` matters, not its length;
/// - the same argument gives the same answer, and the provided methods describe the same set.
///
/// # Core and radius
/// A ball, a capsule and everything [rounded](crate::Rounded) is a smaller set, its *core*, swept by a ball. Iterative
/// methods converge slowly on round surfaces and finish at once on a point or a segment, so they work on the core and
/// add the radius at the end. And they work near the body rather than near the world's origin, where coordinates have
/// digits to spare. So a set is also known as
///
/// > C = o + K ⊕ B(r)
///
/// with the [`origin`](Self::origin) `o`, the core `K` given by [`core_support`](Self::core_support), and the
/// [`radius`](Self::radius) `r`. The provided methods say that `o = 0`, `r = 0` and the core is all there is; a shape
/// that overrides one of them says what its set is split into.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a convex shape",
    note = "implement `SupportMap` for it: only `support` is required"
)]
pub trait SupportMap {
    /// The space the set lives in: dimension and precision.
    type Vector: Vector;

    /// A point of the set farthest along `direction`, which need not be of unit length.
    fn support(&self, direction: Self::Vector) -> Self::Vector;

    /// How far the set reaches along `direction`: the largest dot product of `direction` and a point of the set, in
    /// units of length times the length of `direction`.
    #[inline]
    fn support_value(&self, direction: Self::Vector) -> ScalarOf<Self> {
        direction.dot(self.support(direction))
    }

    /// A point near the set, which [`core_support`](Self::core_support) is relative to.
    #[inline]
    fn origin(&self) -> Self::Vector {
        Self::Vector::ZERO
    }

    /// A point of the core farthest along `direction`, relative to the [`origin`](Self::origin).
    ///
    /// `hint` carries what the previous call found, so that a large polytope need not start its search afresh. It
    /// never changes how far along `direction` the answer lies.
    #[inline]
    fn core_support(&self, direction: Self::Vector, hint: &mut Hint) -> Self::Vector {
        let _ = hint;
        self.support(direction) - self.origin()
    }

    /// How fast the core's support point moves as the direction turns: the derivative of
    /// [`core_support`](Self::core_support) at `direction` along `change`, which is the Hessian of the core's support
    /// value times `change`.
    ///
    /// Provided: zero, as it is at the vertices of a polytope. A curved shape that says more lets iterative methods
    /// double their digits with each step, where otherwise they gain a few; a wrong answer costs time, never correctness.
    #[inline]
    fn core_support_derivative(&self, direction: Self::Vector, change: Self::Vector) -> Self::Vector {
        let _ = (direction, change);
        Self::Vector::ZERO
    }

    /// The entries `u·Hu`, `u·Hw` and `w·Hw` of the Hessian `H` of the core's support value at `direction`: its
    /// [derivative](Self::core_support_derivative) along two changes `u` and `w`, as seen along the two.
    ///
    /// Provided: by two of those derivatives. These numbers are less work than the vectors, and are what iterative methods
    /// mostly need.
    #[inline]
    fn core_support_hessian(&self, direction: Self::Vector, [u, w]: [Self::Vector; 2]) -> [ScalarOf<Self>; 3] {
        let along = |change| self.core_support_derivative(direction, change);
        let (along_u, along_w) = (along(u), along(w));
        [u.dot(along_u), u.dot(along_w), w.dot(along_w)]
    }

    /// Whether the core is a polytope, whose support point jumps from vertex to vertex and does not move in between, so that
    /// [`core_support_derivative`](Self::core_support_derivative) is always zero and need not be asked for. Provided: `false`.
    #[inline]
    fn is_core_polyhedral(&self) -> bool {
        false
    }

    /// The core where it is a single point, relative to the [`origin`](Self::origin). Provided: `None`.
    ///
    /// A ball that meets a set with a [closest point](Self::core_closest_point) needs no iteration.
    #[inline]
    fn core_point(&self) -> Option<Self::Vector> {
        None
    }

    /// The point of the core closest to `x`, both relative to the [`origin`](Self::origin), where it costs no more than a few
    /// support points. Provided: the [only point](Self::core_point), if the core is one.
    ///
    /// It must be a point of the core. Whether it is the closest one is checked by a support point, and one that is not costs
    /// time, never correctness.
    #[inline]
    fn core_closest_point(&self, x: Self::Vector) -> Option<Self::Vector> {
        let _ = x;
        self.core_point()
    }

    /// The radius of the ball that sweeps the core.
    #[inline]
    fn radius(&self) -> ScalarOf<Self> {
        ScalarOf::<Self>::ZERO
    }

    /// An upper bound on the length of every vector that [`core_support`](Self::core_support) computes with, which is
    /// what its rounding errors are proportional to. Provided: the corner of the core's bounding box.
    fn core_extent(&self) -> ScalarOf<Self> {
        let corner = Self::Vector::from_fn(|i| {
            let axis = Self::Vector::axis(i);
            let reach = |d: Self::Vector| d.dot(self.core_support(d, &mut Hint::default())).abs();
            // NaN, from a support map that is none, makes the whole extent NaN.
            let (ahead, behind) = (reach(axis), reach(-axis));
            if ahead < behind || behind.is_nan() { behind } else { ahead }
        });
        corner.norm()
    }
}

/// The scalar of the space a shape lives in.
pub type ScalarOf<S> = <<S as SupportMap>::Vector as Vector>::Scalar;

/// The support point of `origin + core ⊕ ball(radius)`, for shapes that are defined by their core.
#[inline]
pub(crate) fn support_of_parts<S: SupportMap + ?Sized>(shape: &S, direction: S::Vector) -> S::Vector {
    let core = shape.core_support(direction, &mut Hint::default());
    shape.origin() + core + swept(shape.radius(), direction)
}

/// What the rounding of `a + b` loses (Knuth's two-sum).
#[inline]
pub(crate) fn lost_in_sum<V: Vector>(a: V, b: V) -> V {
    let sum = a + b;
    let seen = sum - a;
    (a - (sum - seen)) + (b - seen)
}

/// The point of the ball of the given radius about zero farthest along `direction`.
#[inline]
pub(crate) fn swept<V: Vector>(radius: V::Scalar, direction: V) -> V {
    if radius == V::Scalar::ZERO {
        return V::ZERO;
    }
    direction.unit().unwrap_or_else(|| V::axis(0)) * radius
}

/// The derivative of [`swept`] at `direction` along `change`: with `u` the unit direction, the part of the change across
/// `u`, times the radius by the length of the direction.
#[inline(always)]
pub(crate) fn swept_derivative<V: Vector>(radius: V::Scalar, direction: V, change: V) -> V {
    if radius == V::Scalar::ZERO {
        return V::ZERO;
    }
    let squared = direction.length_squared();
    if is_comfortable(squared) {
        return (change - direction * (change.dot(direction) / squared)) * (radius / squared.sqrt());
    }
    match direction.unit() {
        Some(u) => (change - u * change.dot(u)) * (radius / direction.norm()),
        None => V::ZERO,
    }
}
