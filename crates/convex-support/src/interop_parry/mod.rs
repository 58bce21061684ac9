//! Bridges to parry, for code that moves from it or uses both.
//!
//! parry is one crate for each dimension and precision, with the same names in each; so is this bridge: one text, compiled
//! for each, and another that 3D space or the plane has beside.

/// parry2d's shapes as shapes of this crate, and back; single precision.
#[cfg(feature = "parry2d")]
pub mod parry2d {
    use ::parry2d as parry;
    use glam::Vec2 as V;

    include!("shapes.rs");
    include!("planar.rs");
}

/// parry2d-f64's shapes as shapes of this crate, and back; double precision.
#[cfg(feature = "parry2d-f64")]
pub mod parry2d_f64 {
    use ::parry2d_f64 as parry;
    use glam::DVec2 as V;

    include!("shapes.rs");
    include!("planar.rs");
}

/// parry3d's shapes as shapes of this crate, and back; single precision.
#[cfg(feature = "parry3d")]
pub mod parry3d {
    use ::parry3d as parry;
    use glam::Vec3 as V;

    include!("shapes.rs");
    include!("solid.rs");
}

/// parry3d-f64's shapes as shapes of this crate, and back; double precision.
#[cfg(feature = "parry3d-f64")]
pub mod parry3d_f64 {
    use ::parry3d_f64 as parry;
    use glam::DVec3 as V;

    include!("shapes.rs");
    include!("solid.rs");
}
