//! Signed distances that are known in closed form or by looking at every facet, and shapes that are none.

use std::cell::Cell;

use crate::common::behind_pointers::signed_distance;
use crate::common::{apart, at, cuboid, s, turned, v};
use convex_support::glam::{DQuat, DVec2, DVec3, Quat, Vec2, Vec3, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cylinder, Ellipsoid, Point, Polytope, Posed, Rounded, Scalar, Segment, SupportMap, Triangle,
    Vector, support_value,
};
use gjk_raycast::{SignedDistance, SignedDistanceOptions, Status, signed_distance_with};

const VALID: &str = "positive sizes";

fn ask<A, B>(a: &A, b: &B) -> SignedDistance<A::Vector>
where
    A: SupportMap,
    B: SupportMap<Vector = A::Vector>,
{
    signed_distance(a, b, SignedDistanceOptions::default())
}

/// The answer is converged, is the truth to a few roundings, and has a bracket as narrow as asked for that holds it.
fn is<V: Vector>(answer: SignedDistance<V>, truth: f64, width: f64) {
    let SignedDistance { signed_distance, lower, upper, status, .. } = answer;
    assert_eq!(status, Status::Converged, "{answer:?}");
    let error = (signed_distance.as_f64() - truth).abs();
    assert!(error <= 16.0 * V::Scalar::EPSILON.as_f64() * (1.0 + truth.abs()), "{truth}: {answer:?}");
    assert!(lower.as_f64() <= truth && truth <= upper.as_f64(), "{truth}: {answer:?}");
    assert!((upper - lower).as_f64() <= width, "{truth}: {answer:?}");
}

#[test]
fn balls_and_capsules_overlap_by_their_radii() {
    let ball = Ball::<DVec3>::new(1.0).expect(VALID);
    let answer = ask(&at(ball, [1.5, 0.0, 0.0]), &ball);
    is(answer, -0.5, 1e-14);
    assert_eq!((answer.normal, answer.point_a), (DVec3::X, DVec3::new(0.5, 0.0, 0.0)));
    is(ask(&ball, &ball), -2.0, 1e-14);

    // Two capsules crossed at a height of 0.3.
    let capsule = Capsule::<DVec3>::new(1.0, 0.25).expect(VALID);
    let across = turned(capsule, DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2), [0.3, 0.0, 0.0]);
    let answer = ask(&across, &capsule);
    is(answer, -0.2, 2e-14);
    assert!((answer.normal - DVec3::X).length() < 1e-15, "{answer:?}");
}

#[test]
fn boxes_leave_through_the_nearest_face() {
    let answer = ask(&at(cuboid::<DVec3>([1.0, 1.0, 1.0]), [0.5, 1.75, 0.25]), &cuboid([1.0, 1.0, 1.0]));
    is(answer, -0.25, 1e-14);
    assert_eq!(answer.normal, DVec3::Y);
    assert!((answer.point_a - answer.point_b + DVec3::Y * 0.25).length() < 1e-15, "{answer:?}");
    // Edge against edge: each leans by a quarter turn about another axis.
    let lean = |axis: DVec3| DQuat::from_axis_angle(axis, std::f64::consts::FRAC_PI_4);
    let (root, depth) = (2.0_f64.sqrt(), 0.125);
    let below = turned(cuboid::<DVec3>([1.0, 1.0, 1.0]), lean(DVec3::X), [0.0; 3]);
    let above = turned(cuboid::<DVec3>([1.0, 1.0, 1.0]), lean(DVec3::Z), [0.0, 2.0 * root - depth, 0.0]);
    is(ask(&above, &below), -depth, 1e-13);
    // In the plane.
    is(ask(&at(cuboid::<DVec2>([1.0, 0.5, 0.0]), [0.25, 0.75, 0.0]), &cuboid([1.0, 0.5, 0.0])), -0.25, 1e-14);
}

