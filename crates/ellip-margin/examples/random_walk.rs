//! The paper's experiment: an elliptic link walks at random past an elliptic obstacle on a grid of 128 × 128 cells, and
//! the margin is tracked. How large may a step be?
//!
//! Rimon and Boyd report seven inverse iterations a step at one degree and one cell, and no correct convergence beyond
//! about five degrees and five cells.
//!
//! `cargo run --release -p ellip-margin --features paper --example random_walk`

#![allow(clippy::print_stdout, reason = "an example talks")]

use ellip_margin::convex_support::{Ellipsoid, InvalidShape, glam::DVec2};
use ellip_margin::paper::InverseIterationTracker;
use ellip_margin::{MarginOptions, MarginTracker, free_margin};

/// Random numbers by splitmix64.
struct Rng(u64);

impl Rng {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }
}

/// A biased walk of `steps` poses: each moves by −1, 0 or 1 times `cells` of the grid along x and y, drawn so that it
/// drifts to the opposite corner, and turns by −1, 0 or 1 times `degrees`.
fn walk(
    rng: &mut Rng,
    link: DVec2,
    degrees: f64,
    cells: f64,
    steps: usize,
) -> Result<Vec<Ellipsoid<DVec2>>, InvalidShape> {
    let (mut at, mut angle) = (DVec2::new(0.05 + 0.2 * rng.unit(), 0.95 - 0.2 * rng.unit()), 0.0);
    let mut poses = Vec::with_capacity(steps);
    for _ in 0..steps {
        poses.push(Ellipsoid::new(at, link, angle)?);
        let draw = |u: f64, bias: f64| {
            if u < 0.5 + bias {
                1.0
            } else if u < 0.75 + bias {
                0.0
            } else {
                -1.0
            }
        };
        at += DVec2::new(draw(rng.unit(), 0.0), -draw(rng.unit(), 0.0)) * (cells / 128.0);
        at = at.clamp(DVec2::ZERO, DVec2::ONE);
        angle += draw(rng.unit(), -0.125) * degrees.to_radians();
    }
    Ok(poses)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("  step        inverse iteration (ε = 1e-6)       Newton");
    println!("deg = cells   iterations  failed  wrong      iterations  wrong");
    for size in [1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0] {
        let mut rng = Rng(7);
        let (mut steps, mut failed, mut wrong, mut paper_iterations) = (0, 0, 0, 0);
        let (mut iterations, mut our_wrong) = (0, 0);
        for _ in 0..40 {
            let link = DVec2::new(0.06 + 0.08 * rng.unit(), 0.02 + 0.03 * rng.unit());
            let obstacle = Ellipsoid::new(
                DVec2::new(0.4 + 0.2 * rng.unit(), 0.4 + 0.2 * rng.unit()),
                DVec2::new(0.08 + 0.1 * rng.unit(), 0.04 + 0.05 * rng.unit()),
                3.0 * rng.unit(),
            )?;
            let (mut paper, mut ours) = (InverseIterationTracker::new(1e-6, 14)?, MarginTracker::default());
            for pose in walk(&mut rng, link, size, size, 200)? {
                let exact = free_margin(&pose, &obstacle, MarginOptions::default()).margin;
                let close = |m: f64, tolerance: f64| (m - exact).abs() <= tolerance * (1.0 + exact);
                wrong += u64::from(!close(paper.step(&pose, &obstacle).margin, 1e-4));
                our_wrong += u64::from(!close(ours.step(&pose, &obstacle).margin, 1e-13));
                steps += 1;
            }
            failed += paper.fallbacks() - 1; // the first pose has nothing to start from
            paper_iterations += paper.iterations();
            iterations += ours.iterations();
        }
        let per_step = |n: u64| n as f64 / steps as f64;
        println!(
            "{size:7}       {:10.2} {:6.1} % {wrong:6}      {:10.2} {our_wrong:6}",
            per_step(paper_iterations),
            100.0 * per_step(failed),
            per_step(iterations)
        );
    }
    Ok(())
}
