//! Contact manifolds.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use crate::common::behind_pointers::distance;
use crate::common::{at, cuboid, turned};
use convex_support::glam::{DQuat, DVec2, DVec3, Vec3A};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cylinder, Ellipsoid, Matrix, Point, Polytope, Posed, Rotation, Rounded, Scalar,
    Segment, SupportMap, Triangle, Vector, closest_point, glam,
};
use gjk_raycast::{
    Contact, Ray, RayCastOptions, RigidMotion, SignedDistanceOptions, contact, contact_after, ray_cast, signed_distance,
};

const VALID: &str = "positive sizes";

fn touch<V, A, B>(a: &A, b: &B) -> Contact<V>
where
    V: Vector,
    A: SupportMap<Vector = V>,
    B: SupportMap<Vector = V>,
{
    contact(a, b, V::Scalar::default(), SignedDistanceOptions::default()).expect("they touch")
}

/// So many points, each as deep as given, in both shapes' places along the normal.
fn has<V: Vector<Scalar = f64>>(contact: &Contact<V>, count: usize, depth: f64) {
    assert_eq!(contact.points().len(), count, "{contact:?}");
    for point in contact.points() {
        assert!((point.signed_distance + depth).abs() < 1e-9, "{contact:?}");
        let apart = point.point_a - point.point_b - contact.normal * point.signed_distance;
        assert!(apart.norm() < 1e-12, "{contact:?}");
    }
}

fn floor() -> Posed<convex_support::Cuboid<DVec3>> {
    at(cuboid([5.0, 1.0, 5.0]), [0.0, -1.0, 0.0])
}

#[test]
fn faces_edges_and_vertices_touch_the_floor() {
    let unit = cuboid::<DVec3>([0.5, 0.5, 0.5]);
    has(&touch(&at(unit, [0.0, 0.49, 0.0]), &floor()), 4, 0.01);
    let edge = DQuat::from_rotation_z(FRAC_PI_4);
    has(&touch(&turned(unit, edge, [0.0, 0.5_f64.sqrt() - 0.01, 0.0]), &floor()), 2, 0.01);
    let vertex = DQuat::from_rotation_arc(DVec3::ONE.normalize(), DVec3::NEG_Y);
    has(&touch(&turned(unit, vertex, [0.0, 0.75_f64.sqrt() - 0.01, 0.0]), &floor()), 1, 0.01);
    // Only what is above the floor carries.
    let over = touch(&at(unit, [5.0, 0.49, 0.2]), &floor());
    has(&over, 4, 0.01);
    assert!(over.points().iter().all(|p| p.point_b.x <= 5.0), "{over:?}");
}

#[test]
fn edges_that_cross_touch_in_a_point() {
    let unit = cuboid::<DVec3>([0.5, 0.5, 0.5]);
    let below = turned(unit, DQuat::from_rotation_x(FRAC_PI_4), [0.0; 3]);
    let above = turned(unit, DQuat::from_rotation_z(FRAC_PI_4), [0.0, 2.0_f64.sqrt() - 0.02, 0.0]);
    has(&touch(&above, &below), 1, 0.02);
}

#[test]
fn round_shapes_touch_where_they_carry() {
    has(&touch(&at(Ball::<DVec3>::new(0.5).expect(VALID), [0.0, 0.49, 0.0]), &floor()), 1, 0.01);
    let capsule = Capsule::<DVec3>::new(0.5, 0.25).expect(VALID);
    let lying = DQuat::from_rotation_z(FRAC_PI_2);
    has(&touch(&turned(capsule, lying, [0.0, 0.24, 0.0]), &floor()), 2, 0.01);
    has(&touch(&at(capsule, [0.0, 0.74, 0.0]), &floor()), 1, 0.01);
    let cylinder = Cylinder::<DVec3>::new(0.5, 0.25).expect(VALID);
    has(&touch(&at(cylinder, [0.0, 0.49, 0.0]), &floor()), 4, 0.01);
    has(&touch(&turned(cylinder, lying, [0.0, 0.24, 0.0]), &floor()), 2, 0.01);
    has(&touch(&at(Cone::<DVec3>::new(0.5, 0.25).expect(VALID), [0.0, 0.49, 0.0]), &floor()), 4, 0.01);
    let rounded = Rounded::new(cuboid::<DVec3>([0.4, 0.4, 0.4]), 0.1).expect(VALID);
    has(&touch(&at(rounded, [0.0, 0.49, 0.0]), &floor()), 4, 0.01);
    let sheared = glam::DMat3::from_cols(DVec3::X, DVec3::new(0.3, 1.0, 0.0), DVec3::Z);
    let affine = Affine::new(cuboid::<DVec3>([0.5, 0.5, 0.5]), sheared, DVec3::new(0.0, 0.49, 0.0)).expect("finite");
    assert!(Matrix::is_finite(&sheared), "a map");
    has(&touch(&affine, &floor()), 4, 0.01);
}

