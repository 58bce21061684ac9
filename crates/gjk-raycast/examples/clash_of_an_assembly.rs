//! Which parts of an assembly clash, which are nearer to each other than the clearance, and how sure is that?
//!
//! `cargo run -p gjk-raycast --example clash_of_an_assembly`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Cuboid, Cylinder, InvalidShape, Posed, SupportMap};
use gjk_raycast::{Body, DistanceOptions, Scene, SignedDistanceOptions};

type Part = Box<dyn SupportMap<Vector = DVec3>>;

/// Of the clearance check, in millimetres like all lengths here.
const CLEARANCE: f64 = 0.5;

/// A shaft through two cheeks, with a washer, and a key that is too wide for its place.
fn assembly() -> Result<Vec<(&'static str, Part)>, InvalidShape> {
    // Cylinders stand along y: a quarter turn lays them along x.
    let along_x = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let round = |half: f64, radius: f64, x: f64| Posed::new(Cylinder::new(half, radius)?, along_x, DVec3::X * x);
    let cheek = Cuboid::new(DVec3::new(4.0, 30.0, 20.0))?;
    let key = Cuboid::new(DVec3::new(10.0, 2.0, 2.0))?;
    Ok(vec![
        ("shaft", Box::new(round(40.0, 8.0, 0.0)?)),
        ("left cheek", Box::new(Posed::translated(cheek, DVec3::new(-44.25, 0.0, 0.0))?)),
        ("right cheek", Box::new(Posed::translated(cheek, DVec3::new(46.0, 0.0, 0.0))?)),
        ("washer", Box::new(round(0.6, 12.0, 40.9)?)),
        ("key", Box::new(Posed::translated(key, DVec3::new(0.0, 9.8, 0.0))?)),
    ])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (names, parts): (Vec<&str>, Vec<Part>) = assembly()?.into_iter().unzip();
    let scene = Scene::new(parts)?;
    let mut near = Vec::new();
    scene.all().pairs_within(CLEARANCE, DistanceOptions::default(), &mut near);

    let mut found = Vec::new();
    for pair in &near {
        let part = |body: usize| scene.get(body).and_then(Body::convex).ok_or("it is in the scene");
        // Negative where they clash: minus the least translation that parts them.
        let gap = gjk_raycast::signed_distance(part(pair.a)?, part(pair.b)?, SignedDistanceOptions::default());
        let kind = if gap.upper < 0.0 {
            "clash"
        } else if gap.lower > 0.0 && gap.upper < CLEARANCE {
            "too near"
        } else {
            "within rounding of a limit"
        };
        println!(
            "{} and {}: {kind}, {:.6} mm, certainly from {:.17} to {:.17}",
            names[pair.a], names[pair.b], gap.signed_distance, gap.lower, gap.upper
        );
        found.push((names[pair.a], names[pair.b], kind, (gap.signed_distance * 1e6).round() / 1e6));
    }
    // The shaft ends 0.25 from the left cheek and 0.3 from the washer. The key is sunk by 0.2.
    found.sort_by(|x, y| x.3.total_cmp(&y.3));
    assert_eq!(
        found,
        [
            ("shaft", "key", "clash", -0.2),
            ("shaft", "left cheek", "too near", 0.25),
            ("shaft", "washer", "too near", 0.3)
        ],
        "one pair overlaps, and one is too near"
    );
    Ok(())
}
