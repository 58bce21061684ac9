//! Hulls of small integers, against the oracle of the tests of gjk-raycast.

#[allow(clippy::duplicate_mod, dead_code, reason = "the oracle of the tests, of which a part is used here")]
#[path = "../../../crates/gjk-raycast/tests/exact/mod.rs"]
mod exact;

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3A};

use self::exact::Point;
use self::exact::agree::{distance_agrees, linear_cast_agrees, ray_agrees};
use super::Verdict;
use workloads::rng::Rng;

/// A whole number of magnitude up to `most`.
fn whole(most: i64, rng: &mut Rng) -> i128 {
    i128::from(rng.below(2 * most.unsigned_abs() + 1) as i64 - most)
}

/// Up to eight points, of one magnitude or stretched, often repeated or in a plane.
fn cloud(planar: bool, rng: &mut Rng) -> Vec<Point> {
    let most = [1, 2, 9, 60, 250][rng.below(5) as usize];
    let flat = [most, 1, 0][rng.below(3) as usize];
    let mut points: Vec<Point> = Vec::new();
    for _ in 0..=rng.below(8) {
        let again = !points.is_empty() && rng.below(8) == 0;
        points.push(if again {
            points[rng.below(points.len() as u64) as usize]
        } else {
            [whole(most, rng), whole(flat, rng), if planar { 0 } else { whole(most, rng) }]
        });
    }
    points
}

fn direction(planar: bool, rng: &mut Rng) -> Point {
    loop {
        let d = [whole(9, rng), whole(9, rng), if planar { 0 } else { whole(9, rng) }];
        if d != [0; 3] {
            return d;
        }
    }
}

/// One question, in both precisions.
pub(super) fn case(rng: &mut Rng) -> Verdict {
    let planar = rng.below(3) == 0;
    let (a, b, d) = (cloud(planar, rng), cloud(planar, rng), direction(planar, rng));
    // Half of the rays run through a vertex.
    let through = a[rng.below(a.len() as u64) as usize];
    let back = whole(20, rng).abs();
    let apart =
        if rng.below(2) == 0 { [0; 3] } else { [whole(9, rng), whole(9, rng), if planar { 0 } else { whole(9, rng) }] };
    let source: Point = core::array::from_fn(|i| through[i] - back * d[i] + apart[i]);
    let kind = rng.below(3);
    let told = |verdict: Verdict| {
        verdict.map_err(|why| match kind {
            0 => format!("{why}\n  of the distance of {a:?} and {b:?}"),
            1 => format!("{why}\n  of {a:?} by the ray from {source:?} along {d:?}"),
            _ => format!("{why}\n  of {a:?} and {b:?}, which moves along {d:?}"),
        })
    };
    match (kind, planar) {
        (0, true) => told(distance_agrees::<DVec2>(&a, &b).and_then(|()| distance_agrees::<Vec2>(&a, &b))),
        (0, false) => told(distance_agrees::<DVec3>(&a, &b).and_then(|()| distance_agrees::<Vec3A>(&a, &b))),
        (1, true) => told(ray_agrees::<DVec2>(&a, source, d).and_then(|()| ray_agrees::<Vec2>(&a, source, d))),
        (1, false) => told(ray_agrees::<DVec3>(&a, source, d).and_then(|()| ray_agrees::<Vec3A>(&a, source, d))),
        (_, true) => told(linear_cast_agrees::<DVec2>(&a, &b, d).and_then(|()| linear_cast_agrees::<Vec2>(&a, &b, d))),
        (_, false) => {
            told(linear_cast_agrees::<DVec3>(&a, &b, d).and_then(|()| linear_cast_agrees::<Vec3A>(&a, &b, d)))
        }
    }
}