#[test]
fn polygons_keep_four_corners_that_span_them() {
    let prism = |count: u32| {
        let corner = move |i: u32, y: f64| {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(i) / f64::from(count)).sin_cos();
            DVec3::new(cosine, y, sine)
        };
        Polytope::new((0..count).flat_map(move |i| [corner(i, 0.0), corner(i, 1.0)])).expect("points")
    };
    for count in [5, 12, 40] {
        let contact = touch(&at(prism(count), [0.0, -0.01, 0.0]), &floor());
        has(&contact, 4, 0.01);
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| contact.points()[i].point_a);
        // The first two are a diagonal, the others on either side.
        let area = (b - a).cross(d - c).length() / 2.0;
        assert!(area > 1.2, "{count}: {area} {contact:?}");
    }
}

#[test]
fn in_the_plane_there_are_two_points() {
    let ground = at(cuboid::<DVec2>([5.0, 1.0, 0.0]), [0.0, -1.0, 0.0]);
    has(&touch(&at(cuboid::<DVec2>([0.5, 0.5, 0.0]), [4.8, 0.49, 0.0]), &ground), 2, 0.01);
    has(&touch(&at(Ball::<DVec2>::new(0.5).expect(VALID), [0.0, 0.49, 0.0]), &ground), 1, 0.01);
}

#[test]
fn farther_than_asked_there_is_no_contact() {
    let above = at(cuboid::<DVec3>([0.5, 0.5, 0.5]), [0.0, 0.6, 0.0]);
    assert_eq!(contact(&above, &floor(), 0.05, SignedDistanceOptions::default()), None);
    let near = contact(&above, &floor(), 0.2, SignedDistanceOptions::default()).expect("within 0.2");
    has(&near, 4, -0.1);
}

#[test]
fn numbers_of_features_stay_while_shapes_move_a_little() {
    let unit = cuboid::<DVec3>([0.5, 0.5, 0.5]);
    let numbers = |x: f64, angle: f64| {
        let moved =
            turned(unit, DQuat::from_euler(glam::EulerRot::XYZ, angle, 0.5 * angle, -angle), [x, 0.999, 0.5 * x]);
        let mut numbers: Vec<_> = touch(&moved, &unit).points().iter().map(|p| (p.feature_a, p.feature_b)).collect();
        numbers.sort_unstable();
        numbers
    };
    let first = numbers(0.0, 0.0);
    for (x, angle) in [(1e-4, 0.0), (-1e-4, 1e-5), (1e-3, -1e-4), (-1e-3, 1e-4)] {
        assert_eq!(numbers(x, angle), first, "{x} {angle}");
    }
}

/// Seen nearly from its end a segment is steep, and where it is in the plane of contact is rounding: its height there
/// was one far beyond the capsule's end.
#[test]
fn a_capsule_seen_from_its_end_is_no_deeper_than_it_is() {
    let angle = 1.570_132_023_039_958_5;
    let plate = turned(
        cuboid::<DVec2>([0.42611855294446854, 0.007587484491656651, 0.0]),
        angle,
        [-0.615_092_651_148_549_4, 0.000_408_608_417_899_072_26, 0.0],
    );
    let capsule = Capsule::<DVec2>::new(6.074445579211605e-5, 0.6074445579211605).expect(VALID);
    let contact =
        contact(&plate, &turned(capsule, angle, [0.0; 3]), 1e-3, SignedDistanceOptions::default()).expect("they touch");
    assert!(contact.points().iter().all(|p| p.signed_distance >= contact.distance.lower - 1e-15), "{contact:?}");
}

