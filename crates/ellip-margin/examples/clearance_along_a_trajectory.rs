//! A robot moves among ten thousand obstacles. What is its least clearance on the way, and how few pairs need a look?
//!
//! `cargo run --release -p ellip-margin --example clearance_along_a_trajectory`

#![allow(clippy::print_stdout, reason = "an example talks")]

use ellip_margin::convex_support::{
    Ellipsoid, InvalidShape,
    glam::{DQuat, DVec3},
};
use ellip_margin::{Clearance, MarginOptions, clearance};

/// A warehouse of 100 × 100 things, one in every square metre, all of them turned differently.
fn obstacles() -> Result<Vec<Ellipsoid<DVec3>>, InvalidShape> {
    let obstacle = |i: u32| {
        let (x, z) = (f64::from(i % 100), f64::from(i / 100));
        let turn = DQuat::from_rotation_y(f64::from(i)) * DQuat::from_rotation_x(0.3);
        Ellipsoid::new(DVec3::new(x, 0.5, z), DVec3::new(0.15, 0.4, 0.05), turn)
    };
    (0..10_000).map(obstacle).collect()
}

/// A mast with five arms around it, driving along an aisle and turning as it goes.
fn links(time: f64) -> Result<Vec<Ellipsoid<DVec3>>, InvalidShape> {
    let base = DVec3::new(40.5 + 0.2 * (3.0 * time).sin(), 1.0, 20.0 + 10.0 * time);
    let mut links = vec![Ellipsoid::new(base, DVec3::new(0.1, 1.0, 0.1), DQuat::IDENTITY)?];
    for arm in 0..5 {
        let turn = DQuat::from_rotation_y(2.0 * time + f64::from(arm) * std::f64::consts::TAU / 5.0);
        let middle = base + turn * DVec3::new(0.3, 0.2 * f64::from(arm), 0.0);
        links.push(Ellipsoid::new(middle, DVec3::new(0.3, 0.05, 0.05), turn)?);
    }
    Ok(links)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (obstacles, steps) = (obstacles()?, 1000);
    let mut scene = Clearance::new(&obstacles, MarginOptions::default())?;
    let (mut least, mut solved, mut by_motion, mut by_box, mut closer) = (None, 0, 0, 0, 0);
    for step in 0..=steps {
        let time = f64::from(step) / f64::from(steps);
        let nearest = scene.step(&links(time)?)?;
        if least.is_none_or(|(_, margin)| nearest.margin.margin < margin) {
            least = Some((time, nearest.margin.margin));
        }
        if step % 100 == 0 {
            let margin = nearest.margin.margin;
            println!("t = {time:.1}: margin {margin:.4}, link {} about obstacle {}", nearest.link, nearest.obstacle);
        }
        solved += nearest.pairs_evaluated;
        by_motion += nearest.left_out.by_motion;
        by_box += nearest.left_out.by_box;
        closer += nearest.left_out.by_sphere + nearest.left_out.by_plane + nearest.left_out.by_normal;
    }

    let (time, margin) = least.ok_or("there are steps")?;
    println!("the least: {margin:.4} at t = {time:.3}");
    let pairs = (steps as usize + 1) * 6 * obstacles.len();
    println!("\nof {pairs} pairs, {solved} were solved, and left out were");
    println!("{by_motion:10} because the link had moved too little to matter,");
    println!("{by_box:10} because the box around their group was too far,");
    println!("{closer:10} because its ball or a plane before it was.");
    assert_eq!(solved + by_motion + by_box + closer, pairs, "every pair is accounted for");

    // What is left out changes nothing: all pairs give the same, to the last bit.
    let plain = clearance(&links(time)?, &obstacles, MarginOptions::default())?;
    assert_eq!(plain.margin.margin, margin, "all pairs, and the few that can matter");
    Ok(())
}
