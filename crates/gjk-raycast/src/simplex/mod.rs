//! The simplex of the iterations: up to four points of a core, each with the points of the shapes that it comes from;
//! and its point closest to zero.

mod affine_hull;
mod closest;
#[cfg(feature = "paper")]
mod paper;
mod regions;
mod sub_algorithm;

use convex_support::{Scalar, Vector};

use crate::body::PointPair;
pub(crate) use affine_hull::{AffineHull, project, project_rarely};
pub(crate) use closest::{Closest, nearest_face};
pub(crate) use regions::{is_around_zero, nearest};
pub use sub_algorithm::SubAlgorithm;

/// The largest number of points of a simplex, in 3D.
pub(crate) const MAX_POINTS: usize = 4;

/// Points of a convex set and the points that they come from, the newest last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simplex<V: Vector> {
    points: [V; MAX_POINTS],
    /// The directions along which they are support points.
    along: [V; MAX_POINTS],
    witnesses: [PointPair<V>; MAX_POINTS],
    weights: [V::Scalar; MAX_POINTS],
    len: usize,
}

impl<V: Vector> Simplex<V> {
    pub(crate) fn new() -> Self {
        Self {
            points: [V::ZERO; MAX_POINTS],
            along: [V::ZERO; MAX_POINTS],
            witnesses: [PointPair::ZERO; MAX_POINTS],
            weights: [V::Scalar::ZERO; MAX_POINTS],
            len: 0,
        }
    }

    pub(crate) fn points(&self) -> &[V] {
        // Cannot panic, so that values for an observer that ignores them are not computed.
        &self.points[..self.len.min(MAX_POINTS)]
    }

    /// Adds a support point found along a direction, with no weight yet.
    ///
    /// # Panics
    /// If there are four already.
    pub(crate) fn push(&mut self, point: V, along: V, witness: PointPair<V>) {
        let index = self.len;
        assert!(index < MAX_POINTS, "a simplex has at most four points");
        (self.points[index], self.along[index], self.witnesses[index]) = (point, along, witness);
        self.weights[index] = V::Scalar::ZERO;
        self.len = index + 1;
    }

    pub(crate) fn pop(&mut self) {
        self.len = self.len.saturating_sub(1);
    }

    /// Removes a point; the others keep their order.
    pub(crate) fn remove(&mut self, index: usize) {
        self.points[index..self.len].rotate_left(1);
        self.along[index..self.len].rotate_left(1);
        self.witnesses[index..self.len].rotate_left(1);
        self.pop();
    }

    /// Keeps only a face, with these weights of its corners.
    #[inline(never)]
    pub(crate) fn retain(&mut self, face: Face, weights: [V::Scalar; MAX_POINTS]) {
        self.keep(face);
        self.weigh(weights);
    }

    #[inline]
    pub(crate) fn weigh(&mut self, weights: [V::Scalar; MAX_POINTS]) {
        self.weights = weights;
    }

    /// Keeps only a face, without weights.
    #[inline]
    pub(crate) fn keep(&mut self, face: Face) {
        // Until the simplex is a triangle, mostly all of its points are kept.
        if face == Face::with_all(self.len) {
            return;
        }
        let mut kept = 0;
        for i in 0..MAX_POINTS {
            if i < self.len && face.has(i) {
                // Point i does not come before its new place, where it mostly is already.
                if kept != i {
                    self.points[kept] = self.points[i];
                    self.along[kept] = self.along[i];
                    self.witnesses[kept] = self.witnesses[i];
                }
                kept += 1;
            }
        }
        self.len = kept;
    }

    /// The points in an array, whose last elements may be unused, and the index of the newest.
    #[inline]
    pub(crate) fn padded(&self) -> (&[V; MAX_POINTS], usize) {
        (&self.points, (self.len + MAX_POINTS - 1) % MAX_POINTS)
    }

    pub(crate) fn weighted_point(&self) -> V {
        self.points().iter().zip(&self.weights).fold(V::ZERO, |sum, (&point, &weight)| sum + point * weight)
    }

    pub(crate) fn weight(&self) -> V::Scalar {
        self.weighted().fold(V::Scalar::ZERO, |sum, (weight, _)| sum + weight)
    }

    #[inline(never)]
    pub(crate) fn weighted_witness(&self) -> PointPair<V> {
        self.weighted().fold(PointPair::ZERO, |sum, (weight, witness)| sum.plus(witness, weight))
    }

    pub(crate) fn middle(&self) -> V {
        self.points().iter().fold(V::ZERO, |sum, &point| sum + point) / V::Scalar::from_f64(self.len as f64)
    }

    pub(crate) fn along(&self) -> &[V] {
        &self.along[..self.len]
    }

    pub(crate) fn witnesses(&self) -> &[PointPair<V>] {
        &self.witnesses[..self.len]
    }

    /// The points with their weights and the points that they come from.
    pub(crate) fn corners(&self) -> impl Iterator<Item = (V, V::Scalar, PointPair<V>)> + '_ {
        (0..self.len.min(MAX_POINTS)).map(|i| (self.points[i], self.weights[i], self.witnesses[i]))
    }

    pub(crate) fn weighted(&self) -> impl Iterator<Item = (V::Scalar, PointPair<V>)> + '_ {
        (0..self.len).map(|i| (self.weights[i], self.witnesses[i]))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Face(u8);

/// The faces with at most `most` corners of a simplex of `len` points.
pub(crate) fn faces(len: usize, most: usize) -> impl Iterator<Item = Face> {
    (1_u8..1 << len).map(Face).filter(move |face| face.len() <= most)
}

impl Face {
    #[inline]
    pub(crate) fn of_corners(corners: &[usize]) -> Self {
        let mut bits = 0;
        for &corner in corners {
            bits |= 1 << corner;
        }
        Self(bits)
    }

    /// The face with the first `len` points as corners.
    #[inline(always)]
    fn with_all(len: usize) -> Self {
        Self((1 << (len % u8::BITS as usize)) - 1)
    }

    pub(crate) fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether point `index` is a corner.
    pub(crate) fn has(self, index: usize) -> bool {
        self.0 >> index & 1 == 1
    }

    /// The corners, in order.
    pub(crate) fn of<'a, V: Vector>(self, points: &[V], corners: &'a mut [V; MAX_POINTS]) -> &'a [V] {
        let mut len = 0;
        for (_, &point) in points.iter().enumerate().filter(|&(i, _)| self.has(i)) {
            corners[len] = point;
            len += 1;
        }
        &corners[..len]
    }
}

#[cfg(feature = "paper")]
impl Face {
    /// A number below 2 to the number of points.
    pub(crate) fn index(self) -> usize {
        usize::from(self.0)
    }

    /// The face with point `index` as another corner.
    pub(crate) fn with(self, index: usize) -> Self {
        Self(self.0 | 1 << index)
    }

    /// The face opposite to corner `index`.
    pub(crate) fn without(self, index: usize) -> Self {
        Self(self.0 & !(1 << index))
    }
}
