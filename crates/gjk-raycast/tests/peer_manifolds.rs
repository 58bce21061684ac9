//! What the tests of `Box3D`, `Jolt`, `MuJoCo` and `DART` expect of manifolds: their poses, and the numbers that these
//! must lead to.
//!
//! Where such a library keeps points that do not touch yet, contacts within some distance are asked for here.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, SQRT_2};

use convex_support::glam::{DMat3, DQuat, DVec3};
use convex_support::{Ball, Capsule, Polytope, Posed, SupportMap, Triangle};
use gjk_raycast::{Contact, SignedDistanceOptions, contact, intersects};

use crate::common::{Random, at, cuboid, turned};

const VALID: &str = "positive sizes";

fn within<A, B>(a: &A, b: &B, distance: f64) -> Contact<DVec3>
where
    A: SupportMap<Vector = DVec3>,
    B: SupportMap<Vector = DVec3>,
{
    contact(a, b, distance, SignedDistanceOptions::default()).expect("they are as near as that")
}

/// Two cubes of a size, one turned about y and one about z by an eighth of a turn, so that an edge of each is nearest.
fn crossed_cubes(size: f64, [x, y]: [f64; 2]) -> Contact<DVec3> {
    let cube = cuboid::<DVec3>([0.5 * size; 3]);
    let about_y = turned(cube, DQuat::from_rotation_y(FRAC_PI_4), [0.0; 3]);
    let about_z = turned(cube, DQuat::from_rotation_z(FRAC_PI_4), [x, y, 0.0]);
    within(&about_z, &about_y, 0.01 * size)
}

// Box3D, test_manifold.c: edges that cross touch in one point, from apart to deep and at any size.
#[test]
fn box3d_crosses_edges() {
    for x in [1.42, SQRT_2, 1.41, 1.3] {
        let crossed = crossed_cubes(1.0, [x, 0.0]);
        let [point] = crossed.points() else { panic!("one point: {crossed:?}") };
        let middle = (point.point_a + point.point_b) * 0.5;
        assert!((crossed.normal - DVec3::X).length() < 1e-12, "{crossed:?}");
        assert!((point.signed_distance - (x - SQRT_2)).abs() < 1e-12, "{crossed:?}");
        assert!((middle - DVec3::X * (0.5 * x)).length() < 1e-12, "{crossed:?}");
    }
    for size in [100.0, 1.0, 0.2] {
        let crossed = crossed_cubes(size, [SQRT_2 * size - 0.002, 0.0]);
        let [point] = crossed.points() else { panic!("one point: {crossed:?}") };
        assert!((point.signed_distance + 0.002).abs() < 1e-12 * size, "{crossed:?}");
    }
    // Near the end of an edge.
    let crossed = crossed_cubes(1.0, [1.41, 0.49]);
    let [point] = crossed.points() else { panic!("one point: {crossed:?}") };
    assert!((point.point_a.y - 0.49).abs() < 1e-12, "{crossed:?}");
}

// Box3D, test_manifold.c: stacked cubes that lean by up to 0.05 stand on four points, no higher or lower than their
// corners move.
#[test]
fn box3d_stacks_cubes_that_lean() {
    let (cube, overlap) = (cuboid::<DVec3>([0.5; 3]), 0.01);
    let axes = [[1.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 2.0, 3.0], [-2.0, 3.0, -2.0]];
    for axis in axes.map(|axis| DVec3::from_array(axis).normalize()) {
        for angle in [0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.004, 0.005, 0.006, 0.01, 0.05] {
            let above = turned(cube, DQuat::from_axis_angle(axis, angle), [0.0, 1.0 - overlap, 0.0]);
            let stacked = within(&above, &cube, 0.05);
            assert_eq!(stacked.points().len(), 4, "{axis} {angle} {stacked:?}");
            assert!(stacked.normal.y > 0.998, "{axis} {angle} {stacked:?}");
            for point in stacked.points() {
                let moved = (point.signed_distance + overlap).abs();
                assert!(moved <= 0.87 * angle + 1e-12, "{axis} {angle} {stacked:?}");
            }
        }
    }
}

