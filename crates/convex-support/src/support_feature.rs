//! The vertex, edge or face that a shape shows along a direction.

use num_traits::Float as _;

use crate::support::swept;
use crate::{Scalar, Vector, Vector3};

/// As many points as a feature may have. Of a face with more corners every second, third, … is taken.
const MAX_POINTS: usize = 16;

/// Points of a rim that stand for a disc.
const RIM: u32 = 8;

/// The points of a shape that lie within a slab behind its supporting plane: a vertex, the ends of an edge, or the corners of a
/// face, in no order, and perhaps with points in between.
///
/// Two shapes in contact touch where their features face each other. Each point has a number that stays the same as long as it is
/// the same point of the shape, so that what is known of a contact can be found again in the next frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature<V> {
    points: [V; MAX_POINTS],
    ids: [u32; MAX_POINTS],
    len: usize,
}

impl<V: Vector> Default for Feature<V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<V: Vector> Feature<V> {
    /// A feature without points.
    #[must_use]
    pub fn new() -> Self {
        Self { points: [V::ZERO; MAX_POINTS], ids: [0; MAX_POINTS], len: 0 }
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &[V] {
        &self.points[..self.len]
    }

    /// The numbers of the points, in the same order.
    #[must_use]
    pub fn ids(&self) -> &[u32] {
        &self.ids[..self.len]
    }

    /// Adds a point of the given number, if there is room.
    pub fn push(&mut self, point: V, id: u32) {
        if let (Some(p), Some(i)) = (self.points.get_mut(self.len), self.ids.get_mut(self.len)) {
            (*p, *i) = (point, id);
            self.len += 1;
        }
    }

    /// Takes all points away.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Moves every point.
    pub fn map(&mut self, f: impl Fn(V) -> V) {
        for point in &mut self.points[..self.len] {
            *point = f(*point);
        }
    }

    /// Of so many points, numbered from 0, those no farther than `slab` behind the farthest along a direction.
    pub(crate) fn collect(&mut self, direction: V, slab: V::Scalar, count: usize, point: impl Fn(usize) -> V) {
        let level = |i: usize| direction.dot(point(i));
        let highest = (0..count).map(level).fold(-V::Scalar::infinity(), V::Scalar::max);
        let is_near = |&i: &usize| level(i) >= highest - slab;
        let stride = (0..count).filter(is_near).count().div_ceil(MAX_POINTS).max(1);
        for i in (0..count).filter(is_near).step_by(stride) {
            self.push(point(i), i as u32);
        }
    }

    /// The same of discs across the second axis, by height and radius: of each the support point, and points all around where the
    /// disc is flat against the plane.
    pub(crate) fn collect_discs(&mut self, direction: V, slab: V::Scalar, discs: [(V::Scalar, V::Scalar); 2])
    where
        V: Vector3,
    {
        let across = direction - V::axis(1) * direction.get(1);
        let slope = across.norm();
        let level = |(height, radius): (V::Scalar, V::Scalar)| direction.get(1) * height + slope * radius;
        let highest = level(discs[0]).max(level(discs[1]));
        for (k, &(height, radius)) in (0..).zip(&discs) {
            let center = V::axis(1) * height;
            let lowest = level((height, -radius));
            if lowest >= highest - slab && radius > V::Scalar::ZERO {
                for i in 0..RIM {
                    let (sine, cosine) = (core::f64::consts::TAU * f64::from(i) / f64::from(RIM)).sin_cos();
                    let at =
                        [radius * V::Scalar::from_f64(cosine), V::Scalar::ZERO, radius * V::Scalar::from_f64(sine)];
                    self.push(center + V::from_fn(|i| at[i]), k * (RIM + 1) + i);
                }
            } else if level((height, radius)) >= highest - slab {
                self.push(center + swept(radius, across), k * (RIM + 1) + RIM);
            }
        }
    }
}
