//! Steps that one distance allows: no change of pose within them brings the bodies nearer than the margin.

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Capsule, Cuboid, InvalidShape, Posed};
use gjk_raycast::{DistanceOptions, distance};

/// A box turns and moves within its step at random, and mostly uses most of it.
#[test]
fn what_a_step_allows_keeps_the_margin() -> Result<(), InvalidShape> {
    let mut seed = 0x2004_1120_u64;
    let mut random = || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        2.0 * ((seed >> 11) as f64 / (1_u64 << 53) as f64) - 1.0
    };
    let (mut nearest, margin) = (f64::INFINITY, 0.2);
    for _ in 0..400 {
        let mut vector = || DVec3::new(random(), random(), random());
        let size = vector().abs() + 0.05;
        let (turned, at, pivot) = (vector(), vector() * 3.0, vector());
        let still = Posed::translated(Capsule::<DVec3>::new(0.5, 0.25)?, DVec3::Z)?;
        let place = |rotation: DQuat, at: DVec3| Posed::new(Cuboid::new(size)?, rotation, at);
        let before = DQuat::from_scaled_axis(turned);
        let body = place(before, at)?;
        let known = distance(&body, &still, DistanceOptions::new());
        let step = known.free_step(&body, at + pivot, margin);
        if step.room <= 0.0 {
            assert!(!step.allows(0.0, 0.0), "no step without room");
            continue;
        }
        let share = 0.5 * (vector().x + 1.0);
        let angle = share * step.room / step.reach;
        let way = step.way(angle) * 0.999_999;
        assert!(step.allows(way, angle) && !step.allows(way + step.room, angle), "{step:?}");
        // Towards the other body, about the axis that brings the corner nearest it on.
        let towards = (known.point_b - known.point_a).normalize();
        let axis = (known.point_a - at - pivot).cross(towards).normalize_or(DVec3::X);
        let turn = DQuat::from_axis_angle(axis, angle);
        let moved = place(turn * before, at + pivot - turn * pivot + towards * way)?;
        let after = distance(&moved, &still, DistanceOptions::new());
        assert!(after.distance > margin, "{} of {margin}: {step:?}", after.distance);
        nearest = nearest.min(after.distance);
    }
    assert!(nearest < margin + 0.1, "some use all of their step: {nearest}");
    Ok(())
}
