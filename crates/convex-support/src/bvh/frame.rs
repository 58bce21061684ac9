//! Single precision for boxes in any precision.

use num_traits::Float as _;

use crate::glam::Vec3A;
use crate::numerics::range::power_of_two_below;
use crate::{Aabb, Scalar, Vector};

/// The power of two to which the farthest coordinate is scaled: large enough that squares of much smaller lengths do
/// not underflow, and small enough that squares of much larger ones do not overflow.
const REACH: f64 = (1_u64 << 40) as f64;

/// How many times as far as the boxes of a frame others may lie before another frame should be chosen: squares of such
/// lengths do not overflow, and if boxes come ever farther away, each twice as far as the last one, the tree is not
/// rebuilt for each.
const BEYOND: f64 = (1_u64 << 16) as f64;

/// The coordinates of the nodes of a tree: a coordinate `x` is `(x − origin)·2ᵏ` in single precision,
/// rounded *outwards*.
///
/// A box in these coordinates contains the original box, and is larger by at most 2⁻²² of its distance from the origin
/// on each side. The origin is the median of the boxes, so that a few that are far away do not matter.
#[derive(Clone, Copy, Debug)]
pub struct Frame<V: Vector> {
    origin: V,
    per_unit: f64,
    /// The largest distance of boxes from the origin, in the world's unit.
    reach: f64,
}

impl<V: Vector> Frame<V> {
    /// The frame of a tree without boxes; every box is beyond it.
    pub(super) fn empty() -> Self {
        Self { origin: V::ZERO, per_unit: 1.0, reach: 0.0 }
    }

    /// The frame for `count` boxes.
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

    /// Whether a box is so far from the origin that another frame is worthwhile.
    pub(super) fn is_beyond(&self, around: &Aabb<V>) -> bool {
        distance(self.origin, around) > BEYOND * self.reach
    }

    /// The same for a box in this frame.
    pub(super) fn sees_beyond(&self, around: &Aabb<Vec3A>) -> bool {
        let reach = f64::from(around.min.abs().max(around.max.abs()).max_element());
        reach > BEYOND * self.reach * self.per_unit + 1.0
    }

    /// The origin of the coordinates.
    #[must_use]
    pub fn origin(&self) -> V {
        self.origin
    }

    /// At most the coordinate `x` in this frame.
    #[inline(always)]
    #[must_use]
    pub fn down(&self, axis: usize, x: V::Scalar) -> f32 {
        down(self.seen(axis, x))
    }

    /// At least the coordinate `x` in this frame.
    #[inline(always)]
    #[must_use]
    pub fn up(&self, axis: usize, x: V::Scalar) -> f32 {
        up(self.seen(axis, x))
    }

    #[inline(always)]
    fn seen(&self, axis: usize, x: V::Scalar) -> f64 {
        (x.as_f64() - self.origin.get(axis).as_f64()) * self.per_unit
    }

    /// The unit of lengths in this frame.
    #[must_use]
    pub fn unit(&self) -> CoarseUnit {
        CoarseUnit::new::<V::Scalar>(self.per_unit)
    }

    /// A box in this frame; in the plane, about zero of the third coordinate.
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

    /// A box of this frame in the world, with room for the rounding of both.
    pub(super) fn in_world(&self, around: &Aabb<Vec3A>) -> Aabb<V> {
        let at = |axis: usize, c: f32, out: f64| {
            let (c, origin) = (f64::from(c), self.origin.get(axis).as_f64());
            let world = c / self.per_unit + origin;
            V::Scalar::from_f64(world + out * 4.0 * V::Scalar::EPSILON.as_f64() * (origin.abs() + world.abs()))
        };
        Aabb {
            min: V::from_fn(|axis| at(axis, around.min[axis], -1.0)),
            max: V::from_fn(|axis| at(axis, around.max[axis], 1.0)),
        }
    }

    /// A box of another frame in this one.
    pub(super) fn outwards_from(&self, other: &Self, around: &Aabb<Vec3A>) -> Aabb<Vec3A> {
        // The rounding of double precision is small against a step of single precision, of the other frame's coordinate
        // or of this one.
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

/// The greatest coordinate of a box relative to a point.
fn distance<V: Vector>(origin: V, around: &Aabb<V>) -> f64 {
    (around.max - origin).max(origin - around.min).max_element().as_f64()
}

/// At most `x`, by a few steps of single precision; the largest number if `x` is larger or NaN.
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

/// At least one step between numbers of this size, and at most two; more for the smallest ones. Rounding to the nearest
/// moves `x` by half a step, and a difference of a whole number of steps is exact.
#[inline(always)]
fn step<T: core::ops::Mul<f32, Output = T> + core::ops::Add<f32, Output = T>>(size: T) -> T {
    size * f32::EPSILON + f32::MIN_POSITIVE
}

/// At least `x`, as [`down`] is at most.
#[inline(always)]
fn up(x: f64) -> f32 {
    -down(-x)
}

/// The unit of [coarse bounds](super::CoarseBound), and their largest error: 64 ε of single precision, for their few
/// operations and those of bounds that may be in single precision themselves; and a few of the smallest numbers.
#[derive(Clone, Copy, Debug)]
pub struct CoarseUnit {
    per_unit: f64,
    least: f64,
}

impl CoarseUnit {
    /// How much a coarse bound may exceed a bound, relative to it.
    pub const ROUNDING: f64 = 64.0 * f32::EPSILON as f64;

    /// The unit, given how many there are in one of the question's, which is computed in scalars of this kind.
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

    /// The largest coarse bound, if right to [`ROUNDING`](Self::ROUNDING), for a bound of at most `limit`.
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

/// At least a number, and finite: the largest number stands for larger ones, and for NaN.
fn finite_up(limit: f64) -> f32 {
    if limit < f64::from(f32::MAX) { up(limit).min(f32::MAX) } else { f32::MAX }
}
