//! A box on a conveyor passes a fixture given by its vertices. How close are they, and will they touch?
//!
//! `cargo run -p gjk-raycast --example moving_box_against_hull`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Cuboid, Polytope, Posed};
use gjk_raycast::{DistanceOptions, LinearCastOptions, Motion, Outcome, distance, linear_cast};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let fixture = Polytope::new([
        DVec3::new(2.0, 0.3, 0.0),
        DVec3::new(2.4, 0.6, 0.0),
        DVec3::new(2.0, 0.9, 0.0),
        DVec3::new(2.1, 0.6, 0.8),
    ])?;
    let parcel = Cuboid::new(DVec3::new(0.3, 0.2, 0.15))?;
    let turned = DQuat::from_rotation_z(0.2);
    let conveyor = Motion { velocity_a: DVec3::new(0.5, 0.0, 0.0), velocity_b: DVec3::ZERO };

    for offset in [0.1, 0.0] {
        let start = Posed::new(parcel, turned, DVec3::new(0.0, offset, 0.0))?;
        let now = distance(&start, &fixture, DistanceOptions::default());
        println!(
            "starting at y = {offset}: {:.4} m apart, between {:.3} and {:.3}",
            now.distance, now.point_a, now.point_b
        );

        match linear_cast(&start, &fixture, conveyor, LinearCastOptions::default())?.outcome {
            Outcome::Hit(hit) => {
                println!("  they touch after {:.4} s, at {:.3}", hit.time, hit.point);
                let then = Posed::new(parcel, turned, start.translation() + conveyor.velocity_a * hit.time)?;
                let left = distance(&then, &fixture, DistanceOptions::default());
                println!("  a look at that moment: {:.0e} m apart", left.distance);
                assert!(left.distance < 1e-14, "a distance of {} where they touch", left.distance);
                assert_eq!(offset, 0.1, "only the upper box touches");
            }
            Outcome::Miss(miss) => {
                println!("  they pass: a plane across {:.3} stays between them", miss.axis);
                assert!(miss.axis.dot(conveyor.velocity_a) > -1e-12, "the box moves along the plane, or away");
                assert_eq!(offset, 0.0, "only the lower box passes");
            }
            Outcome::Undecided => println!("  too close to call"),
        }
    }
    Ok(())
}