/// What lies within the distance asked for is no feature if it is not nearly flat: from the silhouette of a whole
/// shape, points were made that were on none of them, and the closest were not among these.
#[test]
fn the_closest_points_are_in_every_manifold() {
    let triangle = Triangle::new([DVec2::new(-1.44, 1.84), DVec2::new(0.17, -1.06), DVec2::new(1.18, -1.14)]);
    let triangle = Posed::new(triangle.expect("finite"), -3.8, DVec2::new(-4.0, 2.9)).expect("a pose");
    let segment = Segment::new([DVec2::new(-0.06, 0.72), DVec2::new(1.08, -0.24)]).expect("finite");
    let answer = signed_distance(&triangle, &segment, SignedDistanceOptions::default());
    let far = contact(&triangle, &segment, 4.0, SignedDistanceOptions::default()).expect("within 4");
    let least = far.points().iter().map(|p| p.signed_distance).fold(f64::INFINITY, f64::min);
    assert!((least - answer.signed_distance).abs() < 1e-12, "{least} for {answer:?}: {far:?}");

    let unit = cuboid::<DVec3>([0.5, 0.5, 0.5]);
    let tipped = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.2, 0.5);
    // A pyramid so flat that its base is within the slab behind its apex, upside down.
    let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[x, z]| DVec3::new(x, 0.01, z));
    let pyramid = Polytope::new(corners.into_iter().chain([DVec3::ZERO])).expect("points");
    for within in [0.0, 0.1, 1.0, 10.0] {
        for height in [0.9, 1.2, 3.0] {
            let above = turned(unit, tipped, [0.1, height, 0.0]);
            let Some(found) = contact(&above, &floor(), within, SignedDistanceOptions::default()) else { continue };
            let depth = found.distance.signed_distance;
            let least = found.points().iter().map(|p| p.signed_distance).fold(f64::INFINITY, f64::min);
            assert!((least - depth).abs() < 1e-9, "{within}, {height}: {found:?}");
            for p in found.points() {
                let off = closest_point(&above, p.point_a).map_or(0.0, |q| q.distance(p.point_a));
                assert!(off < 0.05, "{within}, {height}: {off} off the box: {found:?}");
            }
        }
        let touching =
            contact(&at(pyramid.clone(), [0.0, -0.001, 0.0]), &floor(), within, SignedDistanceOptions::default());
        let touching = touching.expect("they touch");
        let least = touching.points().iter().map(|p| p.signed_distance).fold(f64::INFINITY, f64::min);
        assert!((least + 0.001).abs() < 1e-12 && touching.points().len() <= 4, "{touching:?}");
    }
}

/// How far a shape is from a point, along a ray to it from outside along the normal of a contact; negative where the
/// point is inside.
fn above<S: SupportMap<Vector = DVec3> + ?Sized>(shape: &S, point: DVec3, normal: DVec3) -> f64 {
    let ray = Ray { source: point + normal * 8.0, direction: -normal };
    let hit = ray_cast(shape, ray, RayCastOptions::default()).expect("finite").outcome.hit();
    hit.map_or(f64::INFINITY, |hit| hit.lambda - 8.0)
}

/// A face that is slightly bent was taken for the plane through three of its corners: where the surface is at −0.0475
/// the manifold said −0.045. Of hulls one point in three was off by more than a thousandth of the size, and one in
/// twelve was no point of its body. The heights of a point are asked of the bodies now.
#[test]
fn points_are_on_the_bodies_where_faces_are_bent() {
    let base = [[-2.0, -2.0], [-2.0, 2.0], [2.0, -2.0], [2.0, 2.0]];
    let corners = base.into_iter().flat_map(|[x, z]| [DVec3::new(x, 0.005, z), DVec3::new(x, 2.005, z)]);
    let bent = Polytope::new(corners.chain([DVec3::ZERO])).expect("points");
    let cube = at(cuboid::<DVec3>([1.0; 3]), [0.0, -0.95, 0.0]);
    let found = contact(&bent, &cube, 0.1, SignedDistanceOptions::default()).expect("they touch");
    let mut depths: Vec<f64> = found.points().iter().map(|p| p.signed_distance).collect();
    depths.sort_by(f64::total_cmp);
    assert_eq!(depths.len(), 4, "{found:?}");
    for (depth, truth) in depths.iter().zip([-0.05, -0.0475, -0.0475, -0.0475]) {
        assert!((depth - truth).abs() < 1e-14, "{found:?}");
    }

    let mut state = 7_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut points = 0;
    for round in 0..120 {
        let mut hull = || {
            let y = |x: f64| if round % 2 == 0 { x } else { x.signum() * (0.5 + 0.01 * x) };
            let corner = || DVec3::new(number(), y(number()), number());
            Polytope::new(core::iter::repeat_with(corner).take(6 + round % 9)).expect("points")
        };
        let (a, b) = (hull(), hull());
        let b = turned(b, DQuat::from_rotation_y(0.1 * f64::from(round as u32)), [0.2, 0.9, -0.1]);
        let within = [0.0, 0.02, 0.5][round % 3];
        let Some(found) = contact(&a, &b, within, SignedDistanceOptions::default()) else { continue };
        for p in found.points() {
            points += 1;
            // The ray to a point that is on the outline passes the body by rounding.
            let off = [above(&a, p.point_a, -found.normal), above(&b, p.point_b, found.normal)];
            assert!(off.iter().all(|&off| off.abs() <= p.error + 1e-12 || off == f64::INFINITY), "{off:?} {found:?}");
            assert!(p.error < 1e-3 && p.signed_distance >= found.distance.lower - 1e-15, "{found:?}");
            for outside in [
                signed_distance(&Point::new(p.point_a).expect("finite"), &a, Default::default()),
                signed_distance(&Point::new(p.point_b).expect("finite"), &b, Default::default()),
            ] {
                assert!(outside.signed_distance < 1e-12, "{outside:?} {found:?}");
            }
        }
    }
    assert!(points > 200, "{points}");
}