#[test]
fn curved_shapes_have_a_narrow_bracket_too() {
    // The ellipsoid reaches 0.5 along x, the shortest way out.
    let ellipsoid = Ellipsoid::new(DVec3::ZERO, DVec3::new(0.5, 1.0, 2.0), DQuat::IDENTITY).expect(VALID);
    is(ask(&ellipsoid, &at(cuboid([3.0, 4.0, 5.0]), [3.25, 0.0, 0.0])), -0.25, 2e-8);
    // A cylinder lies on the ground, a bit deep; another stands on it.
    let ground = cuboid::<DVec3>([5.0, 1.0, 5.0]);
    let cylinder = Cylinder::<DVec3>::new(1.0, 0.5).expect(VALID);
    let lying = turned(cylinder, DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2), [0.3, 1.45, 0.2]);
    is(ask(&lying, &ground), -0.05, 2e-8);
    is(ask(&at(cylinder, [0.0, 1.875, 0.0]), &ground), -0.125, 1e-13);
    let rounded = Rounded::new(cuboid::<DVec3>([0.5, 0.5, 0.5]), 0.25).expect(VALID);
    is(ask(&at(rounded, [0.0, 1.625, 0.0]), &ground), -0.125, 1e-13);
}

#[test]
fn small_gaps_above_large_floors_are_known_in_single_precision() {
    for half in [50.0, 500.0, 5000.0] {
        for gap in [1e-5, 1e-4, 1e-3, -1e-5, -1e-3] {
            let height: Vec3A = v([0.25, 0.5 + gap, -0.125]);
            let parcel = Posed::translated(cuboid::<Vec3A>([0.5, 0.5, 0.5]), height).expect("finite");
            let answer = ask(&parcel, &at(cuboid::<Vec3A>([half, 1.0, half]), [0.0, -1.0, 0.0]));
            let truth = f64::from(height.y) - 0.5;
            assert!((f64::from(answer.signed_distance) - truth).abs() < 5e-7, "{half} {gap}: {answer:?}");
            assert!(f64::from(answer.lower) <= truth && truth <= f64::from(answer.upper), "{half} {gap}: {answer:?}");
            assert!((answer.normal - Vec3A::Y).length() < 1e-6, "{half} {gap}: {answer:?}");
        }
    }
}

#[test]
fn the_unit_of_length_does_not_matter() {
    let points = |unit: f64| {
        [[0.9, 0.1, 0.2], [-0.7, 0.3, 0.1], [0.2, -0.8, 0.4], [0.1, 0.2, -0.9], [-0.3, 0.4, 0.8]]
            .map(|p| v::<DVec3>(p) * unit)
    };
    let pair = |unit: f64| {
        let a = Polytope::new(points(unit)).expect("points");
        let b = Cylinder::<DVec3>::new(0.7 * unit, 0.4 * unit).expect(VALID);
        ask(&a, &at(b, [0.3 * unit, 0.2 * unit, 0.1 * unit]))
    };
    let one = pair(1.0);
    for power in [-300, -40, 3, 200] {
        let unit = 2.0_f64.powi(power);
        let answer = pair(unit);
        assert_eq!(answer.signed_distance, one.signed_distance * unit, "2^{power}");
        assert_eq!((answer.lower, answer.upper), (one.lower * unit, one.upper * unit), "2^{power}");
        assert_eq!((answer.normal, answer.iterations), (one.normal, one.iterations), "2^{power}");
    }
}

/// The least support value of `A − B` along the normal of any plane that can be of a facet of it: of three points of
/// one, or along an edge of each.
fn least_of_all_facets(a: &[DVec3], b: &[DVec3]) -> f64 {
    let edges = |points: &[DVec3]| -> Vec<DVec3> {
        (0..points.len()).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| points[i] - points[j]).collect()
    };
    let (of_a, of_b) = (edges(a), edges(b));
    let pairs = [(&of_a, &of_a), (&of_b, &of_b), (&of_a, &of_b)];
    let normals = pairs.into_iter().flat_map(|(p, q)| p.iter().flat_map(|p| q.iter().map(|q| p.cross(*q))));
    let reach = |points: &[DVec3], n: DVec3| points.iter().map(|p| n.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
    let depths = normals.filter_map(DVec3::try_normalize).flat_map(|n| [n, -n]).map(|n| reach(a, n) + reach(b, -n));
    depths.fold(f64::INFINITY, f64::min)
}

