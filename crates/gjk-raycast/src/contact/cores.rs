//! The difference of two cores: its support points, how well they are known, and how far GJK comes.

use convex_support::numerics::twofold::lost_in_sum;
use convex_support::{Core, Rounding, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use super::SignedDistanceOptions;
use crate::body::{Body as _, Pair, PointPair};
use crate::gjk::{End, Frame, Gjk, GjkOptions, gjk};
use crate::symmetric::Symmetric;
use crate::unit::moderate;
use crate::{Iterate, SubAlgorithm};

/// A support point of the difference, and the points of both cores that it is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex<V> {
    pub(super) point: V,
    /// The direction it was found along.
    pub(super) along: V,
    pub(super) pair: PointPair<V>,
}

/// The difference `K = K_A − K_B` of two cores as seen from zero, in units of a power of two near its size.
pub(super) struct Cores<'a, A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> {
    pair: Pair<'a, A, B>,
    /// What both shapes are split into, in the world's unit.
    pub(super) parts: [Core<A::Vector>; 2],
    frame: Frame<A::Vector>,
    /// The sizes of both cores, their radii and their offset, in the unit.
    pub(super) size: <A::Vector as Vector>::Scalar,
    uncertainty: Uncertainty<A::Vector>,
    /// The support points computed.
    pub(super) iterations: usize,
}

/// How far the points of the difference may be from those they stand for, in the unit: what the shapes say of their own, and what
/// is lost here, coordinate by coordinate.
struct Uncertainty<V: Vector> {
    shapes: [Rounding<V>; 2],
    lost: V,
}

impl<V: Vector> Uncertainty<V> {
    /// Of the sum of two points, each rounded to the shapes' extents, and the offset of their origins. A dot product with a unit
    /// vector counts in: of `ε`, its three products and two sums lose 1.5 of their magnitudes. The sums `a − b` and `a − b + o` lose
    /// 0.5 each.
    fn new(shapes: [Rounding<V>; 2], offset: V, lost_in_offset: V) -> Self {
        let epsilon: V::Scalar = Scalar::EPSILON;
        let extents = shapes[0].extent + shapes[1].extent;
        let lost = extents * (epsilon * Scalar::from_f64(2.6)) + offset.abs() * (epsilon * Scalar::from_f64(2.1));
        Self { shapes, lost: lost + lost_in_offset.abs() }
    }

    /// Along a unit vector.
    #[inline]
    fn along(&self, n: V) -> V::Scalar {
        let n = n.abs();
        let of_shapes = self.shapes.iter().map(|shape| n.dot(shape.error).min(shape.error_length));
        of_shapes.fold(n.dot(self.lost), |sum, error| sum + error)
    }

    /// In any direction.
    fn length(&self) -> V::Scalar {
        self.shapes.iter().fold(self.lost.norm(), |sum, shape| sum + shape.error_length)
    }
}

impl<'a, A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized> Cores<'a, A, B> {
    pub(super) fn new(a: &'a A, b: &'a B) -> Self {
        let mut pair = Pair::new(a, b);
        let parts = [a.core(), b.core()];
        let [from, to] = [parts[0].origin, parts[1].origin];
        let offset = from - to;
        let size = pair.size(offset);
        // The distance of the cores is wanted even where their radii overlap.
        let frame = Frame { radius: Scalar::ZERO, ..Frame::new(&mut pair, offset, size) };
        let per_unit = frame.per_unit;
        let in_unit = |r: Rounding<A::Vector>| Rounding {
            extent: r.extent * per_unit,
            error: r.error * per_unit,
            error_length: r.error_length * per_unit,
        };
        let lost = lost_in_sum(from, -to) * per_unit;
        let uncertainty = Uncertainty::new([in_unit(a.rounding()), in_unit(b.rounding())], frame.offset, lost);
        Self { pair, parts, frame, size: size * per_unit, uncertainty, iterations: 0 }
    }

    /// What lengths in the unit are to be multiplied by.
    pub(super) fn scale(&self) -> <A::Vector as Vector>::Scalar {
        self.frame.scale
    }

    /// The support point along a direction; `None` where it is not finite.
    #[inline]
    pub(super) fn support(&mut self, direction: A::Vector) -> Option<Vertex<A::Vector>> {
        self.iterations += 1;
        let (point, pair) = self.pair.support(direction);
        let point = point + self.frame.offset;
        point.is_finite().then_some(Vertex { point, along: direction, pair })
    }

    /// The entries `u·Hu`, `u·Hw`, `w·Hw` of the Hessian of the support value at a direction.
    pub(super) fn hessian(
        &self,
        direction: A::Vector,
        changes: [A::Vector; 2],
    ) -> Symmetric<<A::Vector as Vector>::Scalar> {
        self.pair.hessian(direction, changes)
    }

    /// Whether the support point may move without jumping.
    pub(super) fn is_curved(&self) -> bool {
        self.pair.is_curved()
    }

    /// How far `n·p` may be from its true value, for a unit vector `n` and a point `p` of the difference; and by how much a
    /// support point along `n` may fall short of the support value.
    #[inline]
    pub(super) fn error_along(&self, n: A::Vector) -> <A::Vector as Vector>::Scalar {
        self.uncertainty.along(n)
    }

    /// A bound on the length of what a point `p` of the difference stands for. Along `p` it is as wrong as along any unit vector,
    /// and what it is wrong by across hardly adds to the length.
    pub(super) fn greatest_length(&self, p: A::Vector) -> <A::Vector as Vector>::Scalar {
        let error = self.uncertainty.length();
        let along = p.unit().map_or(error, |n| self.uncertainty.along(n));
        (p.norm() + along).hypot(error)
    }

    /// Whether the direction of a point of the difference is known to half the digits.
    pub(super) fn is_well_known(&self, p: A::Vector) -> bool {
        let root: <A::Vector as Vector>::Scalar = Scalar::EPSILON;
        self.uncertainty.length() < root.sqrt() * p.norm()
    }

    /// How wide a bracket on the depth along `n` rounding leaves.
    #[inline]
    pub(super) fn rounding_along(&self, n: A::Vector) -> <A::Vector as Vector>::Scalar {
        self.error_along(n) * Scalar::from_f64(2.0)
    }

    /// GJK, until the distance of the cores is known, or they meet to rounding.
    pub(super) fn approach(
        &mut self,
        options: &SignedDistanceOptions<A::Vector>,
        observer: impl FnMut(Iterate<'_, A::Vector>),
    ) -> (Gjk<A::Vector, PointPair<A::Vector>>, End) {
        let Frame { offset, per_unit, scale, .. } = self.frame;
        let first = options.axis.and_then(moderate).or_else(|| moderate(offset)).unwrap_or_else(|| Vector::axis(0));
        let mut state = Gjk::new(first);
        let closest = self.pair.closest_points(offset * scale, self.size * scale);
        let meet = closest.is_some_and(|points| state.begin_at(points.a - points.b + offset, points, &self.frame));
        let options = GjkOptions {
            first: state.normal,
            limit: (options.limit + self.pair.radius()) * per_unit,
            tolerance: Scalar::ZERO,
            closest_points: true,
            max_iterations: options.max_iterations,
            sub_algorithm: SubAlgorithm::Regions,
        };
        let end =
            if meet { End::Overlap } else { gjk(&mut state, &mut self.pair, self.frame, options, None, observer) };
        state.ensure_measured();
        self.iterations = state.iterations;
        (state, end)
    }
}
