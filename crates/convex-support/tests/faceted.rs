//! Hulls with facets, against shapes with closed forms of their own.

use crate::line_crossing::crossing_of;
use convex_support::glam::{DQuat, DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::strategies as any;
use convex_support::{
    CertainCrossing, Crossing, Cuboid, Faceted, LineQuery, Posed, Scalar, SupportMap, Triangle, Vector, support_value,
};
use num_traits::Float;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::Cell;

/// The corners of a box in a pose.
fn corners<V: Vector>(half_extents: V, posed: &Posed<Cuboid<V>>) -> Vec<V> {
    let corner = |n: usize| {
        let sign = |i: usize| if n >> i & 1 == 1 { V::Scalar::ONE } else { -V::Scalar::ONE };
        posed.rotation() * V::from_fn(|i| half_extents.get(i) * sign(i)) + posed.translation()
    };
    (0..1 << V::DIM).map(corner).collect()
}

/// A box is crossed where its corners' hull is.
fn boxes<V: Vector>() {
    let strategy = any::size::<V::Scalar>().prop_flat_map(|size| {
        let side = || (0.05..1.0).prop_map(move |x| size * V::Scalar::from_f64(x));
        let far = prop_oneof![Just(1.5), Just(4.0), Just(1e3)];
        let source = far.prop_flat_map(move |r| any::vector::<V>(size * V::Scalar::from_f64(r)));
        ([side(), side(), side()], any::pose::<V>(size), source, any::vector::<V>(size), Just(size))
    });
    let (hits, misses) = (Cell::new(0), Cell::new(0));
    let config = ProptestConfig { failure_persistence: None, ..convex_support::laws::config(2000) };
    let mut runner = TestRunner::new(config);
    runner
        .run(&strategy, |(sides, (rotation, translation), source, target, size)| {
            let half_extents = V::from_fn(|i| sides[i]);
            let posed = Posed::new(Cuboid::new(half_extents).unwrap(), rotation, translation).unwrap();
            let hull = Faceted::hull_of(corners(half_extents, &posed)).unwrap();
            let (source, direction) = (source + translation, target - source);
            prop_assume!(direction.norm() > size * V::Scalar::from_f64(0.1));
            let unit = direction / direction.norm();
            let error = V::Scalar::EPSILON * V::Scalar::from_f64(64.0) * (size + translation.norm() + source.norm());
            match (crossing_of(&posed, source, direction), crossing_of(&hull, source, direction)) {
                (Some(theirs), Some(ours)) => {
                    hits.set(hits.get() + 1);
                    let (along, long) = (unit.dot(theirs.normal).abs(), theirs.exit - theirs.entry);
                    // Near an edge the two may enter by different faces; a short stretch may begin elsewhere on it.
                    let within = error / direction.norm() / along.max(V::Scalar::from_f64(1e-3));
                    prop_assert!((ours.entry - theirs.entry).abs() <= within.max(long), "{ours:?} against {theirs:?}");
                    prop_assert!(
                        (ours.entry - theirs.entry).abs() <= within || along < V::Scalar::from_f64(1e-3),
                        "{ours:?} against {theirs:?}"
                    );
                    prop_assert!(
                        (ours.normal.norm() - V::Scalar::ONE).abs() <= V::Scalar::EPSILON * V::Scalar::from_f64(4.0)
                    );
                }
                (None, None) => misses.set(misses.get() + 1),
                (Some(Crossing { entry, exit, .. }), None) | (None, Some(Crossing { entry, exit, .. })) => {
                    // One by rounding: the stretch is as short as the square root of rounding, cut off a corner.
                    let long = (exit - entry) * direction.norm();
                    prop_assert!(long <= error * V::Scalar::from_f64(1e4), "{long:?} long for one of both");
                }
            }
            Ok(())
        })
        .unwrap_or_else(|error| panic!("in {}: {error}", std::any::type_name::<V>()));
    let (hits, misses) = (hits.get(), misses.get());
    assert!(hits > 200 && misses > 200, "{hits} hits and {misses} misses are no fair sample");
}

#[test]
fn a_hull_of_corners_is_crossed_as_the_box() {
    boxes::<DVec2>();
    boxes::<Vec2>();
    boxes::<DVec3>();
    boxes::<Vec3>();
    boxes::<Vec3A>();
}

/// The half-spaces are all needed and contain all vertices, and each touches what spans it.
#[test]
fn half_spaces_are_the_facets() {
    let cube = Cuboid::new(DVec3::new(1.0, 2.0, 3.0)).unwrap();
    let turned = Posed::new(cube, DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9), DVec3::new(100.0, -20.0, 3.0)).unwrap();
    // Besides the corners, points on the faces and inside: triangles in one plane are one facet.
    let mut points = corners(cube.half_extents(), &turned);
    let mut more: Vec<DVec3> = points.iter().flat_map(|&p| points.iter().map(move |&q| (p + q) * 0.5)).collect();
    points.append(&mut more);
    let hull = Faceted::hull_of(points).unwrap();
    for (n, reach) in hull.half_spaces() {
        assert!((support_value(&turned, n) - reach).abs() <= 1e-13, "{n} reaches {reach}");
        let along = turned.rotation().transpose() * n;
        assert!((along.abs().max_element() - 1.0).abs() <= 1e-13 || hull.half_spaces().len() > 6, "{along}");
    }
    let exact = Faceted::hull_of(corners(cube.half_extents(), &Posed::translated(cube, DVec3::ZERO).unwrap())).unwrap();
    let mut faces: Vec<_> = exact.half_spaces().map(|(n, b)| (n.to_array(), b)).collect();
    faces.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let face =
        |i: usize, side: f64| (DVec3::from_fn(|k| if k == i { side } else { 0.0 }).to_array(), [1.0, 2.0, 3.0][i]);
    let mut expected: Vec<_> = (0..3).flat_map(|i| [face(i, -1.0), face(i, 1.0)]).collect();
    expected.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(faces, expected);
}