/// A corner belongs to a contact if it overlaps, however the body leans. Corners farther than 1/64 of the size behind
/// the deepest were none: a cube 0.3 deep in a floor had four points up to 0.012 rad, and two from 0.015 on.
#[test]
fn what_leans_keeps_the_corners_that_overlap() {
    let count = |shape: &dyn SupportMap<Vector = DVec3>| touch(&shape, &floor()).points().len();
    let unit = cuboid::<DVec3>([0.5; 3]);
    let capsule = Capsule::<DVec3>::new(0.5, 0.25).expect(VALID);
    let cylinder = Cylinder::<DVec3>::new(0.5, 0.5).expect(VALID);
    for lean in [0.0, 0.012, 0.015, 0.05, 0.1, 0.2] {
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, lean, 0.3, lean);
        assert_eq!(count(&turned(unit, turn, [0.0, 0.2, 0.0])), 4, "a cube, {lean}");
        assert_eq!(count(&turned(cylinder, turn, [0.0, 0.2, 0.0])), 4, "a cylinder, {lean}");
        let lying = DQuat::from_rotation_z(FRAC_PI_2 + lean);
        assert_eq!(count(&turned(capsule, lying, [0.0, 0.14, 0.0])), 2, "a capsule, {lean}");
    }
    let five = 5.0_f64.to_radians();
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, five, 0.2, five);
    assert_eq!(count(&turned(cuboid::<DVec3>([1.0; 3]), turn, [0.0, -0.3, 0.0])), 4, "all corners deep");
    // Beyond what is asked for there is no corner, whatever the size.
    let above = turned(unit, DQuat::from_rotation_z(0.1), [0.0, 0.53, 0.0]);
    for (within, count) in [(0.01, 2), (0.15, 4)] {
        let found = contact(&above, &floor(), within, SignedDistanceOptions::default()).expect("near");
        assert_eq!(found.points().len(), count, "{found:?}");
    }
}

/// The same points, by the numbers of their features, while bodies at rest jitter, and whichever body is named first.
/// The reduction began at the deepest point, which rounding chooses among equals: a cylinder on a floor changed its
/// points in half of the frames.
#[test]
fn bodies_at_rest_keep_their_points() {
    type Shape = Box<dyn SupportMap<Vector = DVec3>>;
    let cylinder = || Box::new(Cylinder::<DVec3>::new(0.5, 0.5).expect(VALID));
    let cone = || Box::new(Cone::<DVec3>::new(0.5, 0.5).expect(VALID));
    let unit = || Box::new(cuboid::<DVec3>([0.5; 3]));
    let prism = |count: u32| {
        let corner =
            |i: u32| DQuat::from_rotation_y(std::f64::consts::TAU * f64::from(i) / f64::from(count)) * DVec3::X;
        let corners = (0..count).flat_map(|i| [corner(i) * 0.5, corner(i) * 0.5 + DVec3::Y]);
        Polytope::new(corners.map(|p| p - DVec3::Y * 0.5)).expect("points")
    };
    let lying = DQuat::from_rotation_z(FRAC_PI_2);
    let capsule = Capsule::<DVec3>::new(0.25, 0.5).expect(VALID);
    let mut cases: Vec<(String, Shape, DQuat, Shape)> = vec![
        ("a cylinder on a floor".into(), cylinder(), DQuat::IDENTITY, Box::new(cuboid([5.0, 0.5, 5.0]))),
        ("a cylinder on its like".into(), cylinder(), DQuat::IDENTITY, cylinder()),
        ("a cylinder on its side".into(), cylinder(), lying, unit()),
        ("a capsule on its side".into(), Box::new(capsule), lying, unit()),
        ("a cone on a floor".into(), cone(), DQuat::IDENTITY, Box::new(cuboid([5.0, 0.5, 5.0]))),
        ("a cone on its like".into(), cone(), DQuat::IDENTITY, cylinder()),
        ("a hull on its like".into(), Box::new(prism(7)), DQuat::from_rotation_y(0.2), Box::new(prism(9))),
    ];
    for yaw in [0.0, 0.1, 0.4, FRAC_PI_4, 1.3] {
        cases.push((format!("a box turned by {yaw}"), unit(), DQuat::from_rotation_y(yaw), unit()));
    }
    for count in [3, 5, 6, 12, 40] {
        cases.push((format!("a prism of {count} sides"), Box::new(prism(count)), DQuat::IDENTITY, unit()));
    }
    let mut state = 5_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let options = SignedDistanceOptions::default();
    for (name, shape, turn, other) in &cases {
        for size in [1e-15, 1e-9, 1e-5, 1e-4] {
            let mut last: Option<Vec<(u32, u32)>> = None;
            for _ in 0..8 {
                let jitter = DVec3::new(number(), number(), number()) * size;
                let turn =
                    (DQuat::from_scaled_axis(DVec3::new(number(), number(), number()) * size) * *turn).normalize();
                let posed = turned(&**shape, turn, (jitter + DVec3::Y * 0.999).to_array());
                let found = contact(&posed, &**other, 0.0, options).expect("they touch");
                let swapped = contact(&**other, &posed, 0.0, options).expect("they touch").reversed();
                let ids = |found: &Contact<DVec3>| {
                    let mut ids: Vec<_> = found.points().iter().map(|p| (p.feature_a, p.feature_b)).collect();
                    ids.sort_unstable();
                    ids
                };
                assert_eq!(ids(&found), ids(&swapped), "{name}, {size}: {found:?} {swapped:?}");
                assert_eq!(ids(&found), last.unwrap_or_else(|| ids(&found)), "{name}, {size}: {found:?}");
                last = Some(ids(&found));
            }
        }
    }
}

