//! What the paper proves and claims, seen through the observer: van den Bergen, *Ray Casting against General Convex
//! Objects with Application to Continuous Collision Detection*, 2004.

use std::cell::Cell;

use crate::common::directions;
use crate::common::strategies::{rotation, vector};
use convex_support::glam::{DQuat, DVec3};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Posed, Rounded, SupportMap, closest_point,
};
use gjk_raycast::{
    CastMethod, Distance, DistanceOptions, IntersectOptions, Ray, RayCastOptions, Status, SubAlgorithm, distance,
    distance_with, intersects, iterative_ray_cast_with, paper, ray_cast, ray_cast_with,
};
use proptest::prelude::*;

const VALID: &str = "positive sizes";

/// The point of a shape with a closed form nearest `x`.
fn nearest(shape: &impl SupportMap<Vector = DVec3>, x: DVec3) -> DVec3 {
    closest_point(shape, x).expect("a closed form")
}

fn shape(kind: usize, turn: DQuat) -> Posed<Box<dyn SupportMap<Vector = DVec3>>> {
    let shape: Box<dyn SupportMap<Vector = DVec3>> = match kind {
        0 => Box::new(Cuboid::new(DVec3::new(1.0, 0.5, 0.25)).expect(VALID)),
        1 => Box::new(Ball::<DVec3>::new(0.75).expect(VALID)),
        2 => Box::new(Capsule::<DVec3>::new(0.5, 0.25).expect(VALID)),
        3 => Box::new(Cylinder::<DVec3>::new(0.75, 0.5).expect(VALID)),
        4 => Box::new(Cone::<DVec3>::new(0.75, 0.5).expect(VALID)),
        5 => Box::new(Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 0.5, 0.125), DQuat::IDENTITY).expect(VALID)),
        _ => Box::new(Rounded::new(Cuboid::new(DVec3::new(0.5, 0.25, 0.125)).expect(VALID), 0.25).expect(VALID)),
    };
    Posed::new(shape, turn, DVec3::ZERO).expect("a rotation")
}

/// What rounding leaves of an inequality between numbers of about one.
const ROUNDING: f64 = 1e-13;

