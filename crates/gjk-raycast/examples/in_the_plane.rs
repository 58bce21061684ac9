//! The queries in 2D: how far is a robot's footprint from the walls of a room, and how far may it drive straight on?
//!
//! `cargo run -p gjk-raycast --example in_the_plane`

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec2;
use convex_support::{Polytope, Posed, Rounded, Segment};
use gjk_raycast::{DistanceOptions, LinearCastOptions, Motion, distance, linear_cast};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A wedge with a safety distance of 0.1 around it; vertices in any order, interior points do no harm.
    let wedge = Polytope::new([DVec2::new(0.6, 0.0), DVec2::new(-0.4, 0.3), DVec2::new(-0.4, -0.3)])?;
    let footprint = Posed::new(Rounded::new(wedge, 0.1)?, 0.5, DVec2::new(1.0, 1.0))?;
    let corners = [DVec2::ZERO, DVec2::new(6.0, 0.0), DVec2::new(6.0, 4.0), DVec2::new(0.0, 4.0)];

    // Where it looks, at one metre a second. The nearest wall so far ends the search for the others.
    let ahead = Motion { velocity_a: DVec2::from_angle(0.5), velocity_b: DVec2::ZERO };
    let (mut drive, mut first) = (LinearCastOptions::new(), None);
    for (i, name) in ["south", "east", "north", "west"].into_iter().enumerate() {
        let wall = Segment::new([corners[i], corners[(i + 1) % 4]])?;
        let gap = distance(&footprint, &wall, DistanceOptions::default());
        println!("{name:5} wall: {:.3} m away, nearest at {:.3}", gap.distance, gap.point_b);
        assert!(gap.lower <= gap.distance && gap.distance <= gap.upper, "the distance is within its bounds");
        if let Some(hit) = linear_cast(&footprint, &wall, ahead, drive)?.outcome.hit() {
            drive = drive.with_max_time(hit.time);
            first = Some((name, hit));
        }
    }
    let (name, hit) = first.ok_or("the room is closed")?;
    println!("straight on, the {name} wall comes after {:.3} m, at {:.3}", hit.time, hit.point);

    // By hand: the wedge's tip is at 1 + 0.6·sin ½, and there is 0.1 around it.
    let due = (3.0 - 0.6 * 0.5f64.sin() - 0.1) / 0.5f64.sin();
    let east = (5.0 - 0.6 * 0.5f64.cos() - 0.1) / 0.5f64.cos();
    assert!((hit.time - due.min(east)).abs() < 1e-14, "{} instead of {}", hit.time, due.min(east));
    Ok(())
}
