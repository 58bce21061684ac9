//! Where must the centre of a robot not be? In the difference of the obstacle and the robot, which is a shape again.
//!
//! `cargo run -p convex-support --example keep_out_zone`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec2;
use convex_support::{
    Capsule, Cuboid, Difference, InvalidShape, MinkowskiSum, Posed, SupportMap, bounding_box, support_value,
};

fn main() -> Result<(), InvalidShape> {
    // A mower: a box with a bumper all around, here a capsule that is added to it.
    let mower = MinkowskiSum::new(Cuboid::new(DVec2::new(0.3, 0.2))?, Capsule::new(0.1, 0.05)?);
    let bed = Posed::new(Cuboid::new(DVec2::new(1.0, 0.5))?, 30f64.to_radians(), DVec2::new(4.0, 2.0))?;
    let keep_out = Difference::new(&bed, &mower);

    // Its outline, by the support point in directions all around.
    println!("the mower's centre has to stay outside of");
    for degrees in (0..360).step_by(30) {
        let direction = DVec2::from_angle(f64::from(degrees).to_radians());
        let point = keep_out.support(direction);
        println!("  ({:.3}, {:.3}), the farthest at {degrees}°", point.x, point.y);
        // How far a sum reaches is the sum of how far its parts do; a difference takes the other side of the second.
        let reach = support_value(&bed, direction) + support_value(&mower, -direction);
        assert!((support_value(&keep_out, direction) - reach).abs() < 1e-14, "support values add up");
    }

    let bounds = bounding_box(&keep_out);
    println!("all of which lies between {} and {}", bounds.min, bounds.max);
    assert!(
        bounds.min.x < 4.0 - 0.35 && bounds.max.x > 4.0 + 0.35,
        "the mower's half width is kept free on both sides"
    );
    Ok(())
}
