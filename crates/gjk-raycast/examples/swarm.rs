//! Ten thousand balls fly about. Which are near each other, frame by frame?
//!
//! `cargo run --release -p gjk-raycast --example swarm`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec3;
use convex_support::{Ball, Posed};
use gjk_raycast::{DistanceOptions, Scene};

const BALLS: usize = 10_000;
const RADIUS: f64 = 0.1;
const NEAR: f64 = 0.05;

/// Where a ball is: on a loop of its own.
fn place(ball: usize, time: f64) -> DVec3 {
    let number = |salt: f64| (ball as f64 * salt).fract();
    let (phase, center) =
        (time + 6.3 * number(0.618_034), DVec3::new(number(0.754_878), number(0.569_840), number(0.324_718)));
    (center * 10.0 - DVec3::splat(5.0)) + DVec3::new(phase.sin(), phase.cos(), (1.3 * phase).sin())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ball = Ball::new(RADIUS)?;
    let at = |index, time| Posed::translated(ball, place(index, time));
    let mut scene = Scene::new((0..BALLS).map(|i| at(i, 0.0)).collect::<Result<Vec<_>, _>>()?)?;
    let mut pairs = Vec::new();
    let (mut near, mut tested) = (0, 0);
    for frame in 0..60_u32 {
        let time = f64::from(frame) / 60.0;
        scene.update(|index, before| at(index, time).unwrap_or(*before))?;
        let work = scene.all().pairs_within(NEAR, DistanceOptions::default(), &mut pairs);
        near += pairs.len();
        tested += work.tested;
        if frame == 59 {
            // Balls are near where their centres are.
            let centers: Vec<_> = (0..BALLS).map(|i| place(i, time)).collect();
            let mut counted = 0;
            for (i, p) in centers.iter().enumerate() {
                counted += centers[..i].iter().filter(|q| p.distance(**q) <= 2.0 * RADIUS + NEAR).count();
            }
            assert_eq!(pairs.len(), counted, "as by looking at all pairs");
        }
    }
    println!("{near} pairs in 60 frames, by {tested} distances; all pairs are {}", 60 * BALLS * (BALLS - 1) / 2);
    // A box is 6/π times as large as its ball, so that many pairs of boxes touch whose balls do not.
    assert!(near > 10_000 && tested < 3 * near, "{near} near of {tested} asked");
    Ok(())
}
