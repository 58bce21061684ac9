//! What does a query do, step by step? An observer sees every iterate, and the bracket close: of a distance, and of a
//! ray cast by GJK. By default, an ellipsoid is cast in closed form, of which there is nothing to see.
//!
//! `cargo run -p gjk-raycast --example watching_it_converge`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Cylinder, Ellipsoid, Posed};
use gjk_raycast::{CastMethod, DistanceOptions, Ray, RayCastOptions, Status, distance_with, ray_cast_with};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pillar = Posed::new(Cylinder::new(2.0, 0.5)?, DQuat::from_rotation_x(0.3), DVec3::new(2.0, 0.0, 0.0))?;
    let stone = Ellipsoid::new(DVec3::ZERO, DVec3::new(0.9, 0.4, 0.5), DQuat::from_rotation_y(0.4))?;

    println!("distance    vertices             at least              at most");
    let mut gaps = Vec::new();
    let answer = distance_with(&pillar, &stone, DistanceOptions::default(), |iterate| {
        println!(
            "{:8}    {:8} {:20.16} {:20.16}",
            iterate.iteration,
            iterate.simplex.len(),
            iterate.lower,
            iterate.upper
        );
        gaps.push(iterate.gap());
    });
    println!("{:?}: {}\n", answer.status, answer.distance);
    assert!(gaps.is_sorted_by(|a, b| a >= b), "the bracket only ever narrows");
    assert_eq!(answer.status, Status::Converged, "the bracket is at rounding");

    println!("ray cast    vertices             at least              at most");
    let ray = Ray { source: DVec3::new(-3.0, 0.1, 0.1), direction: DVec3::X };
    let options = RayCastOptions::new().with_method(CastMethod::Gjk);
    let answer = ray_cast_with(&stone, ray, options, |iterate| {
        println!(
            "{:8}    {:8} {:20.16} {:20.16}",
            iterate.iteration,
            iterate.simplex.len(),
            iterate.lower,
            iterate.upper
        );
    })?;
    let hit = answer.outcome.hit().ok_or("the stone is in the way")?;
    println!("{:?}: λ = {}", answer.status, hit.lambda);
    assert!(answer.lower <= hit.lambda && hit.lambda <= answer.upper, "λ is within its bounds");
    Ok(())
}