#[test]
fn polytopes_leave_through_the_nearest_of_all_facets() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut uniform = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / 2.0_f64.powi(52) - 1.0
    };
    let mut deep = 0;
    for round in 0..400 {
        let mut cloud = || -> Vec<DVec3> {
            let thin = if round % 2 == 0 { 1.0 } else { 10.0_f64.powf(-3.0 * uniform().abs()) };
            let offset = DVec3::new(uniform(), uniform(), uniform()) * 0.5;
            (0..6).map(|_| DVec3::new(uniform(), uniform(), uniform() * thin) + offset).collect()
        };
        let (a, b) = (cloud(), cloud());
        let answer = ask(&Polytope::new(a.clone()).expect("points"), &Polytope::new(b.clone()).expect("points"));
        let depth = least_of_all_facets(&a, &b);
        if depth > 0.0 {
            deep += 1;
            is(answer, -depth, 1e-13);
        } else {
            assert!(answer.lower > -1e-14 && !answer.upper.is_sign_negative(), "{depth} {answer:?}");
        }
    }
    assert!(deep > 150, "most overlap, but {deep}");
}

#[test]
fn flat_and_identical_shapes_have_an_answer() {
    let cube = cuboid::<DVec3>([1.0, 1.0, 1.0]);
    is(ask(&cube, &cube), -2.0, 1e-13);
    let plate = cuboid::<DVec3>([1.0, 1.0, 0.0]);
    is(ask(&plate, &plate), 0.0, 1e-13);
    is(ask(&plate, &cube), -1.0, 1e-13);
    let point = Point::new(DVec3::ZERO).expect("finite");
    is(ask(&point, &point), 0.0, 1e-13);
    is(ask(&point, &cube), -1.0, 1e-13);
    let segment = Segment::new([DVec3::NEG_X, DVec3::X]).expect("finite");
    is(ask(&segment, &segment), 0.0, 1e-13);
    is(ask(&segment, &plate), 0.0, 1e-13);
    let triangle = Triangle::new([DVec3::ZERO, DVec3::X, DVec3::Y]).expect("finite");
    is(ask(&triangle, &triangle), 0.0, 1e-13);
    is(ask(&cuboid::<Vec3>([1.0, 1.0, 1.0]), &cuboid([1.0, 1.0, 1.0])), -2.0, 1e-5);
}

#[test]
fn ties_end_with_a_bracket() {
    // A circle of ways out is as short, and no facet is of the boundary.
    let [long, flat] = [DVec3::new(1.0, 1.0, 1.5), DVec3::new(1.0, 1.0, 2.0)]
        .map(|semi_axes| Ellipsoid::new(DVec3::ZERO, semi_axes, DQuat::IDENTITY).expect(VALID));
    let answer = ask(&long, &flat);
    assert_eq!((answer.status, answer.iterations), (Status::IterationLimit, 500));
    assert!(answer.lower <= -2.0 && -2.0 <= answer.upper && answer.upper < -1.999, "{answer:?}");
    assert!((answer.signed_distance + 2.0).abs() < 1e-14, "{answer:?}");
}

/// Every direction is as good as any other, but nothing is left of a ball without the one that rolls within it.
#[test]
fn a_ball_given_as_an_ellipsoid_is_one() {
    let ball = Ellipsoid::new(DVec3::ZERO, DVec3::ONE, DQuat::IDENTITY).expect(VALID);
    let answer = ask(&ball, &ball);
    is(answer, -2.0, 1e-13);
    assert!(answer.iterations < 20, "{answer:?}");
    is(ask(&ball, &at(ball, [0.0, 1.0, 0.0])), -1.0, 1e-13);
    is(ask(&ball, &cuboid([1.0, 1.0, 1.0])), -2.0, 1e-13);
}

#[test]
fn limits_end_the_search_early() {
    let cube = cuboid::<DVec3>([1.0, 1.0, 1.0]);
    let apart = at(cube, [5.0, 0.1, 0.2]);
    let near = signed_distance(&cube, &apart, SignedDistanceOptions::default().with_limit(1.0));
    assert!(near.lower > 1.0 && near.lower <= 3.0 && near.upper >= 3.0, "{near:?}");
    let ball = Ellipsoid::new(DVec3::ZERO, DVec3::ONE, DQuat::IDENTITY).expect(VALID);
    let deep = signed_distance(&ball, &ball, SignedDistanceOptions::default().with_depth_limit(1.0));
    assert!(deep.upper < -1.0 && deep.iterations < 50, "{deep:?}");
    let few = signed_distance(&ball, &cube, SignedDistanceOptions::default().with_max_iterations(8));
    assert_eq!(few.status, Status::IterationLimit);
    assert!(few.lower <= -2.0 && few.upper >= -2.0, "{few:?}");
}

