//! Vectors as plain arrays, whose every operation is spelt out: the order of operations is part of the workloads.
#![allow(missing_docs, reason = "what each function computes is its name")]

use crate::real::{DoubleDouble, Real};

/// A vector or point of space, of doubles unless truths need more.
pub type Vec3<R = f64> = [R; 3];
/// A quaternion `(x, y, z, w)`.
pub type Quat = [f64; 4];

/// The same numbers as sums of two doubles.
#[must_use]
pub fn wide(v: Vec3) -> Vec3<DoubleDouble> {
    v.map(DoubleDouble::from)
}

/// The nearest doubles.
#[must_use]
pub fn narrow<R: Real>(v: Vec3<R>) -> Vec3 {
    v.map(R::f64)
}

#[must_use]
pub fn dot<R: Real>(a: Vec3<R>, b: Vec3<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[must_use]
pub fn cross<R: Real>(a: Vec3<R>, b: Vec3<R>) -> Vec3<R> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[must_use]
pub fn add<R: Real>(a: Vec3<R>, b: Vec3<R>) -> Vec3<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[must_use]
pub fn sub<R: Real>(a: Vec3<R>, b: Vec3<R>) -> Vec3<R> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[must_use]
pub fn scale<R: Real>(a: Vec3<R>, k: R) -> Vec3<R> {
    [a[0] * k, a[1] * k, a[2] * k]
}

#[must_use]
pub fn neg<R: Real>(a: Vec3<R>) -> Vec3<R> {
    [-a[0], -a[1], -a[2]]
}

#[must_use]
pub fn norm<R: Real>(a: Vec3<R>) -> R {
    dot(a, a).sqrt()
}

/// The rotation `v + 2w(u × v) + 2u × (u × v)` by the unit quaternion `(u, w)`.
pub(crate) fn rotate([x, y, z, w]: Quat, v: Vec3) -> Vec3 {
    let u = [x, y, z];
    let t = scale(cross(u, v), 2.0);
    add(add(v, scale(t, w)), cross(u, t))
}

pub(crate) fn conjugate([x, y, z, w]: Quat) -> Quat {
    [-x, -y, -z, w]
}
