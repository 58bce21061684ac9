//! A part lies deep inside an obstacle. Which way out? Gradient descent on the common scale, where margin and distance
//! are flat.
//!
//! `cargo run -p ellip-margin --example out_of_overlap`

#![allow(clippy::print_stdout, reason = "an example talks")]

use ellip_margin::convex_support::{
    Ellipsoid, InvalidShape,
    glam::{DQuat, DVec3},
};
use ellip_margin::{EllipsoidPair, MarginOptions};

fn main() -> Result<(), InvalidShape> {
    let obstacle = Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 0.6, 0.3), DQuat::from_rotation_y(0.4))?;
    let mut part =
        Ellipsoid::new(DVec3::new(0.1, -0.05, 0.08), DVec3::new(0.5, 0.2, 0.2), DQuat::from_rotation_z(1.0))?;

    for step in 0..40 {
        let pair = EllipsoidPair::new(&part, &obstacle, MarginOptions::default());
        let (margin, scaling) = (pair.margin(), pair.scaling());
        println!("step {step:2}: scale {:.4}, margin {:7.4}", scaling.scale, margin.margin);
        if step == 0 {
            assert_eq!(margin.gradient().translation, DVec3::ZERO, "the margin is at its floor and says nothing");
        }
        if scaling.scale > 1.05 {
            assert!(margin.margin > 0.0 && pair.distance().distance > 0.0, "they are apart");
            return Ok(());
        }
        // A step of at most 5 cm and 0.1 rad that aims at a scale of 1.1.
        let gradient = scaling.gradient();
        let (force, torque) = (gradient.translation, gradient.rotation);
        let slope = force.length_squared() + torque.length_squared();
        let length = ((1.1 - scaling.scale) / slope).min(0.05 / force.length()).min(0.1 / torque.length());
        let turn = DQuat::from_scaled_axis(torque * length);
        let centre = part.center();
        // About its own centre, then along.
        part = part.posed(turn, centre + force * length - turn * centre)?;
    }
    unreachable!("forty steps of 5 cm lead out of an obstacle of 1 m")
}
