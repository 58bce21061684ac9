//! parry's answers to seeded questions, a line each, every field of them: what `.ci/bits` compares between targets,
//! beside ours.
//!
//! 10,000 distances, contacts, ray casts, linear casts and turning casts of balls, boxes, capsules, cylinders, cones
//! and hulls of twelve points, in single precision. Poses are drawn with `+ − × ÷ √` only.
#![allow(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is the purpose")]

use std::io::{self, BufWriter, Write};

use parry3d::math::{Pose, Rotation, Vector};
use parry3d::query::{self, NonlinearRigidMotion, Ray, ShapeCastOptions};
use parry3d::shape::{Ball, Capsule, Cone, ConvexPolyhedron, Cuboid, Cylinder, Shape};
use workloads::rng::Rng;

fn vector(rng: &mut Rng, most: f64) -> Vector {
    Vector::from_array(rng.cube().map(|x| (most * x) as f32))
}

fn pose(rng: &mut Rng) -> Pose {
    let turn = rng.quat().map(|x| x as f32);
    Pose::from_parts(vector(rng, 2.0), Rotation::from_array(turn))
}

fn shape(rng: &mut Rng) -> Box<dyn Shape> {
    let mut size = || (0.1 + rng.unit()) as f32;
    let [x, y, z] = [size(), size(), size()];
    match rng.below(6) {
        0 => Box::new(Ball::new(x)),
        1 => Box::new(Cuboid::new(Vector::new(x, y, z))),
        2 => Box::new(Capsule::new_y(x, y)),
        3 => Box::new(Cylinder::new(x, y)),
        4 => Box::new(Cone::new(x, y)),
        _ => {
            let points: Vec<_> = (0..12).map(|_| vector(rng, 1.0)).collect();
            match ConvexPolyhedron::from_convex_hull(&points) {
                Some(hull) => Box::new(hull),
                None => Box::new(Ball::new(x)),
            }
        }
    }
}

fn main() -> io::Result<()> {
    let mut output = BufWriter::new(io::stdout().lock());
    for i in 0..10_000_u64 {
        let rng = &mut Rng::new(i);
        let (a, b) = (shape(rng), shape(rng));
        let (at_a, at_b) = (pose(rng), pose(rng));
        let (velocity_a, velocity_b) = (vector(rng, 2.0), vector(rng, 2.0));
        let (turn_a, turn_b) = (vector(rng, 3.0), vector(rng, 3.0));

        writeln!(output, "distance {i}: {:?}", query::distance(&at_a, &*a, &at_b, &*b))?;
        writeln!(output, "contact {i}: {:?}", query::contact(&at_a, &*a, &at_b, &*b, 0.5))?;
        let ray = Ray::new(at_b.translation + velocity_b, at_a.translation - at_b.translation);
        writeln!(output, "ray_cast {i}: {:?}", a.cast_ray_and_get_normal(&at_a, &ray, 10.0, true))?;
        let options = ShapeCastOptions::with_max_time_of_impact(4.0);
        let cast = query::cast_shapes(&at_a, velocity_a, &*a, &at_b, velocity_b, &*b, options);
        writeln!(output, "linear_cast {i}: {cast:?}")?;
        let motion = |at, velocity, turn| NonlinearRigidMotion::new(at, Vector::ZERO, velocity, turn);
        let (motion_a, motion_b) = (motion(at_a, velocity_a, turn_a), motion(at_b, velocity_b, turn_b));
        let cast = query::cast_shapes_nonlinear(&motion_a, &*a, &motion_b, &*b, 0.0, 2.0, true);
        writeln!(output, "motion_cast {i}: {cast:?}")?;
    }
    output.flush()
}
