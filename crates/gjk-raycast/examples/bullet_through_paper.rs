//! A bullet crosses a sheet of paper within one step of a simulation. Does it hit, when, and where?

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec3;
use convex_support::{Capsule, Cuboid, Posed};
use gjk_raycast::{LinearCastOptions, Motion, linear_cast};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let paper = Posed::translated(Cuboid::new(DVec3::new(0.00005, 0.15, 0.1))?, DVec3::new(10.0, 0.0, 0.0))?;
    let bullet = Capsule::new(0.01, 0.004)?;

    // 800 m/s at 60 steps per second: the bullet moves 13 m, and is behind the paper before the next step begins.
    let motion = Motion { velocity_a: DVec3::new(800.0, 0.5, 0.0), velocity_b: DVec3::ZERO };
    let step = LinearCastOptions::new().with_max_time(1.0 / 60.0);

    let answer = linear_cast(&bullet, &paper, motion, step)?;
    let hit = answer.outcome.hit().ok_or("the paper is in the way")?;
    println!("through the paper after {} ms, at {} m", hit.time * 1e3, hit.point);
    println!("certainly not before {} ms and not after {} ms", answer.lower * 1e3, answer.upper * 1e3);
    Ok(())
}
