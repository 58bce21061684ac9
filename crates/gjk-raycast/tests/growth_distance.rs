//! Growth distances: against the grown bodies themselves, against differences, and what is refused.

use crate::differences::{Body, Comparison, Random, Space, central};
use convex_support::glam::{DVec2, DVec3, Vec3A};
use convex_support::{Affine, Ball, Cuboid, Ellipsoid, Matrix, Point, Posed, Rounded, Segment, SupportMap, Vector};
use gjk_raycast::{
    DistanceOptions, GrowthDistance, GrowthError, GrowthOptions, RigidMotion, SignedDistanceOptions, Smoothness,
    Status, Trajectory, distance, growth_distance, signed_distance,
};

const VALID: &str = "positive sizes and finite numbers";

fn ask<V: Vector>(a: &dyn SupportMap<Vector = V>, b: &dyn SupportMap<Vector = V>, at: [V; 2]) -> GrowthDistance<V> {
    growth_distance(a, at[0], b, at[1], GrowthOptions::new()).expect("centres inside")
}

/// A point in a body: a mean of some of its points; of many, it is far from the boundary.
fn point_in<V: Space>(body: &Body<V>, count: usize, random: &mut Random) -> V {
    let points = (0..count).map(|_| body.shape.support(random.vector(1.0)));
    points.fold(V::ZERO, |sum, point| sum + point / count as f64)
}

fn grown<V: Space>(body: &Body<V>, center: V, scale: f64) -> impl SupportMap<Vector = V> {
    let matrix = V::Matrix::from_cols_fn(|i| V::axis(i) * scale);
    Affine::new(body.shape.clone(), matrix, center * (1.0 - scale)).expect(VALID)
}

fn pairs<V: Space>(mut each: impl FnMut(&Body<V>, &Body<V>, [V; 2], &mut Random, &str)) {
    let mut random = Random(11);
    for (i, kind_a) in V::KINDS.iter().enumerate() {
        for kind_b in &V::KINDS[i..] {
            for overlap in [false, true] {
                let a = Body::random(kind_a, &mut random);
                let b = Body::random(kind_b, &mut random).placed(&a, overlap, &mut random);
                let centers = [point_in(&a, 40, &mut random), point_in(&b, 40, &mut random)];
                each(&a, &b, centers, &mut random, &format!("{kind_a}-{kind_b}, {overlap}"));
            }
        }
    }
}

/// Grown by the lower bound they are not yet in overlap, by the upper one they are no more apart; grown by the scale,
/// the point is in both and the normal parts them. Bodies apart have to grow and bodies in overlap to shrink, and in
/// the other order they are asked alike.
fn touch_at_their_scale<V: Space>() {
    pairs::<V>(|a, b, at @ [center_a, center_b], _, what| {
        let answer = ask(&a.shape, &b.shape, at);
        let GrowthDistance { scale, lower, upper, point, normal, status, .. } = answer;
        assert_eq!(status, Status::Converged, "{what}: {answer:?}");
        assert!(
            lower <= scale && scale <= upper && upper - lower <= 1e-11 * scale * (1.0 + scale),
            "{what}: {answer:?}"
        );
        let gap = |scale| {
            let (a, b) = (grown(a, center_a, scale), grown(b, center_b, scale));
            signed_distance(&a, &b, SignedDistanceOptions::default())
        };
        assert!(gap(lower * (1.0 - 1e-14)).upper >= 0.0, "{what}: they meet before {answer:?}");
        assert!(gap(upper * (1.0 + 1e-14)).lower <= 0.0, "{what}: they are apart after {answer:?}");
        let starts = signed_distance(&a.shape, &b.shape, SignedDistanceOptions::default());
        assert_eq!(scale > 1.0, starts.signed_distance > 0.0, "{what}: {answer:?}");
        for (body, center) in [(a, center_a), (b, center_b)] {
            let there = Point::new(point).expect("finite");
            let off = distance(&grown(body, center, scale), &there, DistanceOptions::default()).distance;
            assert!(off <= 1e-13 * (1.0 + scale), "{what}: the point is off by {off:e}");
        }
        let n = normal.expect("the centres differ");
        let beyond = |body, center, n: V| n.dot(grown(body, center, scale).support(n) - point);
        let past = beyond(a, center_a, -n).max(beyond(b, center_b, n));
        assert!((n.length() - 1.0).abs() < 1e-15 && past < 1e-12 * (1.0 + scale), "{what}: {past:e} past the plane");

        let swapped = ask(&b.shape, &a.shape, [center_b, center_a]);
        assert!((swapped.scale - scale).abs() <= upper - lower, "{what}: {swapped:?} is not {answer:?}");
        let warm = GrowthOptions::new().with_warm_start(answer.warm_start(None));
        let again = growth_distance(&a.shape, center_a, &b.shape, center_b, warm).expect("the same");
        assert!(again.lower <= upper && lower <= again.upper && again.status == Status::Converged, "{what}: {again:?}");
    });
}

