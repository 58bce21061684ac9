//! Vectors as plain arrays, whose every operation is spelt out: the order of operations is part of the workloads.

/// A vector or point of space.
pub type Vec3 = [f64; 3];
/// A quaternion `(x, y, z, w)`.
pub type Quat = [f64; 4];

pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale(a: Vec3, k: f64) -> Vec3 {
    [a[0] * k, a[1] * k, a[2] * k]
}

pub(crate) fn neg(a: Vec3) -> Vec3 {
    [-a[0], -a[1], -a[2]]
}

pub(crate) fn norm(a: Vec3) -> f64 {
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
