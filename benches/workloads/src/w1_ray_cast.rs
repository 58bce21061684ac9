//! W1: rays against one body.

use crate::line_entry::LineEntry;
use crate::rng::{Rng, round_to_f32};
use crate::shapes::{SHAPE_NAMES, Shape, face_triangles, point_inside};
use crate::vec3::{Vec3, add, scale, sub};

/// How many rays [`rays`] makes.
pub const RAYS: usize = 10_000;

/// The ray `{ origin + λ·direction : 0 ≤ λ ≤ 1 }` and its true answer. Its numbers are exact in `f32`.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts, about 5 from the body's centre.
    pub origin: Vec3,
    /// From there to the end of the ray.
    pub direction: Vec3,
    /// The `λ` at which it enters the body; `None` for a miss.
    pub lambda: Option<f64>,
    /// How easily a hit becomes a miss.
    pub ambiguity: Ambiguity,
}

/// Whether a ray hits or misses may hang on the last digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ambiguity {
    /// Both precisions must tell.
    None,
    /// The answer changes when the body is scaled by 1 ± 1e-5: an `f32` answer is not judged.
    InF32,
    /// The answer changes when the body is scaled by 1 ± 1e-9: no answer is judged.
    InF64,
}

/// The rays against the shape of that name.
///
/// # Panics
/// If there is no such shape.
#[must_use]
pub fn rays(shape_name: &str) -> Vec<Ray> {
    let index = SHAPE_NAMES.iter().position(|&name| name == shape_name).expect("a name of `SHAPE_NAMES`");
    let shape = Shape::named(shape_name);
    let truth = LineEntry::new(&shape);
    let bounds = shape.bounds();
    let mut rng = Rng::new(1000 + index as u64);
    (0..RAYS)
        .map(|_| {
            let origin = scale(rng.sphere(), 5.0).map(round_to_f32);
            let target = [0, 1, 2].map(|i| rng.signed() * 1.3 * bounds[i]);
            through(&truth, origin, target)
        })
        .collect()
}

/// The ray from `origin` to as far behind `target`.
fn through(truth: &LineEntry<'_>, origin: Vec3, target: Vec3) -> Ray {
    let direction = scale(sub(target, origin), 2.0).map(round_to_f32);
    let cast = |size| truth.entry(origin, direction, size).filter(|lambda| (0.0..=1.0).contains(lambda));
    let lambda = cast(1.0);
    let changes = |by: f64| [1.0 + by, 1.0 - by].iter().any(|&size| cast(size).is_some() != lambda.is_some());
    let ambiguity = match () {
        () if changes(1e-9) => Ambiguity::InF64,
        () if changes(1e-5) => Ambiguity::InF32,
        () => Ambiguity::None,
    };
    Ray { origin, direction, lambda, ambiguity }
}

/// Rays that hit the box or hull of that name well inside its faces, and nearly squarely.
///
/// # Panics
/// If there is no such box or hull.
#[must_use]
pub fn square_on_faces(shape_name: &str, count: usize) -> Vec<Ray> {
    let shape = Shape::named(shape_name);
    let (truth, faces) = (LineEntry::new(&shape), face_triangles(&shape));
    let mut rng = Rng::new(1100);
    (0..count)
        .map(|_| {
            let (target, normal) = point_inside(&faces, &mut rng);
            let back = add(scale(normal, 5.0), rng.cube());
            through(&truth, add(target, back).map(round_to_f32), target)
        })
        .collect()
}

/// The rays as a file: `o[3] d[3] λ flag` each, with `λ = −1` for a miss.
#[must_use]
pub fn records(rays: &[Ray]) -> Vec<f64> {
    let record = |ray: &Ray| {
        let ([a, b, c], [d, e, f]) = (ray.origin, ray.direction);
        let flag = match ray.ambiguity {
            Ambiguity::None => 0.0,
            Ambiguity::InF32 => 1.0,
            Ambiguity::InF64 => 2.0,
        };
        [a, b, c, d, e, f, ray.lambda.unwrap_or(-1.0), flag]
    };
    rays.iter().flat_map(record).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_square_on_faces_hit_them_halfway() {
        for name in ["cuboid", "hull64"] {
            for ray in square_on_faces(name, 500) {
                let lambda = ray.lambda.expect("a hit");
                assert!((lambda - 0.5).abs() < 1e-6 && ray.ambiguity == Ambiguity::None, "{name}: {ray:?}");
            }
        }
    }
}
