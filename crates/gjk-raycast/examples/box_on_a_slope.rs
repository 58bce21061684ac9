//! A box slides down a slope and comes to rest after the distance that the laws of friction give.
//!
//! On a slope of angle θ with friction μ > tan θ it decelerates by g·(μ·cos θ − sin θ), so that from a speed v it
//! slides v²/2g/(μ·cos θ − sin θ).
//!
//! `cargo run --release -p gjk-raycast --example box_on_a_slope`

#![allow(clippy::print_stdout, reason = "examples print what they find")]

mod world;

use gjk_raycast::convex_support::glam::{DMat3, DVec3};
use world::{Body, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (angle, friction, speed, g) = (0.3_f64, 0.6, 3.0, 9.81);
    let turn = DMat3::from_rotation_z(-angle);
    let (downhill, up) = (turn.x_axis, turn.y_axis);
    let slope = Body::fixed(DVec3::new(20.0, 1.0, 5.0), -up, turn)?;
    let mut parcel = Body::cuboid(DVec3::new(0.5, 0.2, 0.4), up * 0.2, turn)?;
    parcel.velocity = downhill * speed;
    let mut world = World::new(vec![slope, parcel], DVec3::new(0.0, -g, 0.0), friction);
    for _ in 0..600 {
        world.step(1.0 / 120.0)?;
    }
    let slid = world.bodies[1].center.dot(downhill);
    let expected = speed * speed / (2.0 * g * (friction * angle.cos() - angle.sin()));
    println!("slid {slid:.3} m, by the formula {expected:.3} m; speed {:.1e} m/s", world.bodies[1].velocity.length());
    assert!((slid - expected).abs() < 0.03 * expected, "slid {slid}, expected {expected}");
    assert!(world.bodies[1].velocity.length() < 1e-3, "it rests");
    Ok(())
}