proptest! {
    #![proptest_config(convex_support::laws::config(500))]

    /// Lemma 1: (x₂ − x₁)·(c₂ − c₁) ≥ ‖c₂ − c₁‖² for the points c closest to any two points x.
    #[test]
    fn lemma_1(kind in 0_usize..7, turn in rotation(), x1 in vector(4.0), x2 in vector(4.0)) {
        let shape = shape(kind, turn);
        let (c1, c2) = (nearest(&shape, x1), nearest(&shape, x2));
        prop_assert!((x2 - x1).dot(c2 - c1) >= (c2 - c1).length_squared() - ROUNDING, "{} {}", c1, c2);
    }

    /// Theorem 2: λ ↦ c(λ) is continuous. Its proof gives ‖c₂ − c₁‖² ≤ |λ₂ − λ₁|·r·(c₂ − c₁), so that the mapping is
    /// even Lipschitz: ‖c₂ − c₁‖ ≤ |λ₂ − λ₁|·‖r‖.
    #[test]
    fn theorem_2(
        kind in 0_usize..7, turn in rotation(), s in vector(4.0), r in vector(2.0), l1 in 0.0..3.0, step in -12.0..0.0,
    ) {
        let shape = shape(kind, turn);
        let l2 = l1 + 10.0_f64.powf(step);
        let (c1, c2) = (nearest(&shape, s + r * l1), nearest(&shape, s + r * l2));
        prop_assert!((c2 - c1).length() <= (l2 - l1) * r.length() + ROUNDING, "{} {}", c1, c2);
    }

    /// Theorem 3: (x − c(x))·r never decreases along the ray.
    #[test]
    fn theorem_3(kind in 0_usize..7, turn in rotation(), s in vector(4.0), r in vector(2.0)) {
        let shape = shape(kind, turn);
        let slopes = (0..60).map(|i| s + r * (0.05 * f64::from(i))).map(|x| (x - nearest(&shape, x)).dot(r));
        let slopes: Vec<f64> = slopes.collect();
        prop_assert!(slopes.windows(2).all(|w| w[0] <= w[1] + ROUNDING), "{:?}", slopes);
    }

    /// λ only grows, and stays a lower bound, in Algorithm 1 and in Algorithm 3.
    #[test]
    fn lambda_is_monotone_and_below_the_hit(kind in 0_usize..7, turn in rotation(), from in vector(1.0), aim in vector(0.6)) {
        prop_assume!(from.length() > 0.1);
        let shape = shape(kind, turn);
        let source = from.normalize() * 4.0;
        let ray = Ray { source, direction: aim - source };
        let (mut first, mut third) = (Vec::new(), Vec::new());
        let one = iterative_ray_cast_with(|x| closest_point(&shape, x), ray, RayCastOptions::default(), |i| first.push(i.lower));
        let three = ray_cast_with(&shape, ray, RayCastOptions::default(), |i| third.push(i.lower));
        for (cast, lambdas) in [(one, first), (three, third)] {
            prop_assert!(lambdas.is_sorted_by(|a, b| a <= &(b + ROUNDING)), "{:?}", lambdas);
            if let Some(hit) = cast.expect("finite").outcome.hit() {
                let grazing = hit.normal.map_or(1.0, |n| -n.dot(ray.direction.normalize())).max(1e-6);
                let last = lambdas.last().copied().unwrap_or(0.0);
                prop_assert!(last <= hit.lambda + ROUNDING / grazing, "{} {:?}", last, hit);
            }
        }
    }

    /// The bounds of Algorithm 2: ‖v‖ above, v·w/‖v‖ below, and ‖v − v*‖² ≤ ‖v‖² − v·w.
    #[test]
    fn v_and_w_bound_the_distance(kind in 0_usize..7, turn in rotation(), x in vector(4.0)) {
        let shape = shape(kind, turn);
        let nearest = x - nearest(&shape, x);
        prop_assume!(nearest.length() > 1e-3);
        let point = convex_support::Point::new(x).expect("finite");
        let mut seen = Vec::new();
        // Without the radius: then v is the paper's.
        let bare = |d: DVec3| shape.support(d);
        let bare = Bare(bare);
        let _ = distance_with(&point, &bare, DistanceOptions::default(), |i| {
            if !i.simplex.is_empty() {
                seen.push((i.v * i.scale, i.w * i.scale));
            }
        });
        prop_assert!(!seen.is_empty());
        for (v, w) in seen {
            prop_assert!(v.length() >= nearest.length() - ROUNDING, "an upper bound: {} {}", v, nearest);
            prop_assert!(v.dot(w) / v.length() <= nearest.length() + ROUNDING, "a lower bound: {} {}", v, w);
            prop_assert!(
                (v - nearest).length_squared() <= v.length_squared() - v.dot(w) + ROUNDING,
                "the error bound: {} {} {}", v, w, nearest
            );
        }
    }
}

proptest! {
    #![proptest_config(convex_support::laws::config(200))]

    /// The printed algorithms and the certified ones agree, to the tolerance of the printed ones.
    #[test]
    fn the_printed_algorithms_agree(kind in 0_usize..7, turn in rotation(), from in vector(1.0), aim in vector(0.5)) {
        prop_assume!(from.length() > 0.1);
        let shape = shape(kind, turn);
        let ray = Ray { source: from.normalize() * 4.0, direction: aim - from.normalize() * 4.0 };
        let certain = ray_cast(&shape, ray, RayCastOptions::default()).expect("finite").outcome;
        let first = paper::iterative_ray_cast(|x| nearest(&shape, x), ray, 1e-7, 10_000);
        let mut casts = vec![first];
        for sub_algorithm in [SubAlgorithm::Johnson, SubAlgorithm::SignedVolumes] {
            let mut seen = Vec::new();
            casts.push(paper::gjk_ray_cast(&shape, ray, 1e-13, 10_000, &sub_algorithm, |i| seen.push(i.lower)));
            prop_assert!(seen.is_sorted(), "λ only grows: {:?}", seen);

            let x = convex_support::Point::new(ray.source).expect("finite");
            let difference = convex_support::Difference::new(&x, &shape);
            let printed = paper::gjk_distance(&difference, 1e-6, 10_000, &sub_algorithm, |i| seen.push(i.gap()));
            let apart = (ray.source - nearest(&shape, ray.source)).length();
            prop_assert!(printed.is_close_enough && (printed.v.length() - apart).abs() <= 1e-6, "{:?}", printed);
        }
        for cast in casts {
            let Some(is_hit) = cast.hit else { continue };
            match certain.hit() {
                Some(hit) => {
                    let slope = hit.normal.map_or(1.0, |n| -n.dot(ray.direction.normalize()));
                    if slope > 0.01 {
                        prop_assert!(is_hit && (cast.lambda - hit.lambda).abs() < 1e-6 / slope, "{:?} {:?}", cast, hit);
                        prop_assert!((cast.x - ray.source - ray.direction * cast.lambda).length() < 1e-12);
                    }
                }
                // A ray that passes within the tolerance is a hit of the printed algorithms.
                None => prop_assert!(!is_hit || (cast.x - nearest(&shape, cast.x)).length() < 1e-5, "{:?}", cast),
            }
        }
    }
}

