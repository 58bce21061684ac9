//! A robot whose links are compounds moves among ten thousand obstacles. What does it come near, and may it?
//!
//! `cargo run --release -p gjk-raycast --example robot_among_obstacles`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Capsule, Cuboid, InvalidShape, Posed, SupportMap};
use gjk_raycast::{DistanceOptions, HalfSpace, Scene, distance};

type Piece = Box<dyn SupportMap<Vector = DVec3>>;
type Pieces = Vec<(usize, Piece)>;

const LINKS: usize = 5;
/// The obstacle that the gripper holds.
const HELD: usize = 17;

/// The pieces of all links, each with the number of its link: a bar with a housing at its joint.
fn robot(time: f64) -> Result<Pieces, InvalidShape> {
    let mut pieces = Pieces::new();
    let (mut joint, mut turn) = (DVec3::new(0.0, 0.5, 0.0), DQuat::IDENTITY);
    for link in 0..LINKS {
        let bend = 0.6 * (time + link as f64).sin();
        turn *= DQuat::from_rotation_y(0.4 * time) * DQuat::from_rotation_z(bend);
        let middle = joint + turn * DVec3::Y;
        pieces.push((link, Box::new(Posed::new(Cuboid::new(DVec3::new(0.25, 0.2, 0.25))?, turn, joint)?)));
        pieces.push((link, Box::new(Posed::new(Capsule::new(0.8, 0.15)?, turn, middle)?)));
        joint += turn * DVec3::Y * 2.0;
    }
    Ok(pieces)
}

/// Ten thousand posts and boxes around the robot.
fn obstacles() -> Result<Vec<Piece>, InvalidShape> {
    (0..10_000_u32)
        .map(|i| {
            let golden = 2.399_963 * f64::from(i);
            let place = DVec3::new(golden.cos(), 0.0, golden.sin()) * (2.0 + 0.1 * f64::from(i).sqrt());
            let height = DVec3::Y * (0.4 * f64::from(i % 23) + 0.5);
            Ok(Box::new(Posed::translated(Cuboid::new(DVec3::new(0.1, 0.3, 0.1))?, place + height)?) as Piece)
        })
        .collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut world = Scene::new(obstacles()?)?;
    let floor = world.insert_half_space(HalfSpace::new(DVec3::Y, 0.0)?);
    let options = DistanceOptions::default();
    let (mut near, mut own) = (Vec::new(), Vec::new());
    let (mut warnings, mut folded, mut tested) = (0, 0, 0);
    for step in 0..100_u32 {
        let time = f64::from(step) * 0.05;
        let (link, pieces): (Vec<usize>, Vec<Piece>) = robot(time)?.into_iter().unzip();
        let robot = Scene::new(pieces)?;
        // The base stands on the floor, and the gripper holds something.
        let allowed = |piece: usize, obstacle: usize| {
            (link[piece] == 0 && obstacle == floor) || (link[piece] == LINKS - 1 && obstacle == HELD)
        };
        let work = robot.all().without_pairs(&allowed).pairs_between(&world, 0.3, options, &mut near);
        tested += work.tested;
        warnings += near.len();
        // Links next to each other touch at their joint.
        let neighbours = |i: usize, j: usize| link[i].abs_diff(link[j]) <= 1;
        tested += robot.all().without_pairs(&neighbours).pairs_within(0.1, options, &mut own).tested;
        folded += own.len();
        if step % 25 == 0 {
            let mut due = Vec::new();
            for (i, piece) in robot.iter().filter_map(|(i, body)| Some((i, body.convex()?))) {
                for (j, obstacle) in world.iter() {
                    let distance = match obstacle.convex() {
                        Some(obstacle) => distance(piece, obstacle, options).distance,
                        None => HalfSpace::new(DVec3::Y, 0.0)?.distance_from(piece).distance,
                    };
                    if !allowed(i, j) && distance <= 0.3 {
                        due.push((i, j, distance));
                    }
                }
            }
            assert_eq!(
                near.iter().map(|p| (p.a, p.b, p.distance.distance)).collect::<Vec<_>>(),
                due,
                "to the last bit"
            );
        }
    }
    let pairs = 100 * (2 * LINKS) * world.len();
    println!(
        "{pairs} pairs of a piece and an obstacle, {tested} of which were asked: {warnings} near, {folded} of its own"
    );
    assert!(warnings > 100 && tested < pairs / 500, "{warnings} near of {tested} asked");
    Ok(())
}
