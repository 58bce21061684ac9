//! A lidar on a robot's roof sweeps a hundred thousand rays through a yard of ten thousand bodies.
//!
//! `cargo run --release -p gjk-raycast --features simd --example lidar` tells what it took; with a file name after `--`
//! it writes the ranges as a picture, a grey map in PGM.
//!
//! All rays are cast at the robot's own shapes, many at a time, to sort out those that hit the robot itself; and into
//! the scene, where each eight neighbours share a search of the tree.

#![allow(clippy::print_stdout, reason = "an example talks")]

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ball, Capsule, Cuboid, Posed, SupportMap};
use gjk_raycast::{Ray, RayCastOptions, RayEntry, Scene, SceneCast, ray_cast, ray_entries_into};

type Shape = Box<dyn SupportMap<Vector = DVec3> + Sync>;

/// Ten thousand things on the ground, around a free place where the robot stands.
fn yard() -> Result<Vec<Shape>, Box<dyn std::error::Error>> {
    (0..10_000_u32)
        .map(|i| {
            let golden = 2.399_963 * f64::from(i);
            let place = DVec3::new(golden.cos(), 0.0, golden.sin()) * (f64::from(i) + 20.0).sqrt() * 1.2;
            let turn = DQuat::from_rotation_y(golden);
            Ok(match i % 3 {
                0 => Box::new(Posed::translated(Ball::new(0.4)?, place + DVec3::Y * 0.4)?) as Shape,
                1 => Box::new(Posed::new(Cuboid::new(DVec3::new(0.4, 1.2, 0.5))?, turn, place + DVec3::Y * 1.2)?),
                _ => Box::new(Posed::translated(Capsule::new(0.8, 0.15)?, place + DVec3::Y * 0.95)?),
            })
        })
        .collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Without optimisation, fewer do.
    let spokes = if cfg!(debug_assertions) { 128 } else { 1562 };
    let rings = 64;
    let sensor = DVec3::new(0.0, 1.6, 0.0);
    let options = RayCastOptions::new().with_max_lambda(120.0);
    let rays: Vec<_> = (0..rings * spokes)
        .map(|k| {
            let (ring, spoke) = (f64::from(k / spokes), f64::from(k % spokes));
            let (turn, rise) = (spoke * TAU / f64::from(spokes), 0.05 - ring * 0.007);
            Ray { source: sensor, direction: DVec3::new(turn.cos(), rise, turn.sin()).normalize() }
        })
        .collect();

    // The deck, and a mast behind the sensor.
    let deck = Posed::translated(Cuboid::new(DVec3::new(0.9, 0.3, 0.6))?, DVec3::new(0.0, 1.1, 0.0))?;
    let mast = Posed::translated(Capsule::new(0.5, 0.05)?, DVec3::new(-0.6, 1.7, 0.0))?;
    let mut own = [vec![RayEntry::default(); rays.len()], vec![RayEntry::default(); rays.len()]];
    let mut own_time = Duration::ZERO;
    // The second sweep is timed: in the first one, the memory of the answers is used for the first time.
    for _ in 0..2 {
        let begin = Instant::now();
        ray_entries_into(&deck, &rays, options, &mut own[0])?;
        ray_entries_into(&mast, &rays, options, &mut own[1])?;
        own_time = begin.elapsed();
    }

    let scene = Scene::new(yard()?)?;
    let mut of_scene = vec![SceneCast::default(); rays.len()];
    let mut yard_time = Duration::ZERO;
    for _ in 0..2 {
        let begin = Instant::now();
        scene.all().ray_casts_into(&rays, options, &mut of_scene)?;
        yard_time = begin.elapsed();
    }

    let mut ranges = Vec::with_capacity(rays.len());
    let (mut of_robot, mut of_yard) = (0, 0);
    for (k, &ray) in rays.iter().enumerate() {
        let on_robot = own[0][k].lambda.min(own[1][k].lambda);
        let in_yard = of_scene[k].first.map_or(f64::INFINITY, |first| first.hit.lambda);
        of_robot += u32::from(on_robot <= in_yard && on_robot < f64::INFINITY);
        of_yard += u32::from(in_yard < on_robot);
        ranges.push(if in_yard < on_robot || on_robot == f64::INFINITY { in_yard } else { 0.0 });
        // Now and then each of the robot's shapes is asked alone, and so is the yard.
        if k % 997 == 0 {
            for (shape, entry) in
                [&deck as &dyn SupportMap<Vector = DVec3>, &mast].into_iter().zip([own[0][k], own[1][k]])
            {
                assert_eq!(entry, RayEntry::from(ray_cast(shape, ray, options)?), "to the last bit");
            }
            assert_eq!(of_scene[k].first, scene.ray_cast(ray, options)?.first, "to the last bit");
        }
    }
    println!("{} rays: {of_robot} hit the robot, {of_yard} one of {} bodies", rays.len(), scene.len());
    let each = |time: Duration| time.as_nanos() as f64 / rays.len() as f64;
    println!("{:.0} ns a ray for the robot, {:.0} ns for the yard", each(own_time), each(yard_time));
    assert!(of_robot * 20 > rings * spokes && of_yard * 3 > rings * spokes, "{of_robot} and {of_yard}");

    if let Some(file) = std::env::args_os().nth(1) {
        let grey = |range: f64| if range < 120.0 { (255.0 / (1.0 + 0.1 * range)) as u8 } else { 0 };
        let mut picture = format!("P5\n{spokes} {rings}\n255\n").into_bytes();
        picture.extend(ranges.iter().map(|&range| grey(range)));
        std::fs::write(file, picture)?;
    }
    Ok(())
}
