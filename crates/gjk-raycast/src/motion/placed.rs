//! A shape at a place on its way, two moving bodies at one time, and the corners that are closest at that time.

use core::cell::Cell;

use convex_support::{Core, CoreKind, Feature, Hint, Matrix, Parallelotope, Rounding, Scalar, SupportMap, Vector};

use crate::body::PointPair;
use crate::pair::{Aligned, Of, Pair, Shape, Shapes};
use crate::separation::{Uncertainty, across_corners};
use crate::simplex::{MAX_POINTS, project};

/// A shape turned by a rotation, with its origin put at a given point, and with a radius that may be larger than its
/// own.
pub(crate) struct Moved<'s, V: Vector> {
    shape: Shape<'s, V>,
    /// The rotation about the origin; `None` for a shape as it is.
    rotation: Option<V::Matrix>,
    core: Core<V>,
    /// A bound on the length of the error that moving the shape adds to its points.
    error: V::Scalar,
}

impl<'s, V: Vector> Moved<'s, V> {
    /// The shape with the given core, turned by `rotation` about the origin. The core may have another origin and
    /// another radius than that of the shape. The place that it was moved to is wrong by no more than `error`.
    #[inline(always)]
    pub(crate) fn new(shape: Shape<'s, V>, core: Core<V>, rotation: Option<V::Matrix>, error: V::Scalar) -> Self {
        let Some(matrix) = rotation else {
            let core = Core { error: core.error + error, ..core };
            return Self { shape, rotation, core, error };
        };
        let kind = match core.kind {
            CoreKind::Point(at) => CoreKind::Point(matrix * at),
            CoreKind::Segment { middle, half } => CoreKind::Segment { middle: matrix * middle, half: matrix * half },
            kind => kind,
        };
        // A rotation keeps the length of an error. Its product with a point is wrong by no more than three ε of the
        // extent, and the support value along a turned direction by as much again.
        let error = error + V::Scalar::from_f64(6.0) * Scalar::EPSILON * core.extent;
        Self { shape, rotation, core: Core { kind, error: core.error + error, ..core }, error }
    }

    /// A vector of the shape, turned with it.
    #[inline(always)]
    pub(super) fn turned(&self, vector: V) -> V {
        self.rotation.map_or(vector, |rotation| rotation * vector)
    }

    #[inline(always)]
    pub(super) fn turned_box(&self, Parallelotope { center, half_edges }: &Parallelotope<V>) -> Parallelotope<V> {
        let [x, y, z] = half_edges;
        let half_edges = [self.turned(*x), self.turned(*y), self.turned(*z)];
        Parallelotope { center: self.turned(*center), half_edges }
    }

    /// A vector of the turned shape, turned back.
    #[inline(always)]
    pub(super) fn before(&self, vector: V) -> V {
        self.rotation.map_or(vector, |rotation| rotation.transpose_mul(vector))
    }
}

impl<V: Vector> SupportMap for Moved<'_, V> {
    type Vector = V;

    fn support(&self, direction: V) -> V {
        let swept = direction.unit().unwrap_or_else(|| Vector::axis(0)) * self.core.radius;
        self.core.origin + self.core_support(direction, &mut Hint::new()) + swept
    }

    #[inline]
    fn core(&self) -> Core<V> {
        self.core
    }

    #[inline(always)]
    fn core_support(&self, direction: V, hint: &mut Hint) -> V {
        self.turned(self.shape.core_support(self.before(direction), hint))
    }

    #[inline(always)]
    fn core_support_hessian(&self, direction: V, changes: [V; 2]) -> [V::Scalar; 3] {
        self.shape.core_support_hessian(self.before(direction), [self.before(changes[0]), self.before(changes[1])])
    }

    #[inline(always)]
    fn core_closest_point(&self, x: V) -> Option<V> {
        Some(self.turned(self.shape.core_closest_point(self.before(x))?))
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        self.shape.core_support_feature(self.before(direction), slab, feature);
        feature.map(|point| self.turned(point));
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<V>> {
        Some(self.turned_box(&self.shape.core_parallelotope()?))
    }

    /// If the shape is turned, the error of each coordinate may be as large as the length of the error.
    fn rounding(&self) -> Rounding<V> {
        if self.rotation.is_some() {
            let Core { extent, error, .. } = self.core;
            return Rounding { extent: Vector::splat(extent), error: Vector::splat(error), error_length: error };
        }
        let Rounding { extent, error, error_length } = self.shape.rounding();
        Rounding { extent, error: error + Vector::splat(self.error), error_length: error_length + self.error }
    }
}

/// Two bodies at one time; `b` has its origin at zero, which is `place` in the world.
pub(super) struct Placed<'s, V: Vector> {
    pub(super) time: V::Scalar,
    /// The shapes at time 0, and the hints of the last time, which mostly fit again.
    pub(super) shapes: &'s dyn Shapes<Vector = V>,
    pub(super) hints: &'s Cell<[Hint; 2]>,
    pub(super) a: Moved<'s, V>,
    pub(super) b: Moved<'s, V>,
    /// The origin of `a` as seen from that of `b`.
    pub(super) offset: V,
    pub(super) place: V,
}

impl<V: Vector> Placed<'_, V> {
    /// Their difference.
    #[inline(always)]
    pub(super) fn pair(&self) -> Pair<'_, Self> {
        Pair::new(self, [&self.a.core, &self.b.core])
    }

    /// By how much its points may be wrong. The origin of `b` is at zero, so that the difference of both is exact.
    #[inline(always)]
    pub(super) fn uncertainty(&self) -> Uncertainty<V> {
        Uncertainty::of_exact_offset([self.a.rounding(), self.b.rounding()], self.offset)
    }
}

