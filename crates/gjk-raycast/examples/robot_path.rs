//! A robot reaches from one side of a post to the other. Which of its links may ever meet? Is the straight way free,
//! and if not, what is met first? And the way around?
//!
//! `cargo run -p gjk-raycast --example robot_path`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec3;
use convex_support::{Ball, Cuboid, Posed, Rounded, Segment, SupportMap};
use gjk_raycast::{
    HalfSpace, Joint, JointBoxOutcome, JointKind, Link, Linkage, LinkageError, MotionCastOptions, Path, PathWorkspace,
    Pose, Scene,
};

type Shape = Box<dyn SupportMap<Vector = DVec3>>;

const NAMES: [&str; 4] = ["base", "upper arm", "forearm", "hand"];

/// A turntable about z, a shoulder and an elbow about y, with links of length 1 and 0.8, and a hand that slides out of
/// the forearm.
fn robot() -> Result<Linkage<Shape>, Box<dyn std::error::Error>> {
    let at = |translation| Pose { translation, ..Pose::default() };
    let bar = |length: f64, radius| -> Result<Shape, Box<dyn std::error::Error>> {
        Ok(Box::new(Rounded::new(Segment::new([DVec3::ZERO, DVec3::X * length])?, radius)?))
    };
    let joints = [
        Joint { parent: None, pose: at(DVec3::Z * 0.5), kind: JointKind::Revolute(DVec3::Z) },
        Joint { parent: Some(0), pose: Pose::default(), kind: JointKind::Revolute(DVec3::Y) },
        Joint { parent: Some(1), pose: at(DVec3::X), kind: JointKind::Revolute(DVec3::Y) },
        Joint { parent: Some(2), pose: at(DVec3::X * 0.5), kind: JointKind::Prismatic(DVec3::X) },
    ];
    let base: Shape = Box::new(Posed::translated(Cuboid::new(DVec3::new(0.2, 0.2, 0.2))?, DVec3::Z * 0.2)?);
    let finger = |y: f64| Posed::translated(Ball::new(0.05)?, DVec3::new(0.4, y, 0.0));
    let hand: Vec<Shape> = vec![bar(0.3, 0.04)?, Box::new(finger(0.08)?), Box::new(finger(-0.08)?)];
    let links = [
        Link { joint: None, bodies: vec![base] },
        Link { joint: Some(1), bodies: vec![bar(1.0, 0.08)?] },
        Link { joint: Some(2), bodies: vec![bar(0.5, 0.06)?] },
        Link { joint: Some(3), bodies: hand },
    ];
    Ok(Linkage::new(joints, links)?)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let robot = robot()?;
    // Neighbours overlap at their joints. The others are asked about the whole of the joints' limits.
    let limits = [[-3.0, 3.0], [-2.0, 0.3], [0.0, 2.9], [0.0, 0.3]];
    let mut pairs = Vec::new();
    for pair in [[2, 0], [3, 0], [3, 1]] {
        let names = pair.map(|link| NAMES[link]);
        match robot.joint_box(pair, &limits, 0.0, 100_000)?.outcome {
            JointBoxOutcome::Never => println!("{} and {} never meet", names[0], names[1]),
            JointBoxOutcome::Meets { values, .. } => {
                println!("{} and {} meet at {values:?}", names[0], names[1]);
                pairs.push(pair);
            }
            JointBoxOutcome::Undecided { share } => {
                println!("{} and {} may meet in {share} of the limits", names[0], names[1]);
                pairs.push(pair);
            }
        }
    }
    assert_eq!(pairs, [[3, 0], [3, 1]], "the hand alone reaches the others");
    let robot = robot.with_pairs(pairs)?;

    // A post, and the floor, a millimetre under the base.
    let post = Posed::translated(Cuboid::new(DVec3::new(0.1, 0.1, 0.6))?, DVec3::new(1.2, 0.0, 0.6))?;
    let mut scene = Scene::new([post])?;
    scene.insert_half_space(HalfSpace::new(DVec3::Z, -0.001)?);

    let options = MotionCastOptions::new().with_target_distance(0.0005);
    let mut workspace = PathWorkspace::new();
    let mut ask =
        |ways: &[[f64; 4]]| -> Result<Path<DVec3>, LinkageError> { robot.path(ways, &scene, options, &mut workspace) };
    let [from, to] = [[-1.0, -0.2, 0.6, 0.2], [1.0, -0.2, 0.6, 0.2]];
    let (contact, hit) = ask(&[from, to])?.contact().ok_or("the post is in the way")?;
    let (edge, link, time, cast) = (contact.edge, NAMES[contact.link], hit.time, contact.cast);
    println!("straight on: the {link} meets {:?} at {time:.12} of edge {edge}", contact.met);
    assert!(cast.is_certain() && cast.upper - cast.lower < 1e-12, "{contact:?}");
    // Up to there it is free, and a little later it is not.
    let until = |time: f64| [from, [0, 1, 2, 3].map(|j| from[j] + time * (to[j] - from[j]))];
    assert!(ask(&until(cast.lower - 1e-9))?.is_free() && !ask(&until(cast.upper + 1e-9))?.is_free(), "{contact:?}");

    let above = |turn: f64| [turn, -1.2, 0.6, 0.0];
    let around = ask(&[from, above(-1.0), above(1.0), to])?;
    println!("around it: {:?}, by {} casts", around.first, around.casts);
    assert!(around.is_free(), "{around:?}");
    Ok(())
}
