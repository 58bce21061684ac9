//! Shapes somewhere on their way, two moving bodies where they are at a time, and the corners that are closest there.

use core::cell::Cell;

use convex_support::{Core, CoreKind, Feature, Hint, Matrix, Parallelotope, Rounding, Scalar, SupportMap, Vector};

use crate::body::{Aligned, Of, PointPair, Shapes};
use crate::separation::across_corners;
use crate::shape::Shape;
use crate::simplex::{MAX_POINTS, project};

/// A shape turned by a rotation, whose origin is put where one wants it, and whose radius may be grown.
pub(crate) struct Moved<'s, V: Vector> {
    shape: Shape<'s, V>,
    /// The rotation about the origin; `None` for a shape as it is.
    rotation: Option<V::Matrix>,
    core: Core<V>,
    /// What moving the shape may have added to the error of its points, as a length.
    error: V::Scalar,
}

impl<'s, V: Vector> Moved<'s, V> {
    /// The shape with the given core, which may have another origin and another radius than its own, turned by
    /// `rotation` about the origin. Moving it took its points where they should be but for `error`.
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
        // The length of an error stays. The product with the matrix is wrong by at most three ε of the extent, and so
        // may be the support value along a direction that is turned.
        let error = error + V::Scalar::from_f64(6.0) * Scalar::EPSILON * core.extent;
        Self { shape, rotation, core: Core { kind, error: core.error + error, ..core }, error }
    }

    /// A vector of the shape as it is turned.
    #[inline(always)]
    pub(super) fn turned(&self, vector: V) -> V {
        self.rotation.map_or(vector, |rotation| rotation * vector)
    }

    /// A vector of the turned shape as it was.
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
        let Parallelotope { center, half_edges } = self.shape.core_parallelotope()?;
        Some(Parallelotope { center: self.turned(center), half_edges: half_edges.map(|edge| self.turned(edge)) })
    }

    /// Of a shape that is turned the coordinates are no better known than the length.
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
    /// The shapes where they were, and what was found of them at the last time, which is mostly found again.
    pub(super) shapes: &'s dyn Shapes<Vector = V>,
    pub(super) hints: &'s Cell<[Hint; 2]>,
    pub(super) a: Moved<'s, V>,
    pub(super) b: Moved<'s, V>,
    /// The origin of `a` as seen from that of `b`.
    pub(super) offset: V,
    pub(super) place: V,
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

    fn support_hessian(&self, of: Of, direction: V, changes: [V; 2]) -> [V::Scalar; 3] {
        match of {
            Of::A => self.a.core_support_hessian(direction, changes),
            Of::B => self.b.core_support_hessian(direction, changes),
        }
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
pub(super) struct Corners<V> {
    pairs: [PointPair<V>; MAX_POINTS],
    len: usize,
}

/// Corners where the bodies are at a time: the face of them that has their point closest to zero.
pub(super) struct CornerFace<V: Vector> {
    /// Those of the difference; zero beyond the last.
    pub(super) points: [V; MAX_POINTS],
    pairs: [PointPair<V>; MAX_POINTS],
    pub(super) weights: [V::Scalar; MAX_POINTS],
    pub(super) len: usize,
    /// The closest point.
    pub(super) v: V,
}

impl<V: Vector> Corners<V> {
    /// No corner.
    pub(super) fn none() -> Self {
        Self { pairs: [PointPair::default(); MAX_POINTS], len: 0 }
    }

    /// Takes the given corners, where the bodies are at a time, instead.
    pub(super) fn keep(&mut self, corners: impl Iterator<Item = PointPair<V>>, Placed { a, b, .. }: &Placed<'_, V>) {
        self.len = 0;
        for (to, corner) in self.pairs.iter_mut().zip(corners) {
            *to = PointPair { a: a.before(corner.a), b: b.before(corner.b) };
            self.len += 1;
        }
    }

    /// Where they are at a time, and the corners of the difference that they make.
    #[inline(always)]
    pub(super) fn at(&self, Placed { a, b, offset, .. }: &Placed<'_, V>) -> CornerFace<V> {
        let len = self.len.min(MAX_POINTS);
        let (mut pairs, mut points) = ([PointPair::default(); MAX_POINTS], [V::ZERO; MAX_POINTS]);
        for (i, kept) in self.pairs[..len].iter().enumerate() {
            pairs[i] = PointPair { a: a.turned(kept.a), b: b.turned(kept.b) };
            points[i] = pairs[i].a - pairs[i].b + *offset;
        }
        CornerFace { points, pairs, weights: [Scalar::ZERO; MAX_POINTS], len, v: V::ZERO }
    }

    /// The face closest to zero, where the bodies are at a time. Corners that leave the point closest to zero of their
    /// hull outside are dropped, which finds a face that is near if not the nearest; `None` where no face is found.
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
            // One weight at least is not positive, or NaN.
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
    /// The points of both cores that its closest point is made of.
    #[inline(always)]
    pub(super) fn closest_points(&self) -> PointPair<V> {
        self.corners().zip(&self.weights).fold(PointPair::default(), |sum, ((_, pair), &weight)| sum.plus(pair, weight))
    }

    /// The corners, and what they are made of.
    #[inline(always)]
    pub(super) fn corners(&self) -> impl Iterator<Item = (V, PointPair<V>)> + '_ {
        self.points.iter().copied().zip(self.pairs.iter().copied()).take(self.len)
    }

    /// The unit vector across the plane that it spans, towards `axis`.
    pub(super) fn unit_across(&self, axis: V) -> Option<V> {
        let (normal, _) = if self.len == V::DIM { across_corners(&self.points) } else { return None };
        let unit = normal.unit()?;
        Some(if unit.dot(axis) < V::Scalar::ZERO { -unit } else { unit })
    }
}
