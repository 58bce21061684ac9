//! How far a point is before a plane that has a body behind it: what refutes a bound, independent of any answer.

use convex_support::{Difference, Hint, Scalar, SupportMap, Vector};

use super::AnyShape;

/// A vector in double precision, which holds the vectors of every precision exactly; zero beyond the dimension.
pub type Numbers = [f64; 3];

/// A factor and a vector. Points are told as sums of products of such pairs, so that a judge whose numbers are longer
/// does not have to take them as rounded.
pub type Term = (f64, Numbers);

/// The planes that have a body behind them, with a bound on their own rounding.
pub trait Planes {
    /// At least and at most how far a point is before the plane across `normal` that touches the body and has it
    /// behind: $(n \cdot p - h(n))/|n|$, where $h$ is the support value of the body. If it is positive, the point is
    /// not in the body.
    fn beyond(&self, normal: Numbers, point: &[Term]) -> [f64; 2];
}

/// The planes of a shape by its own support points, with the rounding that the shape states.
pub(super) struct Stated<'s, V>(pub(super) AnyShape<'s, V>);

/// How many times its own rounding a support point may be off, and the sums that are formed of it.
const ROUNDINGS: f64 = 16.0;

impl<V: Vector> Planes for Stated<'_, V> {
    fn beyond(&self, normal: Numbers, point: &[Term]) -> [f64; 2] {
        let Some(n) = V::from_fn(|i| V::Scalar::from_f64(normal[i])).unit() else {
            return [f64::NEG_INFINITY, f64::INFINITY];
        };
        let core = self.0.core();
        let reach = n.dot(self.0.core_support(n, &mut Hint::new())) + core.radius;
        let n = numbers(n);
        let terms = point.iter().copied().chain([(-1.0, numbers(core.origin))]);
        let (along, place) = terms.fold((0.0, 0.0), |(along, place), (factor, v)| {
            (along + factor * dot(n, v), place + factor.abs() * length(v))
        });
        let error = ROUNDINGS * (core.error.as_f64() + V::Scalar::EPSILON.as_f64() * (place + core.size().as_f64()));
        let value = along - reach.as_f64();
        [value - error, value + error]
    }
}

/// The planes of two bodies, and of their difference.
#[derive(Clone, Copy)]
#[allow(missing_debug_implementations, reason = "planes are functions")]
pub struct PairPlanes<'p> {
    /// Those of the first body.
    pub a: &'p dyn Planes,
    /// Those of the second body.
    pub b: &'p dyn Planes,
    /// Those of B − A. How far zero is before such a plane is how far the plane across `normal`, from `b` to `a`,
    /// separates the bodies, and how far a point `p` is, how far if `a` is moved by `p`.
    pub apart: &'p dyn Planes,
}

/// Calls `with` with the planes of two shapes by their own support points.
pub(super) fn stated<V: Vector, T>(
    a: AnyShape<'_, V>,
    b: AnyShape<'_, V>,
    with: impl FnOnce(PairPlanes<'_>) -> T,
) -> T {
    let apart = Difference::new(b, a);
    with(PairPlanes { a: &Stated(a), b: &Stated(b), apart: &Stated(&apart as &dyn SupportMap<Vector = V>) })
}

/// The coordinates of a vector.
pub(super) fn numbers<V: Vector>(v: V) -> Numbers {
    core::array::from_fn(|i| if i < V::DIM { v.get(i).as_f64() } else { 0.0 })
}

pub(super) fn dot(a: Numbers, b: Numbers) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

pub(super) fn length(v: Numbers) -> f64 {
    Vector::norm(convex_support::glam::DVec3::from_array(v))
}

/// The negative of a vector.
pub(super) fn minus(v: Numbers) -> Numbers {
    v.map(|x| -x)
}
