//! A box is thrown through a gap between two posts and tumbles on the way. It fits through lengthwise; whether it does
//! depends on how fast it turns.
//!
//! `cargo run -p gjk-raycast --example thrown_box_through_a_gap`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec3;
use convex_support::{Cuboid, Posed};
use gjk_raycast::{MotionCastOptions, Outcome, RigidMotion, motion_cast};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let parcel = Posed::translated(Cuboid::new(DVec3::new(0.5, 0.15, 0.2))?, DVec3::new(-3.0, 0.0, 0.0))?;
    let post = Cuboid::new(DVec3::new(0.1, 1.0, 2.0))?;
    let posts = [-1.0, 1.0].map(|side| Posed::translated(post, DVec3::new(0.0, 1.45 * side, 0.0)));
    let options = MotionCastOptions::new().with_max_time(1.0);

    // It is between the posts after half a second: lengthwise after half a turn, crosswise after a quarter or three.
    // After a whole turn it is lengthwise too, but turns so fast that it is not for long enough.
    for (turns, fits) in [(0.0, true), (1.0, true), (0.5, false), (1.5, false), (2.0, false)] {
        let thrown = RigidMotion {
            velocity: DVec3::new(6.0, 0.0, 0.0),
            angular_velocity: DVec3::new(0.0, 0.0, turns * std::f64::consts::TAU),
            center: DVec3::new(-3.0, 0.0, 0.0),
        };
        let mut first: Option<f64> = None;
        for post in &posts {
            let cast =
                motion_cast(&parcel, thrown, post.as_ref().map_err(Clone::clone)?, RigidMotion::default(), options)?;
            match cast.outcome {
                Outcome::Hit(hit) => first = Some(first.map_or(hit.time, |time| time.min(hit.time))),
                Outcome::Miss(_) => {}
                Outcome::Undecided => panic!("it is clear"),
            }
        }
        match first {
            None => println!("{turns} turns a second: through, proved"),
            Some(time) => println!("{turns} turns a second: strikes a post after {time:.6} s"),
        }
        assert_eq!(first.is_none(), fits, "{turns} turns a second");
    }
    Ok(())
}
