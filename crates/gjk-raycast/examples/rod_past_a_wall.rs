//! A rod swings about its end towards a wall. Does it pass, and if not, when does it strike?
//!
//! `cargo run -p gjk-raycast --example rod_past_a_wall`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::Segment;
use convex_support::glam::DVec2;
use gjk_raycast::{HalfSpace, MotionCastOptions, Outcome, RigidMotion};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The wall is all that is beyond y = 2, and the rod lies along x at first: it turns by two radians a second, for
    // half a turn.
    let wall = HalfSpace::new(DVec2::NEG_Y, -2.0)?;
    let swing = RigidMotion::rotation(2.0, DVec2::ZERO);
    let options = MotionCastOptions::new().with_max_time(std::f64::consts::FRAC_PI_2);

    for length in [1.999, 2.5] {
        let rod = Segment::new([DVec2::ZERO, DVec2::new(length, 0.0)])?;
        let cast = wall.motion_cast(&rod, swing, options)?;
        match cast.outcome {
            Outcome::Hit(hit) => {
                // Its tip is at the height of the face where length·sin 2t = 2.
                let truth = (2.0 / length).asin() / 2.0;
                println!("length {length}: strikes at {:.15} s, {:.4}", hit.time, hit.point);
                println!("  certainly between {:.16} and {:.16} s", cast.lower, cast.upper);
                assert!(cast.lower <= truth && truth <= cast.upper, "the true time is {truth}");
                assert!(cast.upper - cast.lower < 1e-13, "a bracket of {}", cast.upper - cast.lower);
            }
            Outcome::Miss(_) => {
                println!("length {length}: passes, proved for the whole swing");
                assert!(length < 2.0, "a rod of length {length} strikes");
            }
            Outcome::Undecided => panic!("a millimetre is not too close to call"),
        }
    }
    Ok(())
}
