//! Vectors of either precision by their coordinates, in double precision.

use crate::{Scalar, Vector};

/// Three coordinates; in the plane the last is zero.
pub type Vec3 = [f64; 3];

/// Squares of lengths and their products below this may have underflowed: such short lengths do not count.
pub const LEAST: f64 = 1e-250;

pub fn array<V: Vector>(v: V) -> Vec3 {
    core::array::from_fn(|i| if i < V::DIM { v.get(i).as_f64() } else { 0.0 })
}

/// Coordinates in the precision of the bodies.
#[inline]
pub fn vector<V: Vector>(v: Vec3) -> V {
    V::from_fn(|i| V::Scalar::from_f64(v[i]))
}

#[inline(always)]
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub fn cross(a: &Vec3, b: &Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
