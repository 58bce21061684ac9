//! A ball comes up under a blade that turns forty times a second. Does the blade strike it? Sampling at the rate of a
//! game would miss the stroke.
//!
//! `cargo run -p gjk-raycast --example spinning_blade_over_a_ball`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec3;
use convex_support::{Ball, Cuboid, Posed};
use gjk_raycast::{DistanceOptions, MotionCastOptions, Outcome, RigidMotion, Trajectory, distance, motion_cast_with};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let blade = Cuboid::new(DVec3::new(1.0, 0.05, 0.01))?;
    let spin = RigidMotion::rotation(DVec3::Z * 80.0 * std::f64::consts::PI, DVec3::ZERO);
    let rise = RigidMotion::translation(DVec3::Z * 0.5);
    let ball = Ball::new(0.1)?;
    let options = MotionCastOptions::new().with_max_time(1.0);

    for radius in [0.8, 1.2] {
        let start = Posed::translated(ball, DVec3::new(radius, 0.0, -0.3))?;
        let mut looks = 0;
        let cast = motion_cast_with(&blade, spin, &start, rise, options, |_| looks += 1)?;
        println!("{radius} from the axis: {looks} times looked at");
        match cast.outcome {
            Outcome::Hit(hit) => {
                println!(
                    "  struck at {:.12} s, {:.4}, in [{:.15}, {:.15}]",
                    hit.time, hit.point, cast.lower, cast.upper
                );
                assert_eq!(radius, 0.8, "the blade does not reach {radius}");
                // The ball reaches the lower side of the blade at 0.38 s, and the blade comes by every eightieth of a
                // second.
                assert!((0.38..0.38 + 1.0 / 80.0).contains(&hit.time), "struck at {}", hit.time);
                let apart = |time: f64| {
                    let turned =
                        Posed::from_matrix(blade, spin.displacement(time).rotation(), DVec3::ZERO).expect("a rotation");
                    let raised = Posed::translated(start, rise.velocity * time).expect("finite");
                    distance(&turned, &raised, DistanceOptions::default()).distance
                };
                assert!(apart(cast.lower) < 1e-12, "{} apart just before", apart(cast.lower));
                assert!((0..38_000).all(|i| apart(cast.lower * f64::from(i) / 38_000.0) > 0.0), "struck before");
            }
            Outcome::Miss(_) => {
                println!("  the blade passes it by, proved at every time of {} s", options.max_time);
                assert_eq!(radius, 1.2, "the blade reaches {radius}");
            }
            Outcome::Undecided => panic!("it is clear"),
        }
    }
    Ok(())
}