#[test]
fn flat_hulls_have_two_sides() {
    let at = [DVec3::new(1.0, 0.0, 0.5), DVec3::new(0.0, 1.0, 0.5), DVec3::new(-1.0, -1.0, 0.75)];
    let (hull, triangle) = (Faceted::hull_of(at).unwrap(), Triangle::new(at).unwrap());
    for source in [DVec3::new(0.1, 0.2, 4.0), DVec3::new(0.0, -0.1, -3.0), DVec3::new(3.0, 0.5, 1.0)] {
        for target in [DVec3::new(0.0, 0.0, 0.5), DVec3::new(0.2, 0.1, 0.6), DVec3::new(2.0, 0.0, 0.0)] {
            let (ours, theirs) =
                (crossing_of(&hull, source, target - source), crossing_of(&triangle, source, target - source));
            match (ours, theirs) {
                (Some(ours), Some(theirs)) => {
                    assert!((ours.entry - theirs.entry).abs() <= 1e-14, "{ours:?} against {theirs:?}");
                    assert!((ours.normal - theirs.normal).length() <= 1e-14, "{ours:?} against {theirs:?}");
                }
                (ours, theirs) => assert_eq!(ours, theirs, "from {source} to {target}"),
            }
        }
    }
    // A segment in the plane and a point in either space, met head-on and missed.
    let stick = Faceted::hull_of([DVec2::new(-1.0, 1.0), DVec2::new(1.0, 1.0)]).unwrap();
    let hit = crossing_of(&stick, DVec2::new(0.5, -1.0), DVec2::Y).expect("head-on");
    assert_eq!((hit.entry, hit.exit, hit.normal), (2.0, 2.0, DVec2::NEG_Y));
    assert_eq!(crossing_of(&stick, DVec2::new(1.5, -1.0), DVec2::Y), None);
    let dot = Faceted::hull_of([DVec3::ONE, DVec3::ONE]).unwrap();
    assert_eq!(crossing_of(&dot, DVec3::new(1.0, 1.0, -1.0), DVec3::Z).map(|hit| hit.entry), Some(2.0));
    assert_eq!(crossing_of(&dot, DVec3::new(1.0, 1.5, -1.0), DVec3::Z), None);
    let rod = Faceted::hull_of([DVec3::ZERO, DVec3::new(1.0, 2.0, 2.0)]).unwrap();
    let along = crossing_of(&rod, DVec3::new(-1.0, -2.0, -2.0), DVec3::new(1.0, 2.0, 2.0)).expect("along it");
    assert_eq!((along.entry, along.exit), (1.0, 2.0));
}

#[test]
fn what_is_no_line_has_no_crossing() {
    let hull = Faceted::hull_of([DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_ONE]).unwrap();
    let source = DVec3::new(4.0, 0.25, 0.5);
    assert!(crossing_of(&hull, source, -source).is_some());
    assert_eq!(crossing_of(&hull, source, DVec3::ZERO), None);
    assert_eq!(crossing_of(&hull, DVec3::ZERO, DVec3::ZERO), None);
    for i in 0..3 {
        let broken = |v: DVec3| DVec3::from_fn(|k| if k == i { f64::NAN } else { v[k] });
        assert_eq!(crossing_of(&hull, broken(source), -source), None);
        assert_eq!(crossing_of(&hull, source, broken(-source)), None);
    }
}