/// A contact that is handed on keeps its points while they hold, though others span as much by now.
#[test]
fn a_contact_after_another_keeps_its_points() {
    let block = cuboid::<DVec3>([0.5; 3]);
    let options = SignedDistanceOptions::default();
    let above = |yaw: f64| turned(block, DQuat::from_rotation_y(yaw), [0.0, 0.999, 0.0]);
    let ids = |found: &Contact<DVec3>| {
        let mut ids: Vec<_> = found.points().iter().map(|p| (p.feature_a, p.feature_b)).collect();
        ids.sort_unstable();
        ids
    };
    // Of the eight corners of two squares turned against one another every second one is kept.
    let mut last = contact(&above(0.4), &block, 0.0, options).expect("they touch");
    let first = ids(&last);
    for i in 0..8 {
        let shape = above(0.4 + 0.01 * f64::from(i));
        last = contact_after(&last, &shape, &block, 0.0, options).expect("they touch");
        assert_eq!(ids(&last), first, "{i}: {last:?}");
    }
    // A corner that lifts off stays for twice as long as one that comes near.
    let lean = |angle: f64| turned(block, DQuat::from_rotation_z(angle), [0.0, 0.5 + 0.5 * angle - 1e-6, 0.0]);
    let resting = contact(&lean(0.0), &floor(), 0.0, options).expect("they touch");
    let lifted = lean(0.0012);
    assert_eq!(contact(&lifted, &floor(), 1e-9, options).expect("they touch").points().len(), 2);
    assert_eq!(contact_after(&resting, &lifted, &floor(), 1e-9, options).expect("they touch").points().len(), 4);
}

/// Bodies without a thickness, deep in one another, or with faces that lie on one another.
#[test]
fn odd_bodies_have_few_points_that_are_on_them() {
    let plate = cuboid::<DVec3>([1.0, 1e-9, 1.0]);
    let needle = cuboid::<DVec3>([1.0, 1e-7, 1e-7]);
    let flat = Polytope::new([DVec3::ZERO, DVec3::X, DVec3::Z, DVec3::X + DVec3::Z]).expect("points");
    let stick = Segment::new([DVec3::NEG_X, DVec3::X]).expect("finite");
    let point = Point::new(DVec3::ZERO).expect("finite");
    let triangle = Triangle::new([DVec3::ZERO, DVec3::X, DVec3::Z]).expect("finite");
    let shapes: [Box<dyn SupportMap<Vector = DVec3>>; 8] = [
        Box::new(plate),
        Box::new(needle),
        Box::new(flat),
        Box::new(stick),
        Box::new(point),
        Box::new(triangle),
        Box::new(cuboid::<DVec3>([1.0; 3])),
        Box::new(Cone::<DVec3>::new(1.0, 1.0).expect(VALID)),
    ];
    for (i, a) in shapes.iter().enumerate() {
        for b in &shapes {
            for turn in
                [DQuat::IDENTITY, DQuat::from_rotation_z(FRAC_PI_2), DQuat::from_rotation_x(0.4 + 0.1 * i as f64)]
            {
                for place in [[0.0; 3], [0.5, 0.0, 0.25], [0.1, -0.5, 0.0], [0.0, 1.0, 0.0]] {
                    for within in [0.0, 0.3, f64::INFINITY] {
                        let b = turned(&**b, turn, place);
                        let options = SignedDistanceOptions::default();
                        let Some(found) = contact(&**a, &b, within, options) else { continue };
                        assert!((1..=4).contains(&found.points().len()), "{found:?}");
                        for p in found.points() {
                            assert!(p.signed_distance.is_finite() && p.error >= 0.0, "{found:?}");
                            let of_a = signed_distance(&Point::new(p.point_a).expect("finite"), &**a, options);
                            let of_b = signed_distance(&Point::new(p.point_b).expect("finite"), &b, options);
                            let most = 1e-7_f64.max(found.distance.upper - found.distance.lower);
                            assert!(of_a.signed_distance < most && of_b.signed_distance < most, "{found:?}");
                        }
                    }
                }
            }
        }
    }
}

