//! Claims of Rimon and Boyd's paper.

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ellipsoid, Polytope};
use ellip_margin::{MarginOptions, free_margin};
use gjk_raycast::{DistanceOptions, distance};
use lj_ellipsoid::{EnclosingMethod, EnclosingOptions, enclosing};
use workloads::rng::Rng;
use xtask::plot::duration;
use xtask::validate::progress;

use super::super::growth::{self, time};
use super::Claim;

/// The claims, with the numbers that decide them.
pub(super) fn claims() -> Vec<Claim> {
    let mut claims = Vec::new();
    claims.extend(shrunk());
    claims.extend(fits());
    claims.extend(constant_time());
    progress("clearance");
    claims.extend(many_obstacles());
    claims
}

/// Shrunk by the dimension, the enclosing ellipsoid lies in the hull: its reach along any direction is no more than
/// that of the points.
fn shrunk() -> Option<Claim> {
    let mut random = Rng::new(23);
    let mut worst = f64::NEG_INFINITY;
    for _ in 0..100 {
        let points: Vec<DVec3> = (0..12).map(|_| DVec3::from(random.cube()) * DVec3::new(3.0, 1.0, 0.3)).collect();
        let fit =
            enclosing(&points.iter().map(DVec3::to_array).collect::<Vec<_>>(), EnclosingOptions::default()).ok()?;
        let center = DVec3::from_array(fit.ellipsoid.center());
        let (axes, lengths) = (fit.ellipsoid.axes(), fit.ellipsoid.semi_axes());
        for _ in 0..200 {
            let u = DVec3::from(random.sphere());
            let reach = |k: usize| lengths[k] * DVec3::from_array(axes[k]).dot(u);
            let ellipsoid = (0..3).map(|k| reach(k).powi(2)).sum::<f64>().sqrt() / 3.0;
            let hull = points.iter().map(|p| (*p - center).dot(u)).fold(f64::NEG_INFINITY, f64::max);
            worst = worst.max(ellipsoid / hull);
        }
    }
    Some(Claim {
        place: "Section 2",
        claim: "the Löwner–John ellipsoid shrunk by the dimension lies within the body",
        measured: format!("100 bodies of 12 points, 200 directions each: it reaches at most {worst:.4} of the body"),
        verdict: if worst <= 1.0 + 1e-9 { "holds" } else { "fails here" },
    })
}

/// The ellipsoid algorithm in the plane, and its place taken.
fn fits() -> Option<Claim> {
    let mut random = Rng::new(24);
    let (mut iterations, mut newtons, mut times) = (0, 0, [0.0; 2]);
    const BODIES: usize = 20;
    for _ in 0..BODIES {
        let points: Vec<[f64; 2]> = (0..8).map(|_| [2.0 * random.signed(), random.signed()]).collect();
        let options = |method| EnclosingOptions::default().with_method(method).with_epsilon(1e-4);
        let (slow, fast) = (options(EnclosingMethod::EllipsoidAlgorithm), options(EnclosingMethod::Newton));
        iterations += enclosing(&points, slow).ok()?.iterations;
        newtons += enclosing(&points, fast).ok()?.iterations;
        times[0] += time(|| _ = std::hint::black_box(enclosing(&points, slow)));
        times[1] += time(|| _ = std::hint::black_box(enclosing(&points, fast)));
    }
    let mean = |sum: usize| sum as f64 / BODIES as f64;
    Some(Claim {
        place: "Section 2",
        claim: "in the plane, a typical run of the ellipsoid algorithm takes 600 iterations, and about 2 s",
        measured: format!(
            "8 random points to 1e-4, as corrected: {:.0} iterations, {}; our default {:.1} iterations, {}",
            mean(iterations),
            duration(times[0] / BODIES as f64),
            mean(newtons),
            duration(times[1] / BODIES as f64)
        ),
        verdict: if (150.0..2400.0).contains(&mean(iterations)) { "holds in iterations" } else { "differs" },
    })
}

/// The margin of fitted ellipsoids beside the distance of the hulls, as these grow.
fn constant_time() -> Option<Claim> {
    let mut random = Rng::new(25);
    let mut measure = |n: usize| {
        let mut cloud =
            |at: f64| -> Vec<DVec3> { (0..n).map(|_| DVec3::from(random.sphere()) + DVec3::X * at).collect() };
        let (a, b) = (cloud(0.0), cloud(2.5));
        let fit = |points: &[DVec3]| {
            let fit =
                enclosing(&points.iter().map(DVec3::to_array).collect::<Vec<_>>(), EnclosingOptions::default()).ok()?;
            let sphere = fit.ellipsoid.semi_axes();
            Ellipsoid::new(DVec3::from_array(fit.ellipsoid.center()), DVec3::from_array(sphere), DQuat::IDENTITY).ok()
        };
        let (outer, obstacle) = (fit(&a)?, fit(&b)?);
        let (hull, other) = (Polytope::new(a).ok()?, Polytope::new(b).ok()?);
        let margin = time(|| _ = std::hint::black_box(&free_margin(&outer, &obstacle, MarginOptions::default())));
        let exact = time(|| _ = std::hint::black_box(distance(&hull, &other, DistanceOptions::new())));
        Some([margin, exact])
    };
    let (small, large) = (measure(20)?, measure(10_000)?);
    Some(Claim {
        place: "Abstract",
        claim: "the distance of ellipsoids takes constant time, that of polyhedra grows with their complexity",
        measured: format!(
            "20 to 10,000 vertices: margin {} to {}, distance by scanning all vertices {} to {}",
            duration(small[0]),
            duration(large[0]),
            duration(small[1]),
            duration(large[1])
        ),
        verdict: if large[0] < 2.0 * small[0] && large[1] > 5.0 * small[1] { "holds" } else { "differs" },
    })
}

/// n·m pairs, and how many of them have to be looked at.
fn many_obstacles() -> Option<Claim> {
    let mut random = Rng::new(26);
    let mut solved = |m: u32| {
        let obstacles = growth::field(m, &mut random);
        let mut tracked = ellip_margin::Clearance::new(&obstacles, MarginOptions::default()).ok()?;
        let steps = (0..30).map(|step| tracked.step(&growth::robot(f64::from(step) * 0.01)));
        let sum = steps.map(|result| result.map_or(0, |r| r.pairs_evaluated)).sum::<usize>();
        Some(sum as f64 / 30.0)
    };
    let (few, many) = (solved(100)?, solved(10_000)?);
    Some(Claim {
        place: "Section 4.1",
        claim: "n links among m obstacles take O(n·m)",
        measured: format!("margins solved per step, 30 links: {few:.1} of 3,000 pairs, {many:.1} of 300,000"),
        verdict: if many < 20.0 * few.max(1.0) { "overcome: far pairs are never looked at" } else { "holds" },
    })
}
