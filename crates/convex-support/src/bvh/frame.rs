//! Single precision for boxes in any precision.

use num_traits::Float as _;

use crate::glam::Vec3A;
use crate::numerics::range::power_of_two_below;
use crate::{Aabb, Scalar, Vector};

/// The power of two that the farthest coordinate is seen as: large enough that squares of what is small beside it do
/// not underflow, and small enough that squares of what is far beyond do not overflow.
const REACH: f64 = (1_u64 << 40) as f64;

/// How many times as far as the boxes that a frame was chosen for others may lie, before another should be: squares
/// of what is as far as that do not overflow, and boxes that come ever farther away, each twice as far as the last
/// one, do not have the tree built anew for each.
const BEYOND: f64 = (1_u64 << 16) as f64;

/// Where the nodes of a tree are seen from: a coordinate `x` is `(x − origin)·2ᵏ` in single precision, rounded
/// *outwards*.
///
/// A box as it is seen so contains the box that it is of, and is larger by at most 2⁻²² of its distance from the origin
/// on each side. The origin is in the midst of the boxes, half of which are on each side of it, so that a few that are
/// far away do not matter.
#[derive(Clone, Copy, Debug)]
pub struct Frame<V: Vector> {
    origin: V,
    per_unit: f64,
    /// How far from the origin boxes are expected, in the world's unit.
    reach: f64,
}

impl<V: Vector> Frame<V> {
    /// The frame of a tree without boxes, beyond which is everything.
    pub(super) fn empty() -> Self {
        Self { origin: V::ZERO, per_unit: 1.0, reach: 0.0 }
    }

    /// One for boxes of which there are `count`.
    pub(super) fn of(count: usize, boxes: impl Iterator<Item = Aabb<V>> + Clone) -> Self {
        const SAMPLE: usize = 63;
        let step = count.div_ceil(SAMPLE).max(1);
        let origin = V::from_fn(|axis| {
            let (mut centers, mut len) = ([V::Scalar::ZERO; SAMPLE], 0);
            for around in boxes.clone().step_by(step).take(SAMPLE) {
                let center = around.center().get(axis);
                if center.is_finite() {
                    (centers[len], len) = (center, len + 1);
                }
            }
            let centers = &mut centers[..len];
            centers.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
            centers.get(len / 2).copied().unwrap_or(V::Scalar::ZERO)
        });
        let reach = boxes.map(|around| distance(origin, &around)).fold(0.0, f64::max);
        Self { origin, per_unit: power_of_two_below(REACH / power_of_two_below(reach)), reach }
    }

    /// Whether a box is so far from the origin that another frame is worth while.
    pub(super) fn is_beyond(&self, around: &Aabb<V>) -> bool {
        distance(self.origin, around) > BEYOND * self.reach
    }

    /// The same of a box as it is seen.
    pub(super) fn sees_beyond(&self, around: &Aabb<Vec3A>) -> bool {
        let reach = f64::from(around.min.abs().max(around.max.abs()).max_element());
        reach > BEYOND * self.reach * self.per_unit + 1.0
    }

    /// What boxes are seen from.
    #[must_use]
    pub fn origin(&self) -> V {
        self.origin
    }

    /// At most the coordinate `x` as it is seen.
    #[inline(always)]
    #[must_use]
    pub fn down(&self, axis: usize, x: V::Scalar) -> f32 {
        down(self.seen(axis, x))
    }

    /// At least the coordinate `x` as it is seen.
    #[inline(always)]
    #[must_use]
    pub fn up(&self, axis: usize, x: V::Scalar) -> f32 {
        up(self.seen(axis, x))
    }

    #[inline(always)]
    fn seen(&self, axis: usize, x: V::Scalar) -> f64 {
        (x.as_f64() - self.origin.get(axis).as_f64()) * self.per_unit
    }

    /// The unit of lengths as they are seen.
    #[must_use]
    pub fn unit(&self) -> CoarseUnit {
        CoarseUnit::new::<V::Scalar>(self.per_unit)
    }

    /// A box as it is seen; in the plane, about zero of the third coordinate.
    #[inline(always)]
    pub(super) fn outwards(&self, around: &Aabb<V>) -> Aabb<Vec3A> {
        let (mut min, mut max) = ([0.0; 3], [0.0; 3]);
        for axis in 0..V::DIM {
            min[axis] = below_infinity(self.seen(axis, around.min.get(axis)));
            max[axis] = below_infinity(-self.seen(axis, around.max.get(axis)));
        }
        let step_down = |x: [f32; 3]| Vec3A::from(x) - step(Vec3A::from(x).abs());
        Aabb { min: step_down(min), max: -step_down(max) }
    }

