//! How deep is one polyhedron in another, and what proves that no way out is shorter?
//!
//! `cargo run --release -p gjk-raycast --example depth_of_hulls`

#![allow(clippy::print_stdout, reason = "examples print what they find")]

use gjk_raycast::convex_support::glam::{DQuat, DVec3};
use gjk_raycast::convex_support::{InvalidShape, Polytope, Posed};
use gjk_raycast::{SignedDistanceOptions, signed_distance};

/// Points on a sphere, evenly spread along a spiral.
fn ball_of_points(count: u32, radius: f64) -> Result<Polytope<DVec3>, InvalidShape> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    Polytope::new((0..count).map(|i| {
        let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
        let (sine, cosine) = (golden * f64::from(i)).sin_cos();
        DVec3::new(cosine, 0.0, sine) * ((1.0 - y * y).sqrt() * radius) + DVec3::Y * (y * radius)
    }))
}

fn main() -> Result<(), InvalidShape> {
    let stone = ball_of_points(64, 1.0)?;
    let turn = DQuat::from_rotation_x(0.7);
    for offset in [1.9, 1.5, 1.0, 0.3] {
        let other = Posed::new(&stone, turn, DVec3::new(offset, 0.1, 0.0))?;
        let answer = signed_distance(&stone, &other, SignedDistanceOptions::default());
        println!(
            "offset {offset}: {:.12} between {:.3e} below and {:.3e} above, {} support points, {} facets left alone",
            answer.signed_distance,
            answer.signed_distance - answer.lower,
            answer.upper - answer.signed_distance,
            answer.iterations,
            answer.unexpanded
        );
        assert!(answer.overlap && answer.upper - answer.lower < 1e-13, "{answer:?}");
        // Moved out by the depth along the normal, it touches.
        let out = Posed::translated(&stone, answer.normal * -answer.signed_distance)?;
        let touching = signed_distance(&out, &other, SignedDistanceOptions::default());
        assert!(touching.signed_distance.abs() < 1e-14, "{touching:?}");
    }
    Ok(())
}