#[test]
fn shapes_grown_by_their_scale_touch_in_space() {
    touch_at_their_scale::<DVec3>();
}

#[test]
fn shapes_grown_by_their_scale_touch_in_the_plane() {
    touch_at_their_scale::<DVec2>();
}

fn derivatives_are_those_of_differences<V: Space>() {
    let mut compared = Comparison::default();
    pairs::<V>(|a, b, at @ [center_a, center_b], random, what| {
        let gradient_of = |a: &dyn SupportMap<Vector = V>, answer: GrowthDistance<V>| {
            let features = answer.closest_features(a, &b.shape, at).expect("the centres differ");
            let refined = answer.refined(&features, center_a).gradient(at).expect("the centres differ");
            let plain = answer.gradient(at).expect("the centres differ");
            let off = (plain.a.translation - refined.a.translation).length();
            assert!(off < 1e-4 * (1.0 + refined.a.translation.length()), "{what}: {off:e}");
            (refined, features.smoothness())
        };
        let (gradient, smoothness) = gradient_of(&a.shape, ask(&a.shape, &b.shape, at));
        // The normal of a needle, and so the derivative, is worse by its condition.
        if smoothness != Smoothness::Smooth || what.contains("needle") {
            return;
        }
        let motions: [RigidMotion<V>; 2] = [random.motion(), random.motion()];
        let carried = |t: f64| {
            let centers = [0, 1].map(|i| motions[i].displacement(t).of(at[i]));
            ask(&a.moved(&motions[0], t), &b.moved(&motions[1], t), centers).scale
        };
        let along = motions[0].rate_of(gradient.a) + motions[1].rate_of(gradient.b);
        compared.add(along, central(carried, 1e-3), &|| format!("{what}, carried"));

        let [u, w] = [(a, center_a), (b, center_b)].map(|(body, center)| point_in(body, 5, random) - center);
        let by_centers = |t: f64| ask(&a.shape, &b.shape, [center_a + u * t, center_b + w * t]).scale;
        let along = gradient.center_a.dot(u) + gradient.center_b.dot(w);
        compared.add(along, central(by_centers, 1e-3), &|| format!("{what}, centres"));

        let rounded = |t: f64| Rounded::new(&a.shape, 0.01 + t).expect(VALID);
        let swept = |t: f64| ask(&rounded(t), &b.shape, at);
        let (by_radius, _) = gradient_of(&rounded(0.0), swept(0.0));
        compared.add(by_radius.radius, central(|t| swept(t).scale, 1e-3), &|| format!("{what}, swept"));
    });
    compared.check();
}

#[test]
fn derivatives_in_space() {
    derivatives_are_those_of_differences::<DVec3>();
}

#[test]
fn derivatives_in_the_plane() {
    derivatives_are_those_of_differences::<DVec2>();
}

/// The scale is a ratio: the unit of length changes no bit of it, and none of the point but its exponent.
#[test]
fn the_unit_of_length_changes_no_bit() {
    let at = |unit: f64| {
        let stone = Ellipsoid::new(DVec3::ZERO, DVec3::new(0.3, 0.7, 1.1) * unit, Default::default()).expect(VALID);
        let a = Posed::translated(stone, DVec3::new(1.0, 0.2, -0.3) * unit).expect(VALID);
        let b = Cuboid::new(DVec3::new(0.4, 0.2, 0.5) * unit).expect(VALID);
        ask(&a, &b, [DVec3::new(1.1, 0.1, -0.2) * unit, DVec3::new(0.1, 0.1, 0.3) * unit])
    };
    let one = at(1.0);
    for exponent in [-300, -40, 17, 300] {
        let unit = f64::from(exponent).exp2();
        let answer = at(unit);
        assert_eq!(answer, GrowthDistance { point: one.point * unit, ..one });
    }
}