    /// The same box as this frame sees it, and not another.
    pub(super) fn outwards_from(&self, other: &Self, around: &Aabb<Vec3A>) -> Aabb<Vec3A> {
        // What is computed in double precision is nothing to a step of single precision, of the other's coordinate or
        // of this one.
        let at = |axis: usize, c: f32| {
            let world = f64::from(c) / other.per_unit + other.origin.get(axis).as_f64();
            (world - self.origin.get(axis).as_f64()) * self.per_unit
        };
        let room = |axis: usize| {
            let origins = other.origin.get(axis).abs().as_f64() + self.origin.get(axis).abs().as_f64();
            let reach = f64::from(around.min[axis].abs().max(around.max[axis].abs())) / other.per_unit;
            8.0 * f64::EPSILON * (origins + reach) * self.per_unit
        };
        let (mut min, mut max) = (Vec3A::ZERO, Vec3A::ZERO);
        for axis in 0..V::DIM {
            min[axis] = down(at(axis, around.min[axis]) - room(axis));
            max[axis] = up(at(axis, around.max[axis]) + room(axis));
        }
        Aabb { min, max }
    }
}

/// The greatest coordinate of a box from a point.
fn distance<V: Vector>(origin: V, around: &Aabb<V>) -> f64 {
    (around.max - origin).max(origin - around.min).max_element().as_f64()
}

/// At most `x`, by a few steps of single precision; what is too large for it is its largest number, and so is NaN.
#[inline(always)]
fn down(x: f64) -> f32 {
    let nearest = below_infinity(x);
    nearest - step(nearest.abs())
}

/// The nearest number in single precision that is not infinite or NaN; or minus infinity.
#[inline(always)]
fn below_infinity(x: f64) -> f32 {
    let nearest = x as f32;
    if nearest < f32::MAX { nearest } else { f32::MAX }
}

/// Of numbers of this size, one step at least, and at most two; of the smallest ones more. Rounding to the nearest
/// moves `x` by half a step, and a difference by a whole number of steps not at all.
#[inline(always)]
fn step<T: core::ops::Mul<f32, Output = T> + core::ops::Add<f32, Output = T>>(size: T) -> T {
    size * f32::EPSILON + f32::MIN_POSITIVE
}

/// At least `x`, as [`down`] is at most.
#[inline(always)]
fn up(x: f64) -> f32 {
    -down(-x)
}

/// The unit of [coarse bounds](super::CoarseBound), and what they may be wrong by: 64 ε of single precision, which is
/// what rounds the few operations that they are made of and those of bounds that may be in single precision themselves;
/// and a few of the smallest numbers.
#[derive(Clone, Copy, Debug)]
pub struct CoarseUnit {
    per_unit: f64,
    least: f64,
}

impl CoarseUnit {
    /// Relative to a bound, by how much a coarse one may exceed it.
    pub const ROUNDING: f64 = 64.0 * f32::EPSILON as f64;

    /// The unit, of which there are so many in one of the question's, which is computed in scalars of this kind.
    #[must_use]
    pub fn new<S: Scalar>(per_unit: f64) -> Self {
        Self { per_unit, least: 4.0 * S::min_positive_value().as_f64() * S::EPSILON.as_f64() }
    }

    /// How many there are in a unit of the question.
    #[must_use]
    pub fn per_unit(&self) -> f64 {
        self.per_unit
    }

    /// At most a number.
    #[inline]
    #[must_use]
    pub fn down(x: f64) -> f32 {
        down(x)
    }

    /// What coarse bounds do not exceed if they are right to [`ROUNDING`](Self::ROUNDING) and stand for bounds of at
    /// most `limit`.
    #[inline]
    #[must_use]
    pub fn limit(&self, limit: f64) -> f32 {
        finite_up(self.room(limit))
    }

    /// The same for squares of bounds.
    #[inline]
    #[must_use]
    pub fn limit_of_squares(&self, limit: f64) -> f32 {
        let limit = self.room(limit);
        finite_up(limit * limit)
    }

    #[inline]
    fn room(&self, limit: f64) -> f64 {
        (limit + self.least) * self.per_unit * (1.0 + Self::ROUNDING)
    }
}

/// At least a number, and finite: the largest number is as good as a larger one, and as NaN.
fn finite_up(limit: f64) -> f32 {
    if limit < f64::from(f32::MAX) { up(limit).min(f32::MAX) } else { f32::MAX }
}
