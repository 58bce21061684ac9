//! Ten boxes stand on one another for a thousand steps, in single and in double precision.
//!
//! `cargo run --release -p gjk-raycast --example stack_of_boxes`

#![allow(clippy::print_stdout, reason = "examples print what they find")]

mod world;

use gjk_raycast::convex_support::glam::{DVec3, Vec3};
use gjk_raycast::convex_support::{Matrix, Scalar, Vector, Vector3};
use world::{Body, World};

const BOXES: usize = 10;
const STEPS: usize = 1000;

fn vector<V: Vector>(coordinates: [f64; 3]) -> V {
    V::from_fn(|i| V::Scalar::from_f64(coordinates[i]))
}

/// How far the boxes are from where they were put, at most, after all steps.
fn farthest<V: Vector3>() -> Result<f64, Box<dyn std::error::Error>> {
    let mut bodies = vec![Body::fixed(vector::<V>([10.0, 1.0, 10.0]), vector([0.0, -1.0, 0.0]), Matrix::IDENTITY)?];
    let place = |i: usize| vector::<V>([0.0, 0.5 + i as f64, 0.0]);
    for i in 0..BOXES {
        bodies.push(Body::cuboid(vector([0.5, 0.5, 0.5]), place(i), Matrix::IDENTITY)?);
    }
    let mut world = World::new(bodies, vector([0.0, -9.81, 0.0]), 0.5);
    for _ in 0..STEPS {
        world.step(V::Scalar::from_f64(1.0 / 60.0))?;
    }
    let moved = world.bodies[1..].iter().enumerate().map(|(i, body)| (body.center - place(i)).norm().as_f64());
    Ok(moved.fold(0.0, f64::max))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (precision, moved) in [("f32", farthest::<Vec3>()?), ("f64", farthest::<DVec3>()?)] {
        println!("{precision}: after {STEPS} steps no box is farther than {moved:.4} m from its place");
        // Each may rest up to a millimetre deep in the one below.
        assert!(moved < 0.02, "the stack moved by {moved}");
    }
    Ok(())
}
