//! Strategies that several files of properties share.

use convex_support::glam::{DQuat, DVec3};
use proptest::prelude::*;

/// A vector with coordinates up to `reach`.
pub(crate) fn vector(reach: f64) -> impl Strategy<Value = DVec3> {
    (-reach..reach, -reach..reach, -reach..reach).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// A rotation by any angle about any axis.
pub(crate) fn rotation() -> impl Strategy<Value = DQuat> {
    (vector(1.0), -3.0..3.0)
        .prop_filter("an axis", |(axis, _)| axis.length() > 0.1)
        .prop_map(|(axis, angle)| DQuat::from_axis_angle(axis.normalize(), angle))
}
