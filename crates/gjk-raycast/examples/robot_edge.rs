//! A robot arm of three joints moves straight in joint space between two configurations. Is the path free, at every
//! time?
//!
//! `cargo run -p gjk-raycast --example robot_edge`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ball, Posed, Rounded, Segment};
use gjk_raycast::{
    ChainMotion, DistanceOptions, MotionCastOptions, Outcome, RigidMotion, Trajectory, distance, motion_cast,
};

/// A turntable about z, then a shoulder and an elbow about y, with links of length 1 and 0.8.
struct Arm {
    angles: [f64; 3],
}

impl Arm {
    /// The axes of the joints and points on them, and the ends of the links.
    fn joints(&self) -> [(DVec3, DVec3); 3] {
        let [turn, shoulder, _] = self.angles;
        let (table, up) = (DQuat::from_rotation_z(turn), DVec3::new(0.0, 0.0, 0.5));
        let upper = table * DQuat::from_rotation_y(shoulder);
        [(DVec3::Z, DVec3::ZERO), (table * DVec3::Y, up), (table * DVec3::Y, up + upper * DVec3::X)]
    }

    fn hand(&self) -> DVec3 {
        let [turn, shoulder, elbow] = self.angles;
        let [_, _, (_, at)] = self.joints();
        at + DQuat::from_rotation_z(turn) * DQuat::from_rotation_y(shoulder + elbow) * DVec3::X * 0.8
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (from, to) = (Arm { angles: [0.0, 0.3, 0.4] }, Arm { angles: [1.8, -0.7, 0.9] });
    // The edge takes one second: each joint turns at a constant rate about where its axis is at first.
    let rates = [0, 1, 2].map(|i| to.angles[i] - from.angles[i]);
    let joints = [0, 1, 2].map(|i| {
        let (axis, at) = from.joints()[i];
        RigidMotion::rotation(axis * rates[i], at)
    });
    let [_, (_, shoulder), (_, elbow)] = from.joints();
    let upper_arm = Rounded::new(Segment::new([shoulder, elbow])?, 0.08)?;
    let forearm = Rounded::new(Segment::new([elbow, from.hand()])?, 0.06)?;
    let options = MotionCastOptions::new().with_max_time(1.0);

    // The chain takes the hand where the arm of the last configuration has it.
    let end = ChainMotion::new(&joints).displacement(1.0).of(from.hand());
    assert!((end - to.hand()).length() < 1e-15, "{end} is not {}", to.hand());

    let mut met = 0;
    for (name, at) in [
        ("bottle", DVec3::new(0.9, 1.0, 0.2)),
        ("cup", DVec3::new(0.4, 1.5, 0.75)),
        ("lamp", DVec3::new(1.2, 1.2, 1.4)),
        ("wall", DVec3::new(-0.4, -1.2, 0.5)),
    ] {
        let obstacle = Posed::translated(Ball::new(0.15)?, at)?;
        for (link, shape, carried_by) in [("upper arm", upper_arm, &joints[..2]), ("forearm", forearm, &joints[..])] {
            let motion = ChainMotion::new(carried_by);
            let cast = motion_cast(&shape, motion, &obstacle, RigidMotion::default(), options)?;
            let apart = |time: f64| {
                let d = motion.displacement(time);
                let moved = Posed::from_matrix(shape, d.rotation(), d.of(DVec3::ZERO)).expect("a rotation");
                distance(&moved, &obstacle, DistanceOptions::default()).distance
            };
            let least = (0..=1000).map(|i| apart(f64::from(i) / 1000.0)).fold(f64::INFINITY, f64::min);
            match cast.outcome {
                Outcome::Miss(_) => {
                    println!("{link} past the {name}: free, proved ({least:.3} apart at the least)");
                    assert!(least > 0.0, "the {link} meets the {name}");
                }
                Outcome::Hit(hit) => {
                    println!("{link} into the {name}: first contact in [{:.14}, {:.14}]", cast.lower, cast.upper);
                    assert!(apart(hit.time) < 1e-13, "{} apart", apart(hit.time));
                    met += 1;
                }
                Outcome::Undecided => panic!("it is clear"),
            }
        }
    }
    assert!((1..8).contains(&met), "some are met and some are not: {met}");
    Ok(())
}
