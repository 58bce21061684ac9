//! A microcontroller keeps the arm that it drives from a post: how far is the forearm, and how does that change as
//! either joint turns?
//!
//! Single precision, no standard library, and no allocator: without the feature `alloc` there are only the questions
//! that need none, which are support points, closed forms, `intersects`, `distance` and its gradient, and ray casts.

#![no_std]

use gjk_raycast::convex_support::glam::{Quat, Vec3};
use gjk_raycast::convex_support::{Capsule, Cuboid, InvalidShape, Posed};
use gjk_raycast::{DistanceOptions, Ray, RayCastError, RayCastOptions, distance, ray_cast};

/// How near the forearm is to the post.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Clearance {
    /// In metres; 0 where they touch.
    pub distance: f32,
    /// What is proved: they are not nearer than this.
    pub at_least: f32,
    /// The change of the distance per radian of the shoulder and of the elbow, in metres.
    pub rates: [f32; 2],
}

/// The length of the upper arm, in metres.
const UPPER_ARM: f32 = 0.3;
/// Half the length of the forearm.
const HALF_FOREARM: f32 = 0.125;

/// The post.
fn post() -> Posed<Cuboid<Vec3>> {
    let post =
        Cuboid::new(Vec3::new(0.05, 0.05, 0.5)).and_then(|post| Posed::translated(post, Vec3::new(0.4, 0.4, 0.0)));
    post.expect("its measures are finite")
}

/// The clearance at these angles of the shoulder, which is at the origin and turns about z, and of the elbow. At zero
/// the arm is stretched along x.
///
/// # Errors
/// [`InvalidShape`] if an angle is not finite.
pub fn clearance(shoulder: f32, elbow: f32) -> Result<Clearance, InvalidShape> {
    let pivot = Quat::from_rotation_z(shoulder) * (Vec3::X * UPPER_ARM);
    let along = Quat::from_rotation_z(shoulder + elbow);
    // A capsule lies along y.
    let turned = along * Quat::from_rotation_z(-core::f32::consts::FRAC_PI_2);
    let forearm = Posed::new(Capsule::new(HALF_FOREARM, 0.03)?, turned, pivot + along * (Vec3::X * HALF_FOREARM))?;

    let gap = distance(&forearm, &post(), DistanceOptions::default());
    let by_pose = gap.gradient().a;
    let rates = [by_pose.revolute(Vec3::ZERO, Vec3::Z), by_pose.revolute(pivot, Vec3::Z)];
    Ok(Clearance { distance: gap.distance, at_least: gap.lower, rates })
}

/// How far along its beam a sensor at the wrist sees the post, if it does.
///
/// # Errors
/// [`RayCastError`] if a coordinate is not finite, or the direction is zero.
pub fn seen_at(source: Vec3, direction: Vec3) -> Result<Option<f32>, RayCastError> {
    let ray = Ray { source, direction };
    Ok(ray_cast(&post(), ray, RayCastOptions::default())?.outcome.hit().map(|hit| hit.lambda))
}

/// Where there is no standard library, a program says what a panic does.
#[cfg(all(not(test), any(target_os = "none", target_os = "unknown")))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