/// A power of two changes no digit of λ but the power.
#[test]
fn directions_may_have_any_length() {
    let hull = Faceted::hull_of([DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_ONE]).unwrap();
    let source = DVec3::new(4.0, 0.25, 0.5);
    let unit = crossing_of(&hull, source, -source).expect("a hit");
    for power in [-1000, -700, -511, -1, 1, 511, 700, 1000] {
        let scale = 2f64.powi(power);
        let crossing = crossing_of(&hull, source, -source * scale).expect("a hit");
        assert_eq!(
            (crossing.entry * scale, crossing.exit * scale, crossing.normal),
            (unit.entry, unit.exit, unit.normal)
        );
    }
}

/// Also where the middle is not zero, and in a pose; a flat hull has no inside to be sure of.
#[test]
fn rays_at_facets_are_certain_without_a_search() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let hull = Faceted::hull_of(corners).unwrap();
    let (source, direction) = (DVec3::splat(0.2) - DVec3::Z * 3.0, DVec3::Z);
    let bounds_of = |shape: &dyn SupportMap<Vector = DVec3>, source: DVec3| match shape
        .certain_crossing(LineQuery::new(source, direction))
    {
        Some(CertainCrossing::Enters { bounds, .. }) => Some(bounds),
        _ => None,
    };
    let [earliest, latest] = bounds_of(&hull, source).expect("a hit");
    assert!(earliest <= 2.8 && 2.8 <= latest && latest - earliest < 1e-13, "{earliest} {latest}");
    let posed = Posed::new(hull, DQuat::from_rotation_z(0.25), DVec3::new(9.0, 0.0, 0.0)).unwrap();
    let aside = posed.rotation() * DVec3::new(0.2, 0.2, -3.0) + posed.translation();
    let [earliest, latest] = bounds_of(&posed, aside).expect("a hit");
    assert!(earliest <= 3.0 && 3.0 <= latest && latest - earliest < 1e-12, "{earliest} {latest}");
    assert_eq!(bounds_of(&Faceted::hull_of([DVec3::ZERO, DVec3::X, DVec3::Y]).unwrap(), source), None);
}

/// The facets of points that are in a plane or on a line to rounding bounded nothing aside of them: three of four lines
/// that passed a turned square crossed it, and where no facet had a plane, asking for a certain crossing panicked.
fn flat_and_thin<V: Vector>() {
    let mut state = 7_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    for round in 0..400 {
        let turn = DQuat::from_xyzw(number(), number(), number(), number()).normalize();
        let thick = [0.0, 1e-12, 1e-9, 1e-5][round % 4];
        let wide = [1.0, 0.0, 1e-12, 1e-4][round / 4 % 4];
        let corners = (0..3 + round % 7).map(|_| turn * DVec3::new(number(), number() * wide, number() * thick));
        let corners: Vec<V> = corners.map(|p| V::from_fn(|i| V::Scalar::from_f64(p[i]))).collect();
        let hull = Faceted::hull_of(corners.iter().copied()).unwrap();
        let middle = corners[0];
        let size = corners.iter().map(|&p| (p - middle).norm().as_f64()).fold(0.0, f64::max);
        for _ in 0..8 {
            let vector = |p: DVec3| V::from_fn(|i| V::Scalar::from_f64(p[i]));
            let aside = turn * DVec3::new(number(), number(), thick * number()).normalize() * (3.0 * size);
            let to = vector(DVec3::new(number(), number(), number()));
            let source = middle + vector(aside) - to;
            let _ = hull.certain_crossing(LineQuery::new(source, to));
            if let Some(crossing) = crossing_of(&hull, source, to) {
                for at in [crossing.entry, crossing.exit] {
                    let off = (source + to * at - middle).norm().as_f64();
                    assert!(off <= size * (1.0 + 1e4 * V::Scalar::EPSILON.as_f64()), "{off} of {size}: {corners:?}");
                }
            }
        }
    }
}

#[test]
fn half_spaces_bound_what_is_flat_or_thin() {
    flat_and_thin::<DVec3>();
    flat_and_thin::<Vec3A>();
    flat_and_thin::<DVec2>();
    let (near_a_line, other) =
        (DVec3::new(1.0, 0.0, 0.25320836558803606), DVec3::new(0.7500000000000002, 0.0, 0.1899062741910271));
    let hull = Faceted::hull_of([near_a_line, DVec3::ZERO, other]).unwrap();
    let reaches = |v: DVec3| hull.half_spaces().all(|(n, reach)| n.dot(v) <= reach + 1e-15);
    assert!(reaches(near_a_line) && reaches(other) && !reaches(near_a_line * 1.001) && !reaches(DVec3::Y * 1e-3));
    assert_eq!(hull.certain_crossing(LineQuery::new(DVec3::Y, DVec3::NEG_Y)), None);
}