/// Outlines that are narrower than the rounding of their coordinates, of needles and of plates seen from the side, were
/// drawn as polygons whose corners turn by rounding alone. Clipped along their edges, the other outline reached farther
/// beyond the needle's end than the needle is long: single-precision points were off by up to half of the size. Such
/// outlines are segments. Levels were read off planes through points as near to one line, and beyond these points.
#[test]
fn what_is_narrower_than_rounding_is_a_segment() {
    #[allow(clippy::approx_constant, reason = "the last digits are those it was found with")]
    let upright = [0.000_340_001_2_f32, 0.000_340_001_2, 0.707_106_7, 0.707_106_7];
    let aside = [0.0, 0.707_106_77, 0.0, 0.707_106_77_f32];
    let edgewise = [0.0, 0.0, 0.707_106_77, 0.707_106_77_f32];
    let double = |q: [f32; 4]| glam::Quat::from_array(q).as_dquat().normalize();
    let (radius, long) = (1e-7, 0.129_746_47);
    // A needle beside a box, and a flat stick before a plate.
    let (needle, side) = ([1.048_909_8, 0.166_029_24, -0.125], [-1.75, -1.424_638, -0.897_294_6]);
    let (stick, plate) = ([-0.459_427_8, -1.25, -0.5], [-0.875, -1.700_154_3, 1.25]);
    let (box_size, stick_size, plate_size) = ([1.5, 1.0, 0.964_917_36], [1e-9, 1e-3, 1.5], [1.5, 2.0, 1e-7]);
    let single = |q| glam::Quat::from_array(q);
    let a = turned(Cylinder::<Vec3A>::new(long as f32, radius as f32).expect(VALID), single(upright), needle);
    let b = turned(cuboid::<Vec3A>(box_size), single(aside), side);
    let known_a = turned(Cylinder::<DVec3>::new(long, radius).expect(VALID), double(upright), needle);
    let known_b = turned(cuboid::<DVec3>(box_size), double(aside), side);
    are_on(&a, &b, &known_a, &known_b);
    let a = turned(cuboid::<Vec3A>(stick_size), single(edgewise), stick);
    let b = turned(cuboid::<Vec3A>(plate_size), glam::Quat::from_rotation_z(1.374_06e-6), plate);
    let known_a = turned(cuboid::<DVec3>(stick_size), double(edgewise), stick);
    let known_b = turned(cuboid::<DVec3>(plate_size), DQuat::from_rotation_z(1.374_06e-6), plate);
    are_on(&a, &b, &known_a, &known_b);
}

/// No point of a contact in single precision is outside these bodies by more than rounding.
fn are_on<A: SupportMap<Vector = DVec3>, B: SupportMap<Vector = DVec3>>(
    a: &dyn SupportMap<Vector = Vec3A>,
    b: &dyn SupportMap<Vector = Vec3A>,
    known_a: &A,
    known_b: &B,
) {
    let found = contact(a, b, 3.0, SignedDistanceOptions::default()).expect("near");
    for p in found.points() {
        let outside = |point: Vec3A, body: &dyn SupportMap<Vector = DVec3>| {
            let point = Point::new(point.as_dvec3()).expect("finite");
            signed_distance(&point, body, SignedDistanceOptions::default()).lower
        };
        assert!(outside(p.point_a, known_a) < 1e-5 && outside(p.point_b, known_b) < 1e-5, "{found:?}");
    }
}