#[test]
fn an_observer_sees_the_bounds_close() {
    let cylinder = Cylinder::<DVec3>::new(0.5, 0.3).expect(VALID);
    let mut gaps = Vec::new();
    let answer =
        signed_distance_with(&cylinder, &at(cylinder, [0.1, 0.2, 0.3]), SignedDistanceOptions::default(), |i| {
            gaps.push(i.upper - i.lower);
        });
    assert!(gaps.len() > 5 && gaps.len() <= answer.iterations, "{} {answer:?}", gaps.len());
    assert!(gaps.last().is_some_and(|&gap| gap < 1e-6), "{gaps:?}");
}

/// A support map that says whatever it likes.
struct Liar<F>(F, Cell<u32>);

impl<F: Fn(DVec3, u32) -> DVec3> SupportMap for Liar<F> {
    type Vector = DVec3;

    fn support(&self, direction: DVec3) -> DVec3 {
        self.1.set(self.1.get() + 1);
        (self.0)(direction, self.1.get())
    }
}

#[test]
fn shapes_that_are_none_end_the_search() {
    let cube = cuboid::<DVec3>([1.0, 1.0, 1.0]);
    let check = |lie: &dyn Fn(DVec3, u32) -> DVec3| {
        let answer = ask(&Liar(lie, Cell::new(0)), &cube);
        assert!(answer.lower <= answer.upper && !answer.signed_distance.is_nan(), "{answer:?}");
        assert!((answer.normal.length() - 1.0).abs() < 1e-14, "{answer:?}");
    };
    check(&|_, _| DVec3::NAN);
    check(&|d, _| d * f64::INFINITY);
    check(&|d, _| -DVec3::ONE.copysign(d));
    check(&|d, n| d * f64::from(n * 7919 % 13) + DVec3::new(f64::from(n * 31 % 7), f64::from(n * 17 % 5), 0.3));
    for k in 1..40 {
        check(&|d, n| if n == k { DVec3::NAN } else { DVec3::ONE.copysign(d) * s::<DVec3>(1.0) });
        check(&|d, n| if n == k { DVec3::ZERO } else { DVec3::new(3.0, 2.0, 1.0).copysign(d) });
    }
}

/// Both points are in their shapes, but for a part of the size that is left of the difference of where they should be.
fn points_are_of_the_shapes<V, A, B>(a: &A, b: &B, error: f64)
where
    V: Vector,
    A: SupportMap<Vector = V>,
    B: SupportMap<Vector = V>,
{
    answered_points_are_of_the_shapes(a, b, ask(a, b), error);
}

fn answered_points_are_of_the_shapes<V, A, B>(a: &A, b: &B, answer: SignedDistance<V>, error: f64)
where
    V: Vector,
    A: SupportMap<Vector = V>,
    B: SupportMap<Vector = V>,
{
    let SignedDistance { signed_distance, lower, upper, normal, point_a, point_b, .. } = answer;
    let [core_a, core_b] = [a.core(), b.core()];
    let size = core_a.extent + core_a.radius + core_b.extent + core_b.radius + (core_a.origin - core_b.origin).norm();
    let lean = (2.0 * (size * (upper - lower)).as_f64()).sqrt();
    let rest = (point_a - point_b - normal * signed_distance).norm().as_f64();
    assert!(rest <= error + lean, "{rest:e} of {lean:e} {answer:?}");
    let off = |shape: &dyn SupportMap<Vector = V>, point: V| {
        let point = Point::new(point).expect("a finite point");
        gjk_raycast::distance(shape, &point, gjk_raycast::DistanceOptions::default()).distance.as_f64()
    };
    let off = [off(a, point_a), off(b, point_b)];
    assert!(off[0] <= error && off[1] <= error, "{point_a:?} and {point_b:?} are off by {off:?}");
}

