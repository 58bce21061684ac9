//! A lidar sweeps a scene: many rays, many shapes. What can be left out?
//!
//! `cargo run --release -p gjk-raycast --example many_rays`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Aabb, Ball, Cylinder, Ellipsoid, InvalidShape, Posed, SupportMap, bounding_box};
use gjk_raycast::{Outcome, Ray, RayCastOptions, ray_cast};

type Shape = Box<dyn SupportMap<Vector = DVec3>>;

/// Forty things on a ring around the lidar, each with the box that it is in.
fn scene() -> Result<Vec<(Shape, Aabb<DVec3>)>, InvalidShape> {
    let shape = |i: u32| -> Result<Shape, InvalidShape> {
        let at = DQuat::from_rotation_y(f64::from(i) * 0.157) * DVec3::new(6.0 + f64::from(i % 5), 0.0, 0.0);
        Ok(match i % 3 {
            0 => Box::new(Posed::translated(Ball::new(0.5)?, at)?),
            1 => Box::new(Posed::new(Cylinder::new(1.0, 0.3)?, DQuat::from_rotation_z(0.2), at)?),
            _ => Box::new(Ellipsoid::new(at, DVec3::new(0.8, 1.2, 0.2), DQuat::from_rotation_y(f64::from(i)))?),
        })
    };
    (0..40)
        .map(|i| shape(i).map(|shape| (bounding_box(&shape), shape)).map(|(bounds, shape)| (shape, bounds)))
        .collect()
}

/// Whether a ray meets a box before `end`: between the last of the planes where it enters, and the first where it
/// leaves.
fn may_hit(bounds: &Aabb<DVec3>, ray: &Ray<DVec3>, end: f64) -> bool {
    let (a, b) = ((bounds.min - ray.source) / ray.direction, (bounds.max - ray.source) / ray.direction);
    a.min(b).max_element().max(0.0) <= a.max(b).min_element().min(end)
}

/// How the sweep is made, and what it cost.
#[derive(Default)]
struct Sweep {
    boxes: bool,
    nearest: bool,
    warm: bool,
    casts: usize,
    support_points: usize,
}

impl Sweep {
    /// The range of each ray.
    fn run(&mut self, scene: &[(Shape, Aabb<DVec3>)]) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
        let mut told = vec![None; scene.len()];
        let mut ranges = Vec::new();
        for ring in -8..=8 {
            for spoke in 0..900 {
                let turn = DQuat::from_rotation_y(f64::from(spoke) * std::f64::consts::TAU / 900.0);
                let ray = Ray {
                    source: DVec3::ZERO,
                    direction: turn * DVec3::new(1.0, f64::from(ring) * 0.01 + 0.003, 1e-3),
                };
                let mut range = f64::INFINITY;
                for ((shape, bounds), told) in scene.iter().zip(&mut told) {
                    if self.boxes && !may_hit(bounds, &ray, range) {
                        continue;
                    }
                    let mut options = RayCastOptions::new().with_warm_start(*told);
                    if self.nearest {
                        options = options.with_max_lambda(range);
                    }
                    let cast = ray_cast(shape, ray, options)?;
                    self.casts += 1;
                    self.support_points += cast.iterations;
                    if self.warm {
                        *told = cast.warm_start(*told);
                    }
                    match cast.outcome {
                        Outcome::Hit(hit) => range = range.min(hit.lambda),
                        Outcome::Miss(_) => {}
                        Outcome::Undecided => return Err("no ray here is too close to call".into()),
                    }
                }
                ranges.push(range);
            }
        }
        Ok(ranges)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = scene()?;
    let mut sweeps = [
        ("everything", Sweep::default()),
        ("what the last ray told", Sweep { warm: true, ..Sweep::default() }),
        ("and rays ended at the nearest hit", Sweep { warm: true, nearest: true, ..Sweep::default() }),
        ("and boxes before shapes", Sweep { warm: true, nearest: true, boxes: true, ..Sweep::default() }),
    ];
    let truth = Sweep::default().run(&scene)?;
    println!(
        "{} rays, {} of which hit one of {} shapes",
        truth.len(),
        truth.iter().filter(|r| r.is_finite()).count(),
        scene.len()
    );
    println!("{:36} {:>8} {:>15}", "", "casts", "support points");
    for (name, sweep) in &mut sweeps {
        let ranges = sweep.run(&scene)?;
        println!("{name:36} {:8} {:15}", sweep.casts, sweep.support_points);
        // Leaving out what cannot matter changes no answer, beyond the rounding of another way to it.
        for (range, truth) in ranges.iter().zip(&truth) {
            assert!(range == truth || (range - truth).abs() < 1e-9 * truth, "{range} instead of {truth}");
        }
    }
    Ok(())
}
