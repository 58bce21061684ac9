//! Contact manifolds.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use crate::common::{at, cuboid, turned};
use convex_support::glam::{DQuat, DVec2, DVec3};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cylinder, Matrix, Polytope, Posed, Rounded, Segment, SupportMap, Triangle, Vector,
    closest_point, glam,
};
use gjk_raycast::{Contact, SignedDistanceOptions, contact, signed_distance};

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

/// Seen nearly from its end a segment is steep, and where it is in the plane of contact is rounding: its height there was one far beyond
/// the capsule's end.
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

/// What lies within the distance asked for is no feature if it is not nearly flat: from the silhouette of a whole shape, points were made
/// that were on none of them, and the closest were not among these.
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