// Box3D, test_manifold.c: bodies in overlap have a point, the deepest of which is in both.
#[test]
fn box3d_has_a_point_of_all_that_overlap() {
    let (cube, other) = (cuboid::<DVec3>([0.5; 3]), cuboid([0.4, 0.6, 0.5]));
    let random = &mut Random(20);
    for i in 0..2_000 {
        let (axis, offset) = (random.direction(), random.direction() * 0.4);
        let largest = if i % 2 == 0 { std::f64::consts::PI } else { 0.01 };
        let angle = random.number(-largest, largest);
        let moved = turned(other, DQuat::from_axis_angle(axis, angle), offset.to_array());
        let overlapping = within(&moved, &cube, 0.0);
        let least = overlapping.points().iter().map(|point| point.signed_distance).fold(f64::INFINITY, f64::min);
        assert!(least < 0.0, "{axis} {angle} {offset} {overlapping:?}");
    }
}

// Box3D, test_manifold.c: an edge of a triangle under an edge of a cube.
#[test]
fn box3d_crosses_an_edge_and_a_triangle() {
    let (beta, gamma) = (20.0_f64.to_radians(), 30.0_f64.to_radians());
    let cube = turned(cuboid::<DVec3>([0.5; 3]), DQuat::from_rotation_x(FRAC_PI_4), [0.0; 3]);
    let normal = DVec3::new(beta.sin(), beta.cos(), 0.0);
    let edge = DVec3::new(gamma.sin() * beta.cos(), -gamma.sin() * beta.sin(), gamma.cos());
    let (axis, lowest) = (DVec3::X.cross(edge).normalize(), DVec3::NEG_Y * 0.5_f64.sqrt());
    for gap in [0.03, 0.01, 0.0, -0.01] {
        let middle = lowest + axis * gap;
        let from = middle - edge;
        let triangle = Triangle::new([from, middle + edge, from + normal.cross(edge) * 1.5]).expect("finite");
        let crossed = within(&cube, &triangle, 0.05);
        let deepest = crossed.points().iter().min_by(|p, q| p.signed_distance.total_cmp(&q.signed_distance));
        let point = deepest.expect("a manifold has a point");
        assert!((crossed.normal + axis).length() < 1e-12, "{gap} {crossed:?}");
        assert!((point.signed_distance - gap).abs() < 1e-12, "{gap} {crossed:?}");
        assert!((point.point_a - lowest).length() < 1e-12, "{gap} {crossed:?}");
    }
}

// Jolt, CollideShapeTests.cpp: points of balls, and of a ball whose centre is in a face of a box.
#[test]
fn jolt_touches_balls_and_boxes() {
    let ball = |radius: f64, place| at(Ball::<DVec3>::new(radius).expect(VALID), place);
    for (p, q) in [([10.0, 11.0, 12.0], [13.0, 11.0, 12.0]), ([10.0, 21.0, 12.0], [13.0, 22.0, 12.0])] {
        let touching = within(&ball(2.0, p), &ball(1.5, q), 0.0);
        let [point] = touching.points() else { panic!("one point: {touching:?}") };
        let (p, q) = (DVec3::from_array(p), DVec3::from_array(q));
        let axis = (q - p).normalize();
        assert!((touching.normal + axis).length() < 1e-12, "{touching:?}");
        assert!((point.point_a - (p + axis * 2.0)).length() < 1e-12, "{touching:?}");
        assert!((point.point_b - (q - axis * 1.5)).length() < 1e-12, "{touching:?}");
    }
    let pillar = turned(cuboid::<DVec3>([10.0, 1.0, 1.0]), DQuat::from_rotation_z(FRAC_PI_2), [0.0, 1.0, 0.0]);
    let touching = within(&ball(1.0, [0.0, 11.0, 0.0]), &pillar, 0.0);
    let [point] = touching.points() else { panic!("one point: {touching:?}") };
    assert!((point.point_a - DVec3::Y * 10.0).length() < 1e-12, "{touching:?}");
    assert!((point.point_b - DVec3::Y * 11.0).length() < 1e-12, "{touching:?}");
    assert!((point.signed_distance + 1.0).abs() < 1e-12, "{touching:?}");
}

