//! The ways to find the planes of a ray cast beside one another, on the rays of W1 in `f64`: nanoseconds per ray, as
//! the table in `docs/ray-cast.md` has them.
#![allow(clippy::print_stdout, reason = "printing is what it is for")]

use std::time::Duration;

use benches::ours::{self, Effort};
use gjk_raycast::CastMethod;
use workloads::score::Precision;
use workloads::shapes::Shape;
use workloads::w1_ray_cast;

/// Of the other shapes the crossing is known in closed form, which the portal does not get to see.
const SHAPES: [&str; 4] = ["hull16", "hull64", "hull256", "hull1024"];

/// What a cell may spend.
const BUDGET: Duration = Duration::from_millis(200);

fn main() {
    println!("| | {} |\n|---|{}", SHAPES.join(" | "), "---|".repeat(SHAPES.len()));
    for (name, method) in [("Gjk", CastMethod::Gjk), ("Portal", CastMethod::Portal)] {
        let cells = SHAPES.map(|shape| {
            let rays = w1_ray_cast::rays(shape);
            let effort = Effort { method, ..Effort::default() };
            let solver = ours::ray_casts(Precision::Double, &Shape::named(shape), &rays, effort);
            format!("{:.0}", solver.nanoseconds(0..rays.len(), BUDGET))
        });
        println!("| `{name}` | {} |", cells.join(" | "));
    }
}