/// What a stepper needs beside the points: directions for friction, the points in the frames of the bodies, and how
/// fast they approach.
#[test]
fn a_contact_has_tangents_anchors_and_velocities() {
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.02, 0.7, -0.01);
    let (a, b) = (turned(cuboid::<DVec3>([0.5; 3]), turn, [0.3, 0.48, -0.2]), floor());
    let found = touch(&a, &b);
    let [e, f] = found.tangents();
    let n = found.normal;
    assert!((glam::DMat3::from_cols(e, f, n).determinant().abs() - 1.0).abs() < 1e-14, "{e} {f} {n}");
    assert!(e.dot(f).abs() + e.dot(n).abs() + f.dot(n).abs() < 1e-14, "{e} {f} {n}");
    let motion = RigidMotion { velocity: DVec3::new(1.0, -2.0, 0.0), angular_velocity: DVec3::Z, center: DVec3::ZERO };
    let still = RigidMotion::default();
    for point in found.points() {
        let [of_a, of_b] = point.anchors(&a, &b);
        assert!((a.rotation() * of_a + a.translation() - point.point_a).length() < 1e-15, "{of_a}");
        assert!((of_b.y - 1.0).abs() < 1e-12 && of_a.abs().max_element() < 0.5 + 1e-12, "{of_a} {of_b}");
        let speed = point.relative_velocity(&motion, &still);
        assert!((speed - motion.velocity - DVec3::Z.cross(point.point_a)).length() < 1e-15, "{speed}");
        assert!((point.reversed().relative_velocity(&still, &motion) + speed).length() < 1e-15, "{speed}");
    }
    let in_the_plane = touch(&at(cuboid::<DVec2>([0.5, 0.5, 0.0]), [0.0; 3]), &cuboid::<DVec2>([0.5, 0.5, 0.0]));
    let [e, f] = in_the_plane.tangents();
    assert_eq!((e.dot(in_the_plane.normal), e.length(), f), (0.0, 1.0, DVec2::ZERO));
}