/// Of several ways out that are as short, the best one and the nearest facet may be two. The points were half of the
/// size away then, on neither shape.
#[test]
fn about_one_center_the_points_are_of_the_way_out() {
    let cylinder = Cylinder::<DVec3>::new(2.0, 2.5).expect(VALID);
    let cone = Cone::<DVec3>::new(0.003, 0.01).expect(VALID);
    points_are_of_the_shapes(&cylinder, &cone, 1e-9);
    points_are_of_the_shapes(&cone, &cuboid::<DVec3>([9.0; 3]), 1e-9);
    let ellipse = Ellipsoid::<DVec2>::new(DVec2::ZERO, DVec2::new(0.5, 0.005), 0.12).expect(VALID);
    points_are_of_the_shapes(&ellipse, &cuboid::<DVec2>([0.6, 1.0, 0.0]), 1e-9);
    let ellipse = Ellipsoid::<Vec2>::new(Vec2::ZERO, Vec2::new(0.12, 0.81), 0.0).expect(VALID);
    points_are_of_the_shapes(&ellipse, &cuboid::<Vec2>([7.8e-5, 0.46, 0.0]), 1e-5);
}

/// Nearly tied ways out of curved bodies: the facet nearest to zero is far from the end of the shortest way, and that
/// end is between support points of which the polytope has few. Half of the vector from the facet's point to the end
/// was added to one point and taken from the other, so that both were as far outside their bodies as that is long, up
/// to 0.4 sizes; and where the way was only known to the root of rounding, so were the points. The end is looked for
/// among weighted sums of support points now, which are in the bodies.
#[test]
fn points_of_nearly_tied_ways_out_are_of_the_shapes() {
    let ellipsoid = |axes: [f64; 3]| Ellipsoid::new(DVec3::ZERO, DVec3::from(axes), DQuat::IDENTITY).expect(VALID);
    let near_sphere = at(ellipsoid([0.65, 0.7, 0.7]), [0.0, 0.0, 0.08]);
    let bodies: [&dyn SupportMap<Vector = DVec3>; 4] = [
        &Cylinder::new(1.2, 1.1).expect(VALID),
        &Cone::new(0.7, 1.2).expect(VALID),
        &cuboid([1.1, 1.0, 1.0]),
        &ellipsoid([0.5, 0.9, 0.5]),
    ];
    for body in bodies {
        points_are_of_the_shapes(&near_sphere, &body, 1e-14);
        points_are_of_the_shapes(&body, &near_sphere, 1e-14);
        // Coaxial, and turned to no axis.
        let along = turned(body, DQuat::IDENTITY, [0.0, 0.3, 0.0]);
        points_are_of_the_shapes(&along, &bodies[0], 1e-14);
        let turn = DQuat::from_xyzw(0.1, -0.5, 0.7, 0.4).normalize();
        points_are_of_the_shapes(&turned(body, turn, [0.05, 0.0, -0.1]), &bodies[1], 1e-14);
    }
}

/// A search that is given up early knows no end of a shortest way. Its points are in the shapes all the same, and what
/// is told of their distance and direction is of them.
#[test]
fn points_of_searches_that_are_given_up_are_of_the_shapes() {
    let cone = Cone::<DVec3>::new(1.0, 0.6).expect(VALID);
    let turn = DQuat::from_xyzw(0.3, 0.5, -0.2, 0.7).normalize();
    let ellipsoid = Ellipsoid::new(DVec3::new(0.2, 0.4, 0.1), DVec3::new(0.9, 0.7, 0.5), turn).expect(VALID);
    for most in 1..40 {
        let options = SignedDistanceOptions::default().with_max_iterations(most);
        let answer = signed_distance(&cone, &ellipsoid, options);
        answered_points_are_of_the_shapes(&cone, &ellipsoid, answer, 1e-14);
        let deep = signed_distance(&cone, &ellipsoid, options.with_depth_limit(0.02));
        answered_points_are_of_the_shapes(&cone, &ellipsoid, deep, 1e-14);
    }
}

/// A point beside a face, at a distance that rounding leaves open. The nearest facet of the polytope is a sliver
/// through zero, and no corner of it is near; GJK's closest points are.
#[test]
fn points_of_shapes_that_barely_touch_are_of_the_shapes() {
    let point = turned(
        Point::<DVec3>::new(DVec3::new(1.4974094611658168e-5, -6.098712983999615e-6, 0.5528252384774103)).expect(VALID),
        DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2),
        [-0.24957898934573977, 0.5468838870421859, -0.00593524677109232],
    );
    let lean = DQuat::from_xyzw(-5.439185209584097e-9, 4.738993607964602e-9, 6.925113994694403e-9, 1.0);
    let bar = turned(cuboid([0.5941347914072728, 0.005941347914072728, 0.005941347914072728]), lean, [0.0; 3]);
    points_are_of_the_shapes(&point, &bar, 1e-14);
}