/// Two balls, 5 between their centres, whose places have an ulp of 1e-4.
#[test]
fn brackets_hold_in_single_precision_and_far_from_the_origin() {
    let (ball, other) = (Ball::<Vec3A>::new(1.0).expect(VALID), Ball::new(1.5).expect(VALID));
    let (at_a, at_b) = (Vec3A::new(1600.0, 400.0, 16.0), Vec3A::new(1603.0, 404.0, 16.0));
    let [a, b] = [(ball, at_a), (other, at_b)].map(|(ball, at)| Posed::translated(ball, at).expect(VALID));
    let answer = ask(&a, &b, [at_a, at_b]);
    assert!(answer.lower <= 2.0 && 2.0 <= answer.upper && answer.upper - answer.lower < 1e-4, "{answer:?}");
}

#[test]
fn coincident_centres_have_the_scale_zero() {
    let (a, b) = (Cuboid::new(DVec3::ONE).expect(VALID), Ball::new(2.0).expect(VALID));
    let at = DVec3::new(0.5, 0.25, 1.0);
    let answer = ask(&a, &b, [at; 2]);
    assert_eq!((answer.scale, answer.lower, answer.upper, answer.point), (0.0, 0.0, 0.0, at));
    assert_eq!((answer.normal, answer.gradient([at; 2])), (None, None));
    // As they part the scale rises from zero.
    let near = ask(&a, &b, [at, at + DVec3::X * 1e-12]);
    assert!(near.scale > 0.0 && near.scale < 1e-11 && near.status == Status::Converged, "{near:?}");
}

#[test]
fn a_centre_on_the_boundary_is_inside_and_one_outside_is_refused() {
    let a = Cuboid::new(DVec2::new(1.0, 2.0)).expect(VALID);
    let b = Posed::translated(Ball::new(0.5).expect(VALID), DVec2::new(4.0, 0.0)).expect(VALID);
    let ask = |at_a, at_b| growth_distance(&a, at_a, &b, at_b, GrowthOptions::new());
    let answer = ask(DVec2::new(1.0, 0.0), DVec2::new(4.0, 0.0)).expect("on the side");
    // Only the ball grows towards the side: from 4 to 1, by 0.5 for each unit.
    assert!(answer.lower <= 6.0 && 6.0 <= answer.upper && answer.upper - answer.lower < 1e-11, "{answer:?}");

    let outside = |answer| match answer {
        Err(GrowthError::CenterOutside { parameter, distance }) => (parameter, distance),
        other => panic!("{other:?}"),
    };
    for off in [1e-9, 0.5] {
        let (parameter, distance) = outside(ask(DVec2::new(1.0 + off, 0.0), DVec2::new(4.0, 0.0)));
        assert!(parameter == "center_a" && (distance - off).abs() < 1e-14, "{distance:e}");
        let (parameter, distance) = outside(ask(DVec2::ZERO, DVec2::new(4.0, 0.5 + off)));
        assert!(parameter == "center_b" && (distance - off).abs() < 1e-14, "{distance:e}");
    }
    let nan = ask(DVec2::ZERO, DVec2::new(4.0, f64::NAN));
    assert_eq!(nan, Err(GrowthError::NonFinite { parameter: "center_b", index: 1 }));
    // The middle of a bar is beside it by a rounding.
    let [from, to] = [DVec2::new(0.1, 0.3), DVec2::new(0.7, 0.2)];
    let bar = Segment::new([from, to]).expect(VALID);
    let answer = growth_distance(&bar, (from + to) / 2.0, &a, DVec2::ZERO, GrowthOptions::new());
    assert!(answer.is_ok_and(|answer| answer.status == Status::Converged));
}

/// Two points never meet, nor do two plates of which each grows away from the other: no upper bound is claimed.
#[test]
fn where_no_scale_will_do_none_is_claimed() {
    let plate = |x| Posed::translated(Cuboid::new(DVec3::new(1.0, 2.0, 2.0)).expect(VALID), DVec3::X * x);
    let (left, right) = (plate(-1.0).expect(VALID), plate(2.0).expect(VALID));
    let (point, other) = (Point::new(DVec3::ZERO).expect(VALID), Point::new(DVec3::X).expect(VALID));
    let at = [DVec3::ZERO, DVec3::X];
    for answer in [ask(&point, &other, at), ask(&left, &right, at)] {
        assert!(answer.upper == f64::INFINITY && answer.status != Status::Converged, "{answer:?}");
        assert!(answer.lower >= 0.0 && answer.lower < f64::INFINITY, "{answer:?}");
        assert_eq!(answer.gradient(at), None);
    }
    // Each towards the other, from the far side: 5 by 2 + 2.
    let towards = ask(&left, &right, [DVec3::X * -2.0, DVec3::X * 3.0]);
    assert!(towards.lower <= 1.25 && 1.25 <= towards.upper && towards.status == Status::Converged, "{towards:?}");
}
