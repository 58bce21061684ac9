//! A box on a conveyor passes a fixture given by its vertices. How close do they come, and do they touch?

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
    let parcel = Posed::new(Cuboid::new(DVec3::new(0.3, 0.2, 0.15))?, DQuat::from_rotation_z(0.2), DVec3::ZERO)?;

    let now = distance(&parcel, &fixture, DistanceOptions::default());
    println!("now {} m apart, between {} and {}", now.distance, now.point_a, now.point_b);

    let conveyor = Motion { velocity_a: DVec3::new(0.5, 0.0, 0.0), velocity_b: DVec3::ZERO };
    match linear_cast(&parcel, &fixture, conveyor, LinearCastOptions::default())?.outcome {
        Outcome::Hit(hit) => println!("they touch after {} s, at {}", hit.time, hit.point),
        Outcome::Miss(miss) => println!("they pass; a plane across {} stays between them", miss.axis),
        Outcome::Undecided => println!("too close to call"),
    }
    Ok(())
}