// Jolt, CollideShapeTests.cpp: a box around a part of a long capsule's segment is out of it after 1.01 of the way that
// is reported, and not after 0.99.
#[test]
fn jolt_moves_a_box_out_of_a_capsule() {
    let matrix = DMat3::from_cols(
        DVec3::new(0.516170502, -0.803887904, -0.295520246),
        DVec3::new(0.815010250, 0.354940295, 0.458012700),
        DVec3::new(-0.263298869, -0.477264702, 0.838386655),
    );
    let middle = DVec3::new(-10.2214508, -18.6808319, 40.7468987);
    let half_extents = cuboid::<DVec3>([1.5, 0.75, 1.25]);
    let boxed = |moved: DVec3| Posed::new(half_extents, DQuat::from_mat3(&matrix), middle + moved).expect("a pose");
    let along_z = DQuat::from_rotation_x(FRAC_PI_2);
    let capsule = Capsule::<DVec3>::new(75.0, 1.5).expect(VALID);
    let capsule = turned(capsule, along_z, [-9.68538570, -18.0328083, 41.3212280]);
    let touching = within(&boxed(DVec3::ZERO), &capsule, 0.0);
    let depth = touching.points().iter().map(|point| -point.signed_distance).fold(0.0, f64::max);
    let overlaps = |part| intersects(&boxed(touching.normal * (part * depth)), &capsule, Default::default()).overlap;
    assert!(depth > 0.0 && overlaps(0.99) && !overlaps(1.01), "{touching:?}");
}

// Jolt, CollideShapeTests.cpp: a large box and a triangle near it that it does not touch.
#[test]
fn jolt_leaves_a_triangle_outside_a_box() {
    let corners = [
        [125.932892, -374.712250, 364.192169],
        [319.492218, -73.2614441, 475.009613],
        [-122.277550, -152.200287, 192.441437],
        [71.2817841, 149.250519, 303.258881],
        [-77.8921967, -359.410797, 678.579712],
        [115.667137, -57.9600067, 789.397095],
        [-326.102631, -136.898834, 506.828949],
        [-132.543304, 164.551971, 617.646362],
    ];
    let hull = Polytope::new(corners.map(DVec3::from_array)).expect("points");
    let triangle = Triangle::new([
        DVec3::new(-81.5637589, -126.987244, -146.771729),
        DVec3::new(-81.8749924, -127.270691, -146.544403),
        DVec3::new(-81.6972275, -127.383545, -146.773254),
    ])
    .expect("finite");
    assert_eq!(contact(&hull, &triangle, 0.0, SignedDistanceOptions::default()), None);
}

// MuJoCo, engine_collision_box_test.cc: all points between cubes that overlap by a half are as deep, and a ball on a
// box is as far from it as from the plane of its face.
#[test]
fn mujoco_knows_how_deep_boxes_are() {
    let cube = cuboid::<DVec3>([1.0; 3]);
    let stacked = within(&at(cube, [0.0, 0.0, 1.5]), &cube, 0.0);
    assert_eq!(stacked.points().len(), 4, "{stacked:?}");
    assert!(stacked.points().iter().all(|point| (point.signed_distance + 0.5).abs() < 1e-12), "{stacked:?}");
    let plate = at(cuboid::<DVec3>([0.05, 0.05, 0.025]), [0.0, 0.0, -0.025]);
    for z in [-0.015, -0.00501, -0.005, -0.00499, 0.0, 0.004] {
        let resting = within(&at(Ball::<DVec3>::new(0.005).expect(VALID), [0.0, 0.0, z]), &plate, 0.0);
        let [point] = resting.points() else { panic!("one point: {resting:?}") };
        assert!((point.signed_distance - (z - 0.005)).abs() < 1e-12, "{z} {resting:?}");
    }
}

// DART, test_Collision.cpp: a small cube over the side of a large one stands on four points of the face that both
// share, and one ball around another has one point.
#[test]
fn dart_stands_on_what_is_shared() {
    let large = at(cuboid::<DVec3>([0.5; 3]), [0.0, 0.0, -0.5]);
    let small = at(cuboid::<DVec3>([0.25; 3]), [0.0, 0.5, 0.25]);
    let stacked = within(&small, &large, 0.0);
    assert_eq!(stacked.points().len(), 4, "{stacked:?}");
    for point in stacked.points() {
        let on_both = (point.point_a + point.point_b) * 0.5;
        assert!(on_both.z.abs() < 1e-12 && on_both.x.abs() <= 0.25 + 1e-12, "{stacked:?}");
        assert!((0.25 - 1e-12..=0.5 + 1e-12).contains(&on_both.y), "{stacked:?}");
    }
    let ball = |radius| Ball::<DVec3>::new(radius).expect(VALID);
    assert_eq!(within(&ball(1.0), &ball(0.5), 0.0).points().len(), 1);
}
