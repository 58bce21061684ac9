//! The point of a cone nearest a given point: in the half plane through the axis, where the cone is a triangle.

use num_traits::Float as _;

use super::segment::clamp_to_segment;
use crate::shapes::axial::across;
use crate::{Scalar, Vector3};

/// In the half plane through the axis and `x`, with `ρ` the distance from the axis, the cone of half height `h` and
/// radius `r` is the triangle `(0, h), (r, −h), (0, −h)`, and its slanted edge is `2h·ρ + r·(y − h) = 0`.
pub(crate) fn closest_of_cone<V: Vector3>(h: V::Scalar, r: V::Scalar, x: V) -> V {
    let (out, y) = (across(x), x.get(1));
    let rho = out.norm();
    let slant = (h + h) * rho + r * (y - h);
    if rho <= r && y.abs() <= h && slant <= V::Scalar::ZERO {
        return x;
    }
    let radial = out.unit().unwrap_or(V::ZERO);
    if y <= -h {
        return radial * rho.min(r) - V::axis(1) * h;
    }
    let (apex, rim) = (V::axis(1) * h, radial * r - V::axis(1) * h);
    clamp_to_segment([apex, rim], x)
}