/// A point that touches a rim or an apex, or is hardly deeper: a bracket as narrow as the tolerance of 1e-9 sizes says
/// nothing about so short a way, and the search ended there, with any plane that GJK had left, before a step was taken
/// towards the bottom.
#[test]
fn points_on_rims_and_apexes_are_as_deep_as_they_are() {
    let cylinder = Cylinder::<DVec3>::new(0.5, 2.0).expect(VALID);
    let cone = Cone::<DVec3>::new(2.0, 0.5).expect(VALID);
    let point = |at: DVec3| Point::new(at).expect("finite");
    let check = |shape: &dyn SupportMap<Vector = DVec3>, spot: DVec3, depth: f64| {
        let there = DVec3::new(-0.26, 1.75, 3.8);
        let answer = ask(&Posed::translated(shape, there).expect("finite"), &point(there + spot));
        let error = (answer.signed_distance + depth).abs();
        assert!(error < 1e-14 + 1e-4 * depth, "{depth:e} deep at {spot}: {answer:?}");
        assert!(
            answer.lower <= -depth + 2e-15 && -depth - 2e-15 <= answer.upper,
            "{depth:e} deep at {spot}: {answer:?}"
        );
    };
    for i in 0..40 {
        let (sine, cosine) = (0.1 + 0.15 * f64::from(i)).sin_cos();
        let around = DVec3::new(cosine, 0.0, sine);
        check(&cylinder, around * 2.0 + DVec3::Y * 0.5, 0.0);
        check(&cone, around * 0.5 - DVec3::Y * 2.0, 0.0);
        // On the slant, between rim and apex.
        check(&cone, around * 0.25, 0.0);
    }
    check(&cone, DVec3::Y * 2.0, 0.0);
    // A little above the base, an ordinary way in from the side.
    for depth in [1e-9, 1e-7, 1e-5] {
        check(&cone, DVec3::new(0.1, depth - 2.0, 0.2), depth);
        check(&cylinder, DVec3::new(0.1, 0.5 - depth, 0.2), depth);
    }
}

/// Two rounded bodies whose inner bodies nearly touch are deep in one another, and the way between these is as short as
/// their rounding: its direction was off by up to 0.1 in single precision. The normal is that of the plane that proves
/// the lower bound, as that of a distance is.
#[test]
fn the_normal_is_that_of_the_plane_that_proves_the_bound() {
    for i in 0..200 {
        let [s, t] = [0.0005, 0.0003].map(|s| s * f64::from(i));
        let a = Ellipsoid::<DVec3>::new(DVec3::ZERO, DVec3::new(0.5, 0.75, 1.25), DQuat::IDENTITY).expect(VALID);
        let offset = Vec3::new(0.6 + s as f32, 0.5 - t as f32, 0.7);
        let single = Ellipsoid::<Vec3>::new(Vec3::ZERO, Vec3::new(0.5, 0.75, 1.25), Quat::IDENTITY).expect(VALID);
        let (b, exact) = (at(single, offset.as_dvec3().to_array()), at(a, offset.as_dvec3().to_array()));
        let found = signed_distance(&single, &b, SignedDistanceOptions::default());
        let known = signed_distance(&a, &exact, SignedDistanceOptions::default());
        let plane = -(support_value(&single, -found.normal) + support_value(&b, found.normal));
        assert!(plane >= found.lower - 8.0 * f32::EPSILON, "{plane} {found:?}");
        let angle = found.normal.as_dvec3().cross(known.normal).length();
        assert!(angle < 2e-3, "{angle:e} {found:?}");
    }
}

/// Both are readings of one search, so that neither knows of a gap more than the other does.
#[test]
fn a_distance_is_known_as_well_as_a_signed_one() {
    let cylinder = Cylinder::<DVec3>::new(0.5, 0.25).expect(VALID);
    for height in [4.0, 1.5, 1.125, 1.0625, 1.0, 0.75] {
        let cone = at(Cone::<DVec3>::new(0.5, 0.25).expect(VALID), [0.25, height, 0.125]);
        let (apart, signed) = (apart(&cylinder, &cone), ask(&cylinder, &cone));
        assert_eq!((apart.lower, apart.upper), (signed.lower.max(0.0), signed.upper.max(0.0)), "at {height}");
        assert_eq!(apart.overlap, signed.overlap, "at {height}");
    }
}
