//! How to add a shape of your own. It needs one function: the point farthest along a direction.
//!
//! `cargo run -p gjk-raycast --example a_shape_of_your_own`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ball, Posed, SupportMap, bounding_box};
use gjk_raycast::{DistanceOptions, Ray, RayCastOptions, distance, ray_cast};

/// A cushion: x⁴/a⁴ + y⁴/b⁴ + z⁴/c⁴ ≤ 1, about the origin.
struct Cushion {
    semi_axes: DVec3,
}

impl SupportMap for Cushion {
    type Vector = DVec3;

    /// With u = (a·dx, b·dy, c·dz) this is the unit ball of the 4-norm along u. Where x maximises u·x on Σxᵢ⁴ = 1,
    /// u is parallel to the gradient (xᵢ³), so x is parallel to (∛uᵢ).
    fn support(&self, direction: DVec3) -> DVec3 {
        let u = self.semi_axes * direction;
        // To length one first, so that no power of it leaves the range of floating point. Any point will do for zero.
        let u = (u / u.abs().max_element().max(f64::MIN_POSITIVE)).map(f64::cbrt);
        let norm = u.map(|x| x.powi(4)).element_sum().powf(0.25);
        if norm > 0.0 { self.semi_axes * u / norm } else { DVec3::X * self.semi_axes }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cushion = Cushion { semi_axes: DVec3::new(0.4, 0.1, 0.3) };

    // Everything works on it: bounds, poses, casts, distances.
    println!("it reaches from {} to {}", bounding_box(&cushion).min, bounding_box(&cushion).max);
    let thrown = Posed::new(&cushion, DQuat::from_rotation_z(0.7), DVec3::new(0.0, 2.0, 0.0))?;

    let ray = Ray { source: DVec3::new(0.1, 5.0, 0.1), direction: DVec3::NEG_Y };
    let hit = ray_cast(&thrown, ray, RayCastOptions::default())?.outcome.hit().ok_or("it is below")?;
    println!("seen from above at {:.6}, where its normal is {:.4}", hit.point, hit.normal.unwrap_or_default());
    let at = DQuat::from_rotation_z(-0.7) * (hit.point - DVec3::new(0.0, 2.0, 0.0)) / cushion.semi_axes;
    assert!((at.map(|x| x.powi(4)).element_sum() - 1.0).abs() < 1e-9, "the point is not on the cushion's surface");

    let head = Posed::translated(Ball::new(0.1)?, DVec3::new(0.3, 3.0, 0.0))?;
    let gap = distance(&head, &thrown, DistanceOptions::default());
    println!("{:.9} m from a head, certainly between {:.9} and {:.9}", gap.distance, gap.lower, gap.upper);
    assert!(gap.upper - gap.lower < 1e-9 && !gap.overlap, "the bounds are {} apart", gap.upper - gap.lower);
    Ok(())
}
