//! Which of the shapes in a scene is under the mouse? The nearest hit so far ends every further ray.

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec3;
use convex_support::{Ball, Cone, Cuboid, InvalidShape, Posed, SupportMap};
use gjk_raycast::{Ray, RayCastOptions, ray_cast};

type Shape = Box<dyn SupportMap<Vector = DVec3>>;

fn scene() -> Result<Vec<(&'static str, Shape)>, InvalidShape> {
    Ok(vec![
        ("crate", Box::new(Posed::translated(Cuboid::new(DVec3::splat(0.5))?, DVec3::new(0.0, 0.5, 0.0))?)),
        ("ball", Box::new(Posed::translated(Ball::new(0.4)?, DVec3::new(0.2, 0.6, 2.0))?)),
        ("tree", Box::new(Posed::translated(Cone::new(1.0, 0.6)?, DVec3::new(1.5, 1.0, -1.0))?)),
    ])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mouse = Ray { source: DVec3::new(0.0, 1.0, 8.0), direction: DVec3::new(0.0, -0.05, -1.0) };
    let mut nearest = None;
    let mut options = RayCastOptions::new();
    for (name, shape) in scene()? {
        if let Some(hit) = ray_cast(&shape, mouse, options)?.outcome.hit() {
            options = options.with_max_lambda(hit.lambda);
            nearest = Some((name, hit.point));
        }
    }
    match nearest {
        Some((name, point)) => println!("the {name}, at {point}"),
        None => println!("nothing"),
    }
    Ok(())
}
