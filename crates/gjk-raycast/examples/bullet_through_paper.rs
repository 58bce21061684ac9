//! A bullet crosses a sheet of paper within one step of a simulation. Does it hit, when, and where?
//!
//! `cargo run -p gjk-raycast --example bullet_through_paper`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec3;
use convex_support::{Capsule, Cuboid, Posed};
use gjk_raycast::{LinearCastOptions, Motion, intersects, linear_cast};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // In metres: a tenth of a millimetre thin, and ten metres away. The bullet's axis is y, across its path.
    let paper = Posed::translated(Cuboid::new(DVec3::new(0.00005, 0.15, 0.1))?, DVec3::new(10.0, 0.0, 0.0))?;
    let bullet = Capsule::new(0.01, 0.004)?;

    // 800 m/s at 60 steps per second: the bullet moves 13 m, and is behind the paper before the next step begins.
    let motion = Motion { velocity_a: DVec3::new(800.0, 0.5, 0.0), velocity_b: DVec3::ZERO };
    let step = 1.0 / 60.0;

    // Asking only where things are at the ends of the step, nothing ever happens.
    let behind = Posed::translated(bullet, motion.velocity_a * step)?;
    for place in [Posed::translated(bullet, DVec3::ZERO)?, behind] {
        assert_eq!(intersects(&place, &paper, Default::default()).decided(), Some(false), "apart");
    }

    let answer = linear_cast(&bullet, &paper, motion, LinearCastOptions::new().with_max_time(step))?;
    let hit = answer.outcome.hit().ok_or("the paper is in the way")?;
    println!("the paper is touched after {:.6} ms, at {:.6}", hit.time * 1e3, hit.point);
    println!("certainly within {:.0e} s of that", answer.upper - answer.lower);

    let due = (10.0 - 0.00005 - 0.004) / 800.0;
    assert!((hit.time - due).abs() < 1e-15 * due.max(1.0), "{} instead of {due}", hit.time);
    assert!(answer.lower <= hit.time && hit.time <= answer.upper, "the time is within its bounds");
    let normal = hit.normal.ok_or("it comes from outside")?;
    assert!(normal.distance(DVec3::NEG_X) < 1e-15, "the paper's side towards the gun, not {normal}");
    Ok(())
}