/// "For a sphere, the average number of iterations is roughly proportional to −log ε", with `‖v‖² ≤ ε·max‖x − p‖²` for
/// the condition: four for each decade. (The paper counts eight at 10⁻⁶, for rays of which it says no more than that
/// they are random; these take 18.6 there, and eight at 3·10⁻⁴.)
#[test]
fn iterations_of_the_printed_algorithm_grow_as_minus_log_epsilon() {
    let sphere = Bare(|direction: DVec3| direction.normalize());
    let mean = |decades: i32| {
        let steps = directions(200).enumerate().map(|(i, d)| {
            let (source, aim) = (DVec3::from_array(d) * 3.0, DVec3::new(d[1], d[2], d[0]) * 0.004 * i as f64);
            let (ray, epsilon) = (Ray { source, direction: aim - source }, 10.0_f64.powi(-decades));
            let cast = paper::gjk_ray_cast(&sphere, ray, epsilon, 100, &SubAlgorithm::Johnson, |_| {});
            assert!(cast.hit.is_some(), "{decades} {i}: {cast:?}");
            cast.iterations as f64
        });
        steps.sum::<f64>() / 200.0
    };
    let means = [4, 6, 8, 10, 12].map(mean);
    for pair in means.windows(2) {
        let per_decade = 0.5 * (pair[1] - pair[0]);
        assert!((3.5..4.5).contains(&per_decade), "{means:?}");
    }
}

/// Nothing loops or panics on numbers that are not finite, and none of them is a hit.
#[test]
fn the_printed_algorithms_end_on_odd_numbers() {
    let sphere = Bare(|direction: DVec3| direction.normalize());
    for source in [DVec3::NAN, DVec3::new(f64::INFINITY, 0.0, 0.0)] {
        let ray = Ray { source, direction: DVec3::X };
        let cast = paper::gjk_ray_cast(&sphere, ray, 1e-6, 100, &SubAlgorithm::Johnson, |_| {});
        assert!(cast.hit != Some(true) && cast.iterations <= 100, "{cast:?}");
        let cast = paper::iterative_ray_cast(|x| x.normalize(), ray, 1e-6, 100);
        assert!(cast.hit != Some(true) && cast.iterations <= 100, "{cast:?}");
    }
    let found = paper::gjk_distance(&Bare(|_| DVec3::NAN), 1e-6, 100, &SubAlgorithm::Johnson, |_| {});
    assert!(!found.is_close_enough && found.iterations <= 100, "{found:?}");
}

/// A support map that is nothing but a function.
struct Bare<F>(F);

impl<F: Fn(DVec3) -> DVec3> SupportMap for Bare<F> {
    type Vector = DVec3;

    fn support(&self, direction: DVec3) -> DVec3 {
        (self.0)(direction)
    }
}

/// "For a sphere, the average number of iterations is roughly proportional to −log ε": a sphere of which nothing is
/// known but its support points, by the paper's own steps.
#[test]
fn iterations_on_a_sphere_grow_as_minus_log_epsilon() {
    let sphere = Bare(|direction: DVec3| direction.normalize());
    let mean = |decades: i32| {
        let options = RayCastOptions::new().with_tolerance(10.0_f64.powi(-decades)).with_method(CastMethod::Gjk);
        let steps = directions(200).enumerate().map(|(i, d)| {
            let (source, aim) = (DVec3::from_array(d) * 3.0, DVec3::new(d[1], d[2], d[0]) * 0.004 * i as f64);
            let cast = ray_cast(&sphere, Ray { source, direction: aim - source }, options).expect("finite");
            assert_eq!(cast.status, Status::Converged, "{decades} {i}: {cast:?}");
            cast.iterations as f64
        });
        steps.sum::<f64>() / 200.0
    };
    let means = [2, 4, 6, 8, 10, 12].map(mean);
    // Four for each decade, all the way down.
    for (i, pair) in means.windows(2).enumerate() {
        let per_decade = 0.5 * (pair[1] - pair[0]);
        assert!((3.5..5.0).contains(&per_decade), "decades {i}: {means:?}");
    }
}

