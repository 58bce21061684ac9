//! Which way should the joints turn to get a planar arm away from an obstacle? A few steps along the gradient of its
//! clearance.
//!
//! `cargo run -p ellip-margin --example robot_clearance_with_gradient_step`

#![allow(clippy::print_stdout, reason = "an example talks")]

use ellip_margin::convex_support::{Ellipsoid, InvalidShape, glam::DVec2};
use ellip_margin::{EllipsoidPair, InvalidQuery, MarginOptions, clearance};

const LENGTHS: [f64; 3] = [1.0, 0.8, 0.6];

/// The joints' positions and the links' ellipses at the given joint angles.
fn pose(angles: [f64; 3]) -> Result<([DVec2; 3], [Ellipsoid<DVec2>; 3]), InvalidShape> {
    let (mut joint, mut heading) = (DVec2::ZERO, 0.0);
    let mut joints = [DVec2::ZERO; 3];
    let mut links = [Ellipsoid::new(DVec2::ZERO, DVec2::ONE, 0.0)?; 3];
    for k in 0..3 {
        heading += angles[k];
        let along = DVec2::from_angle(heading) * LENGTHS[k];
        joints[k] = joint;
        links[k] = Ellipsoid::new(joint + along * 0.5, DVec2::new(0.55 * LENGTHS[k], 0.1), heading)?;
        joint += along;
    }
    Ok((joints, links))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let obstacles = [
        Ellipsoid::new(DVec2::new(1.5, 1.1), DVec2::new(0.4, 0.2), 0.5)?,
        Ellipsoid::new(DVec2::new(0.3, 1.6), DVec2::new(0.3, 0.3), 0.0)?,
    ];
    let mut angles = [0.3, 0.2, 0.4];
    let margin = |angles: [f64; 3]| -> Result<_, Box<dyn std::error::Error>> {
        let (joints, links) = pose(angles)?;
        let least = clearance(&links, &obstacles, MarginOptions::default()).map_err(|e: InvalidQuery| e.to_string())?;
        Ok((joints, links, least))
    };

    for step in 0..12 {
        let (joints, links, least) = margin(angles)?;
        let pair = EllipsoidPair::new(&links[least.link], &obstacles[least.obstacle], MarginOptions::default());
        let gradient = pair.margin().gradient();
        // A joint moves the links beyond it, itself included.
        let slope: [f64; 3] =
            std::array::from_fn(|k| if k <= least.link { gradient.revolute(joints[k], 1.0) } else { 0.0 });
        println!(
            "step {step:2}: margin {:8.3} of link {} about obstacle {}, ∂m/∂q = [{:7.2}, {:7.2}, {:7.2}]",
            least.margin.margin, least.link, least.obstacle, slope[0], slope[1], slope[2]
        );
        let length = slope.iter().map(|s| s * s).sum::<f64>().sqrt();
        if length == 0.0 {
            break;
        }
        for (angle, slope) in angles.iter_mut().zip(slope) {
            *angle += 0.05 * slope / length;
        }
    }
    let (.., last) = margin(angles)?;
    assert!(last.margin.margin > 1.0, "the arm has got clear of the obstacles");
    Ok(())
}
