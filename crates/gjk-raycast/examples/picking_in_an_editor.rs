//! Which of a few things is under the mouse? The nearest hit so far ends every further ray. For more than some dozens
//! of bodies, a `Scene` does this faster: see `picking_in_a_crowd`.
//!
//! `cargo run -p gjk-raycast --example picking_in_an_editor`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{Vec3, Vec3A};
use convex_support::{Ball, Cone, Cuboid, InvalidShape, Posed, SupportMap};
use gjk_raycast::{Ray, RayCastError, RayCastOptions, ray_cast};

/// Single precision, in glam's vector of four lanes: what a renderer has at hand. Shapes of any kind fit in one list.
type Shape = Box<dyn SupportMap<Vector = Vec3A>>;

fn scene() -> Result<Vec<(&'static str, Shape)>, InvalidShape> {
    Ok(vec![
        ("crate", Box::new(Posed::translated(Cuboid::new(Vec3A::splat(0.5))?, Vec3A::new(0.0, 0.5, 0.0))?)),
        ("ball", Box::new(Posed::translated(Ball::new(0.4)?, Vec3A::new(0.2, 0.6, 2.0))?)),
        ("tree", Box::new(Posed::translated(Cone::new(1.0, 0.6)?, Vec3A::new(1.5, 1.0, -1.0))?)),
    ])
}

/// The name of what a ray sees first, and where.
fn pick(scene: &[(&'static str, Shape)], ray: Ray<Vec3A>) -> Result<Option<(&'static str, Vec3A)>, RayCastError> {
    let mut nearest = None;
    let mut options = RayCastOptions::new();
    for (name, shape) in scene {
        if let Some(hit) = ray_cast(shape, ray, options)?.outcome.hit() {
            options = options.with_max_lambda(hit.lambda);
            nearest = Some((*name, hit.point));
        }
    }
    Ok(nearest)
}

/// The ray through a pixel of a camera that looks along −z, with a field of view of 60° from top to bottom.
fn through(pixel: (u32, u32), window: (u32, u32)) -> Ray<Vec3A> {
    let half = 30f32.to_radians().tan();
    let height = window.1 as f32;
    let at = |p: u32, size: u32| (2 * p + 1) as f32 - size as f32;
    let direction = Vec3::new(at(pixel.0, window.0) / height * half, -at(pixel.1, window.1) / height * half, -1.0);
    Ray { source: Vec3A::new(0.0, 1.0, 8.0), direction: direction.into() }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (scene, window) = (scene()?, (800, 600));
    for (pixel, due) in
        [((415, 330), Some("ball")), ((370, 330), Some("crate")), ((490, 300), Some("tree")), ((60, 60), None)]
    {
        let seen = pick(&scene, through(pixel, window))?;
        match seen {
            Some((name, point)) => println!("pixel {pixel:?}: the {name}, at {point:.3}"),
            None => println!("pixel {pixel:?}: nothing"),
        }
        assert_eq!(seen.map(|(name, _)| name), due, "at pixel {pixel:?}");
    }
    Ok(())
}