/// "As soon as the lower bound λ becomes larger than the given maximum parameter, Algorithm 3 may terminate": the
/// shorter a ray that misses is, the less it costs.
#[test]
fn short_rays_end_early() {
    let hull = Polytope::new(directions(100).map(|d| DVec3::new(d[0], 0.3 * d[1], 0.3 * d[2]))).expect("finite");
    let steps = [f64::INFINITY, 0.9, 0.5].map(|part| {
        let casts = directions(100).map(|d| {
            let source = DVec3::from_array(d) * 1.5;
            let ray = Ray { source, direction: DVec3::new(d[1], d[2], d[0]) * 0.2 - source };
            let hit =
                ray_cast(&hull, ray, RayCastOptions::new()).expect("finite").outcome.hit().expect("towards the middle");
            let cast = ray_cast(&hull, ray, RayCastOptions::new().with_max_lambda(part * hit.lambda)).expect("finite");
            assert_eq!(cast.outcome.is_miss(), part < 1.0, "{part}: {cast:?}");
            cast.iterations
        });
        casts.sum::<usize>()
    });
    assert!(steps[1] < steps[0] && 2 * steps[2] < steps[1], "{steps:?}");
}

/// "By initializing v₀ with a previously returned separating axis, the number of iterations per frame can be reduced
/// considerably": a ray that moves slowly past a hull, and two hulls that pass one another.
#[test]
fn the_last_axis_saves_iterations() {
    let hull = Polytope::new(directions(100).map(DVec3::from_array)).expect("finite");
    let mut casts = [0, 0];
    let mut told = None;
    for frame in 0..200 {
        let height = 1.05 + 1e-3 * f64::from(frame);
        let ray =
            Ray { source: DVec3::new(-4.0, height, 0.1), direction: DVec3::new(1.0, 1e-3 * f64::from(frame % 7), 0.0) };
        let warm = RayCastOptions::new().with_warm_start(told);
        for (count, options) in casts.iter_mut().zip([RayCastOptions::new(), warm]) {
            let cast = ray_cast(&hull, ray, options).expect("finite");
            *count += cast.iterations;
            assert!(cast.outcome.is_miss(), "it passes by: {frame} {cast:?}");
            told = cast.warm_start(told);
        }
    }
    assert!(2 * casts[1] <= casts[0], "cold and warm casts: {casts:?}");

    let mut tests = [0, 0];
    let mut axis = None;
    for frame in 0..200 {
        let other = Posed::translated(&hull, DVec3::new(1.5, 1.6 + 1e-3 * f64::from(frame), 0.2)).expect("finite");
        let mut warm = IntersectOptions::new();
        warm.axis = axis;
        for (count, options) in tests.iter_mut().zip([IntersectOptions::new(), warm]) {
            let answer = intersects(&hull, &other, options);
            assert_eq!(answer.decided(), Some(false), "{frame}");
            *count += answer.iterations;
            axis = answer.axis;
        }
    }
    assert!(tests[1] <= tests[0] && tests[1] <= 220, "cold and warm tests: {tests:?}");
}

/// Every sub-algorithm ends on the same vector: with `v·v* ≥ |v*|²` for the shortest `v*` of a convex set, any `v` of
/// it within the bracket has `|v − v*|² ≤ |v|² − |v*|² ≤ upper² − lower²`.
#[test]
fn the_end_does_not_depend_on_the_sub_algorithm() {
    let count = Cell::new(0);
    for d in directions(60) {
        let b =
            Posed::new(Cuboid::new(DVec3::ONE).expect(VALID), DQuat::from_rotation_y(d[0]), DVec3::from_array(d) * 4.0);
        let (a, b) = (Cone::<DVec3>::new(1.0, 0.5).expect(VALID), b.expect("a rotation"));
        let all = [SubAlgorithm::NearestFace, SubAlgorithm::Johnson, SubAlgorithm::SignedVolumes];
        let ends = all.map(|s| distance(&a, &b, DistanceOptions::new().with_sub_algorithm(s)));
        for end in &ends {
            let [v, v0] = [end, &ends[0]].map(|end| end.point_a - end.point_b);
            let within = |end: &Distance<DVec3>| ((end.upper - end.lower) * (end.upper + end.lower)).sqrt();
            assert!((v - v0).length() <= within(end) + within(&ends[0]) + 1e-14, "{d:?}: {ends:?}");
            count.set(count.get() + 1);
        }
    }
    assert_eq!(count.get(), 180);
}
