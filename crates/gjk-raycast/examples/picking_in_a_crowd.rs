//! What is under the cursor? A picture of a hundred thousand bodies, a ray for each pixel.
//!
//! `cargo run --release -p gjk-raycast --example picking_in_a_crowd`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ball, Cuboid, Cylinder, InvalidShape, Posed, SupportMap};
use gjk_raycast::{Outcome, Ray, RayCastOptions, Scene, Work, ray_cast};

/// What a body can be: an enum of one's own is a shape as well, and lies in the scene by value.
#[derive(Clone, Debug)]
enum Thing {
    Ball(Posed<Ball<DVec3>>),
    Crate(Posed<Cuboid<DVec3>>),
    Barrel(Posed<Cylinder<DVec3>>),
}

impl SupportMap for Thing {
    type Vector = DVec3;

    fn support(&self, direction: DVec3) -> DVec3 {
        match self {
            Self::Ball(shape) => shape.support(direction),
            Self::Crate(shape) => shape.support(direction),
            Self::Barrel(shape) => shape.support(direction),
        }
    }
}

/// A hundred thousand things on the ground, no two in the same place.
fn crowd() -> Result<Vec<Thing>, InvalidShape> {
    (0..100_000_u32)
        .map(|i| {
            let golden = 2.399_963 * f64::from(i);
            let place = DVec3::new(golden.cos(), 0.0, golden.sin()) * f64::from(i).sqrt() * 1.5;
            let turn = DQuat::from_rotation_y(golden);
            Ok(match i % 3 {
                0 => Thing::Ball(Posed::translated(Ball::new(0.5)?, place)?),
                1 => Thing::Crate(Posed::new(Cuboid::new(DVec3::new(0.5, 0.4, 0.6))?, turn, place)?),
                _ => Thing::Barrel(Posed::new(Cylinder::new(0.6, 0.4)?, turn, place)?),
            })
        })
        .collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::new(crowd()?)?;
    let eye = DVec3::new(0.0, 60.0, -500.0);
    let options = RayCastOptions::default();
    let (mut hits, mut all) = (0, Work::default());
    for pixel in 0..20_000_u32 {
        let (x, y) = (f64::from(pixel % 200) / 100.0 - 1.0, f64::from(pixel / 200) / 200.0 - 0.5);
        let ray = Ray { source: eye, direction: DVec3::new(x, y - 0.1, 1.0) };
        let answer = scene.all().ray_cast(ray, options)?;
        hits += u32::from(answer.first.is_some());
        all.nodes += answer.work.nodes;
        all.tested += answer.work.tested;
        // Now and then, every body is asked.
        if pixel % 2_000 == 777 {
            let mut first = None;
            for (index, body) in scene.iter() {
                let Some(thing) = body.convex() else { continue };
                if let Outcome::Hit(hit) = ray_cast(thing, ray, options)?.outcome
                    && first.is_none_or(|(_, lambda)| hit.lambda < lambda)
                {
                    first = Some((index, hit.lambda));
                }
            }
            assert_eq!(answer.first.map(|first| (first.body, first.hit.lambda)), first, "to the last bit");
        }
    }
    println!("20000 rays among {} bodies, {hits} of which hit one", scene.len());
    println!(
        "for each ray {:.1} nodes and {:.2} casts",
        f64::from(u32::try_from(all.nodes)?) / 2e4,
        f64::from(u32::try_from(all.tested)?) / 2e4
    );
    assert!(hits > 5_000 && all.tested < 60_000, "{hits} hits by {} casts", all.tested);
    Ok(())
}
