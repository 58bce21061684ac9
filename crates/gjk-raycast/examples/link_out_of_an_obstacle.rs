//! A planner pushes a robot's link out of an obstacle: a step along the normal by the depth and a margin.
//!
//! `cargo run --release -p gjk-raycast --example link_out_of_an_obstacle`

#![allow(clippy::print_stdout, reason = "examples print what they find")]

use gjk_raycast::convex_support::glam::{DQuat, DVec3};
use gjk_raycast::convex_support::{Capsule, Cylinder, InvalidShape, Posed};
use gjk_raycast::{SignedDistanceOptions, signed_distance};

const MARGIN: f64 = 0.02;

fn main() -> Result<(), InvalidShape> {
    let link = Capsule::<DVec3>::new(0.25, 0.06)?;
    let pillar = Cylinder::<DVec3>::new(1.0, 0.3)?;
    let turn = DQuat::from_rotation_z(1.2) * DQuat::from_rotation_x(0.4);
    let mut center = DVec3::new(0.2, 0.1, 0.05);
    let posed = |center| Posed::new(link, turn, center);
    let start = signed_distance(&posed(center)?, &pillar, SignedDistanceOptions::default());
    println!("deep by {:.6}, certain between {:.6} and {:.6}", -start.signed_distance, -start.upper, -start.lower);
    assert!(start.overlap && start.upper < 0.0, "the link begins inside: {start:?}");

    center += start.normal * (MARGIN - start.signed_distance);
    let out = signed_distance(&posed(center)?, &pillar, SignedDistanceOptions::default().with_axis(start.normal));
    println!("after one step along {:.3}: {:.9} away", start.normal, out.signed_distance);
    assert!((out.signed_distance - MARGIN).abs() < 1e-9 && out.lower > 0.0, "{out:?}");
    Ok(())
}