/// The points of a curved surface around a place end as thin triangles: two of them next to one another, and the third
/// as far away as the body is long. Weights of such corners that are differences of rounded products were wrong by the
/// rounding of the long sides, and 1 of 90 points of contact was outside its body, by up to 4e-10 of the size.
#[test]
fn points_between_corners_of_thin_triangles_are_of_the_shapes() {
    let ellipsoid = |axes: [f64; 3]| Ellipsoid::new(DVec3::ZERO, DVec3::from(axes), DQuat::IDENTITY).expect(VALID);
    let bodies: [&dyn SupportMap<Vector = DVec3>; 4] = [
        &ellipsoid([0.3, 0.9, 1.4]),
        &Cylinder::new(0.7, 0.5).expect(VALID),
        &Rounded::new(cuboid::<DVec3>([0.5, 0.8, 1.1]), 0.125).expect(VALID),
        &Capsule::new(0.9, 0.4).expect(VALID),
    ];
    let mut seen = 0;
    for (i, a) in bodies.iter().enumerate() {
        for (j, b) in bodies.iter().enumerate() {
            for k in 0..12 {
                let turn =
                    |i: usize, s: f64| DQuat::from_rotation_z(0.7 + s * i as f64).mul_quat(DQuat::from_rotation_x(s));
                let a = turned(a, turn(k + 5 * i, 0.9), [0.0; 3]);
                let b = turned(b, turn(k + 3 * j, 1.3), [0.3 + 0.02 * k as f64, 0.2, -0.1]);
                let found = contact(&a, &b, 0.1, SignedDistanceOptions::default()).expect("deep");
                for p in found.points() {
                    let outside = |point: DVec3, body: &dyn SupportMap<Vector = DVec3>| {
                        let point = Point::new(point).expect("finite");
                        distance(&body, &point, Default::default()).lower
                    };
                    let (out_a, out_b) = (outside(p.point_a, &a), outside(p.point_b, &b));
                    let allowed = p.error + 64.0 * f64::EPSILON;
                    assert!(out_a <= allowed && out_b <= allowed, "{out_a:e} {out_b:e} of {allowed:e}: {p:?}");
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 300, "{seen}");
}

/// How far the points of a manifold are outside the bodies, which are given in double precision, is within their errors
/// and the rounding of their coordinates.
fn are_of_their_bodies<V, A, B>(found: &Contact<V>, a: &A, b: &B, size: f64)
where
    V: Vector,
    A: SupportMap<Vector = DVec3>,
    B: SupportMap<Vector = DVec3>,
{
    let outside = |shape: &dyn SupportMap<Vector = DVec3>, at: V| {
        let point = Point::new(DVec3::from_fn(|i| at.get(i).as_f64())).expect("finite");
        signed_distance(&point, &shape, SignedDistanceOptions::default()).lower
    };
    for p in found.points() {
        let allowed = p.error.as_f64() + 64.0 * V::Scalar::EPSILON.as_f64() * size;
        let off = [outside(a, p.point_a), outside(b, p.point_b)];
        assert!(off.iter().all(|&off| off <= allowed), "{off:?}, not {allowed}: {found:?}");
    }
}

/// The affine image of a shape, turned and moved.
fn mapped<V: Vector, S: SupportMap<Vector = V>>(
    shape: S,
    columns: [[f64; 3]; 3],
    turn: [f64; 4],
    place: [f64; 3],
) -> Posed<Affine<S>> {
    let number = V::Scalar::from_f64;
    let vector = |c: [f64; 3]| V::from_fn(|i| number(c[i]));
    let matrix = V::Matrix::from_cols_fn(|j| vector(columns[j]));
    let affine = Affine::new(shape, matrix, V::ZERO).expect("finite");
    Posed::new(affine, V::Rotation::from_xyzw(turn.map(number)), vector(place)).expect("a pose")
}

/// A disc and a needle by flattened balls, in single precision: a point was outside by 3e-4 with an error of 2e-6.
fn flattened_balls<V: Vector>() -> [Posed<Affine<Ball<V>>>; 2] {
    let ball = |radius: f64| Ball::new(V::Scalar::from_f64(radius)).expect(VALID);
    let columns = [
        [-0.4481360912322998, -0.736619234085083, 0.7711043357849121],
        [0.1944514513015747, 0.006552918814122677, -0.06548526883125305],
        [0.40872639417648315, -0.903304398059845, 0.3462912142276764],
    ];
    let half = f64::from(std::f32::consts::FRAC_1_SQRT_2);
    let place = [0.051184479147195816, -0.08288610726594925, 0.09244164824485779];
    let plate = [[1.0, 0.0, 0.0], [0.0, 0.0033201680053025484, 0.0], [0.0, 0.0, 1.0]];
    let turn = [-0.4441549479961395, 0.7041440606117249, -0.14531470835208893, 0.8565601706504822];
    [
        mapped(ball(0.0625), columns, [half, 0.0, 0.0, half], place),
        mapped(ball(0.10646600276231766), plate, turn, [0.1397935301065445, -0.1200353279709816, -0.00615311274304986]),
    ]
}

/// Two flattened capsules: a point was outside by 2e-7 with an error of 8e-13.
fn flattened_capsules<V: Vector>() -> [Posed<Affine<Capsule<V>>>; 2] {
    let number = V::Scalar::from_f64;
    let capsule = |half: f64, radius: f64| Capsule::new(number(half), number(radius)).expect(VALID);
    let plate = [[0.8825273433088086, 0.0, 0.0], [0.0, 0.9928904900944523, 0.0], [0.0, 0.0, 0.004705018122926024]];
    let columns = [
        [0.11246991570419479, 0.1491867485122364, -0.010520072956921376],
        [0.0958154352835364, -0.12223651441485191, 3.134978509749434e-5],
        [-0.000907700003314161, -0.0004725572541004796, -1.1745597905590182e-6],
    ];
    let turn = [4.660729571451728e-6, -2.153829209215851e-6, -3.956987976309224e-6, 1.0];
    [
        mapped(
            capsule(11.163152475005843, 16.0),
            plate,
            [0.0, 0.0, 0.0, 1.0],
            [-13.669738732428417, 0.0, -0.7656463361088193],
        ),
        mapped(
            capsule(8.0, 0.9655207510623386),
            columns,
            turn,
            [-12.380611553368055, 13.123179349947005, 1.4927442186696105],
        ),
    ]
}

/// The feature of a flattened ball or capsule was the image of what the round body has within the slab, whose points
/// are not of the image.
#[test]
fn points_of_flattened_balls_and_capsules_are_of_them() {
    let [single_a, single_b] = flattened_balls::<Vec3A>();
    let [a, b] = flattened_balls::<DVec3>();
    let found = contact(&single_a, &single_b, 0.0375, SignedDistanceOptions::default()).expect("near");
    are_of_their_bodies(&found, &a, &b, 0.25);
    let found = contact(&a, &b, 0.0375, SignedDistanceOptions::default()).expect("near");
    are_of_their_bodies(&found, &a, &b, 0.25);
    let [a, b] = flattened_capsules::<DVec3>();
    let found = contact(&a, &b, 4.8, SignedDistanceOptions::default()).expect("near");
    are_of_their_bodies(&found, &a, &b, 32.0);
}