impl<V: Vector> Shapes for Placed<'_, V> {
    type Vector = V;

    #[inline(always)]
    fn cores(&self) -> [Core<V>; 2] {
        [self.a.core(), self.b.core()]
    }

    #[inline(always)]
    fn support_points(&self, [along_a, along_b]: [V; 2], _: &mut [Hint; 2]) -> [Aligned<V>; 2] {
        let mut hints = self.hints.get();
        for hint in &mut hints {
            hint.rewind();
        }
        let [Aligned(a), Aligned(b)] =
            self.shapes.support_points([self.a.before(along_a), self.b.before(along_b)], &mut hints);
        self.hints.set(hints);
        [Aligned(self.a.turned(a)), Aligned(self.b.turned(b))]
    }

    fn support_hessians(&self, [along_a, along_b]: [V; 2], changes: [V; 2]) -> [[V::Scalar; 3]; 2] {
        [self.a.core_support_hessian(along_a, changes), self.b.core_support_hessian(along_b, changes)]
    }

    #[inline(always)]
    fn closest_point(&self, of: Of, x: V) -> Option<V> {
        match of {
            Of::A => self.a.core_closest_point(x),
            Of::B => self.b.core_closest_point(x),
        }
    }

    fn each(&self) -> [Shape<'_, V>; 2] {
        [&self.a, &self.b]
    }
}

/// Corners of both cores, each relative to its body's origin and turned back to time 0.
#[derive(Clone, Copy)]
pub(super) struct BodyFrameCorners<V> {
    pairs: [PointPair<V>; MAX_POINTS],
    len: usize,
}

/// The face of some corners, placed at one time, on which the point of their hull closest to zero lies.
pub(super) struct CornerFace<V: Vector> {
    /// The corners of the difference; zero after the last.
    pub(super) points: [V; MAX_POINTS],
    pairs: [PointPair<V>; MAX_POINTS],
    pub(super) weights: [V::Scalar; MAX_POINTS],
    pub(super) len: usize,
    /// The closest point.
    pub(super) v: V,
}

impl<V: Vector> BodyFrameCorners<V> {
    /// No corners.
    pub(super) fn none() -> Self {
        Self { pairs: [PointPair::ZERO; MAX_POINTS], len: 0 }
    }

    /// Replaces the corners by the given ones, which are those of the bodies at one time.
    pub(super) fn keep(&mut self, corners: impl Iterator<Item = PointPair<V>>, Placed { a, b, .. }: &Placed<'_, V>) {
        self.len = 0;
        for (to, corner) in self.pairs.iter_mut().zip(corners) {
            *to = PointPair { a: a.before(corner.a), b: b.before(corner.b) };
            self.len += 1;
        }
    }

    /// The corners at a time, and those of the difference that they make.
    #[inline(always)]
    pub(super) fn at(&self, Placed { a, b, offset, .. }: &Placed<'_, V>) -> CornerFace<V> {
        let len = self.len.min(MAX_POINTS);
        let (mut pairs, mut points) = ([PointPair::ZERO; MAX_POINTS], [V::ZERO; MAX_POINTS]);
        for (i, kept) in self.pairs[..len].iter().enumerate() {
            pairs[i] = PointPair { a: a.turned(kept.a), b: b.turned(kept.b) };
            points[i] = pairs[i].a - pairs[i].b + *offset;
        }
        CornerFace { points, pairs, weights: [Scalar::ZERO; MAX_POINTS], len, v: V::ZERO }
    }

    /// The face closest to zero, with the bodies where they are at a time. Zero is projected onto the affine hull of
    /// the corners, and corners with a weight that is not positive are dropped, until all weights are positive. This
    /// finds a face that is near, but not always the nearest. `None` if no corner is left.
    #[inline(always)]
    pub(super) fn closest_face(&self, placed: &Placed<'_, V>) -> Option<CornerFace<V>> {
        let CornerFace { mut points, mut pairs, mut len, .. } = self.at(placed);
        while len > 0 {
            let foot = project(&points[..len], |corner| -corner);
            let weights = foot.coordinates;
            let is_inside = |i: usize| weights[i] > V::Scalar::ZERO;
            if (0..len).all(is_inside) {
                return Some(CornerFace { points, pairs, weights, len, v: -foot.across });
            }
            // At least one weight is not positive, or is NaN.
            let before = len;
            len = 0;
            for i in (0..before).filter(|&i| is_inside(i)) {
                (points[len], pairs[len]) = (points[i], pairs[i]);
                len += 1;
            }
        }
        None
    }
}

impl<V: Vector> CornerFace<V> {
    /// The points of both cores whose difference is its closest point.
    #[inline(always)]
    pub(super) fn closest_points(&self) -> PointPair<V> {
        self.corners().zip(&self.weights).fold(PointPair::ZERO, |sum, ((_, pair), &weight)| sum.plus(pair, weight))
    }

    /// The corners of the difference, and the corners of both cores that each is made of.
    #[inline(always)]
    pub(super) fn corners(&self) -> impl Iterator<Item = (V, PointPair<V>)> + '_ {
        self.points.iter().copied().zip(self.pairs.iter().copied()).take(self.len)
    }

    /// The unit vector across the plane that it spans, on the side of `axis`.
    pub(super) fn unit_across(&self, axis: V) -> Option<V> {
        let (normal, _) = if self.len == V::DIM { across_corners(&self.points) } else { return None };
        let unit = normal.unit()?;
        Some(if unit.dot(axis) < V::Scalar::ZERO { -unit } else { unit })
    }
}
