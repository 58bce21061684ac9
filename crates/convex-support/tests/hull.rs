//! Polytopes reduced to their vertices and edges are the same sets as the points they come from.

use convex_support::glam::{DQuat, DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::strategies as any;
use convex_support::{Core, Hint, Polytope, Scalar, SupportMap, Vector};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

/// Both reach equally far along `d`, however the search begins, and the reduced one has no point that the other has
/// not.
fn same_set<V: Vector>(points: &[V], directions: &[V]) -> Result<(), TestCaseError> {
    let all = Polytope::new(points.iter().copied()).expect("valid points");
    let hull = Polytope::hull_of(points.iter().copied()).expect("valid points");
    prop_assert!(hull.points().iter().all(|p| points.contains(p)), "a vertex that is not among the points");
    // The two searches are right to different errors.
    prop_assert_eq!(hull.core(), Core { error: hull.core().error, ..all.core() });
    let mut hint = Hint::new();
    for &d in directions {
        let tolerance = V::Scalar::EPSILON * V::Scalar::from_f64(8.0) * all.core().extent * d.norm();
        let seen = |p: V| d.dot(p - all.core().origin);
        let best = seen(all.support(d));
        prop_assert!(seen(hull.support(d)) >= best - tolerance, "short of {best:?} along {d:?}: {:?}", hull.support(d));
        hint.rewind();
        let warm = d.dot(hull.core_support(d, &mut hint));
        prop_assert!(warm >= best - tolerance, "short of {best:?} along {d:?} from a hint: {warm:?}");
    }
    Ok(())
}

fn reduces<V: Vector>(largest: usize, cases: u32) {
    let strategy = any::size::<V::Scalar>().prop_flat_map(move |size| {
        let directions = proptest::collection::vec(any::direction::<V>(), 20);
        (any::points::<V>(size, largest), directions, any::vector::<V>(size * V::Scalar::from_f64(1e3)))
    });
    let mut runner =
        TestRunner::new(ProptestConfig { failure_persistence: None, ..convex_support::laws::config(cases) });
    let outcome = runner.run(&strategy, |(mut points, directions, shift)| {
        same_set(&points, &directions)?;
        // Far from the origin the points are rounded to a coarse grid, and many become coplanar.
        points.iter_mut().for_each(|p| *p += shift);
        same_set(&points, &directions)
    });
    if let Err(error) = outcome {
        panic!("in {}: {error}", std::any::type_name::<V>());
    }
}

#[test]
fn hulls_of_few_points_are_the_same_sets() {
    reduces::<Vec2>(40, 300);
    reduces::<DVec2>(12, 300);
    reduces::<Vec3>(40, 300);
    reduces::<Vec3A>(12, 300);
    reduces::<DVec3>(40, 300);
}

#[test]
fn hulls_of_many_points_are_the_same_sets() {
    reduces::<Vec2>(600, 30);
    reduces::<DVec2>(600, 30);
    reduces::<Vec3>(600, 30);
    reduces::<DVec3>(600, 30);
}

/// `n` points of a sphere in a spiral, evenly spread.
fn spiral(n: usize) -> impl Iterator<Item = DVec3> {
    (0..n).map(move |i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / n as f64;
        let (sine, cosine) = (2.399_963 * i as f64).sin_cos();
        DVec3::new(cosine, sine, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    })
}

#[test]
fn every_point_of_a_sphere_is_a_vertex() {
    let hull = Polytope::hull_of(spiral(5000)).expect("valid points");
    assert_eq!(hull.points().len(), 5000);
    for (i, d) in spiral(5000).enumerate() {
        assert_eq!(hull.support(d), hull.points()[i], "each is the farthest along itself");
    }
}

#[test]
fn a_grid_is_reduced_to_a_box() {
    // Turned, the coplanar points are off their planes by roundings, and many of them are vertices of the exact hull.
    let turned = DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9).normalize();
    let grid = || (0..17 * 17 * 17).map(|i| DVec3::new((i % 17) as f64, (i / 17 % 17) as f64, (i / 289) as f64) - 8.0);
    let cube = Polytope::hull_of(grid()).expect("valid points");
    assert!(cube.points().len() < 30, "{} vertices", cube.points().len());
    let turned: Vec<DVec3> = grid().map(|p| turned * p).collect();
    let directions: Vec<DVec3> = turned.iter().copied().filter(|p| *p != DVec3::ZERO).collect();
    same_set(&turned, &directions[..500]).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn points_of_wild_magnitudes_are_handled() {
    for s in [1e-300, 1e-150, 1.0, 1e150, 1e300] {
        let points: Vec<DVec3> = spiral(100).map(|p| p * s).collect();
        let hull = Polytope::hull_of(points).expect("valid points");
        assert_eq!(hull.points().len(), 100, "at {s:e}");
        assert_eq!(hull.support(DVec3::Z).z, 0.99 * s, "at {s:e}");
    }
    // Directions whose products with the points underflow.
    let small = Polytope::hull_of(spiral(100).map(|p| p * 1e-20)).expect("valid points");
    assert_eq!(small.support(DVec3::Z * 1e-310), small.support(DVec3::Z));
    // Predicates whose products underflow: still the same set.
    let points: Vec<DVec3> = spiral(60).enumerate().map(|(i, p)| p * 10f64.powi(-5 * i as i32)).collect();
    let directions: Vec<DVec3> = spiral(50).collect();
    same_set(&points, &directions).unwrap_or_else(|error| panic!("{error}"));
}

/// The first of the points that reach farthest, by looking at all of them.
fn first_farthest<V: Vector>(hull: &Polytope<V>, d: V) -> V {
    let reach = |p: V| d.dot(p - hull.core().origin);
    hull.points().iter().copied().reduce(|best, p| if reach(p) > reach(best) { p } else { best }).expect("not empty")
}

#[test]
fn of_vertices_equally_far_the_first_is_found() {
    // The middle is 0, so that both see the same numbers. Sizes differ, up to needles and flakes; directions along
    // axes, edges and facets tie.
    for (n, size) in [(40, DVec3::ONE), (300, DVec3::new(1.0, 0.5, 0.25)), (2000, DVec3::new(1e6, 1.0, 1e-3))] {
        let half: Vec<DVec3> = spiral(n).map(|p| p * size).collect();
        let hull = Polytope::hull_of(half.iter().copied().chain(half.iter().map(|&p| -p))).expect("valid points");
        assert_eq!(hull.core().origin, DVec3::ZERO);
        let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let any = spiral(3000).map(|d| d / size);
        let across = half.windows(3).map(|w| (w[1] - w[0]).cross(w[2] - w[0]));
        let mut hint = Hint::new();
        for d in any.chain(axes).chain(across) {
            let expected = first_farthest(&hull, d);
            assert_eq!(hull.support(d), expected, "{n} along {d}");
            hint.rewind();
            assert_eq!(hull.core_support(d, &mut hint), expected, "{n} along {d}, whatever was asked before");
        }
    }
}
