//! Bridges to parry, for code that moves from it or uses both.
//!
//! parry is one crate for each dimension and precision, with the same names in each. So is this bridge: `shapes.rs` is
//! compiled for all of them, with `solid.rs` for 3D space or `planar.rs` for the plane, and `pieces.rs` for what is
//! made of convex pieces.

/// parry2d's shapes as shapes of this crate, and back; single precision.
#[cfg(feature = "parry2d")]
pub mod parry2d {
    use ::parry2d as parry;
    use glam::Vec2 as V;

    include!("shapes.rs");
    include!("planar.rs");
    include!("pieces.rs");
}

/// parry2d-f64's shapes as shapes of this crate, and back; double precision.
#[cfg(feature = "parry2d-f64")]
pub mod parry2d_f64 {
    use ::parry2d_f64 as parry;
    use glam::DVec2 as V;

    include!("shapes.rs");
    include!("planar.rs");
    include!("pieces.rs");
}

/// parry3d's shapes as shapes of this crate, and back; single precision.
#[cfg(feature = "parry3d")]
pub mod parry3d {
    use ::parry3d as parry;
    use glam::Vec3 as V;

    include!("shapes.rs");
    include!("solid.rs");
    include!("pieces.rs");
}

/// parry3d-f64's shapes as shapes of this crate, and back; double precision.
#[cfg(feature = "parry3d-f64")]
pub mod parry3d_f64 {
    use ::parry3d_f64 as parry;
    use glam::DVec3 as V;

    include!("shapes.rs");
    include!("solid.rs");
    include!("pieces.rs");
}

/// Asserts that two shapes reach equally far along some directions, to rounding in single precision.
#[cfg(test)]
fn same<V: crate::Vector>(a: &impl crate::SupportMap<Vector = V>, b: &impl crate::SupportMap<Vector = V>) {
    use crate::{Scalar, support_value};

    for direction in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.5, -0.25, 0.75], [-1.0, 2.0, 0.125]] {
        let d = V::from_fn(|axis| Scalar::from_f64(direction[axis]));
        let (a, b) = (Scalar::as_f64(support_value(a, d)), Scalar::as_f64(support_value(b, d)));
        assert!((a - b).abs() <= 1e-6 * a.abs(), "along {direction:?}: {a} against {b}");
    }
}
