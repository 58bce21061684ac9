//! Shapes and rays against half-spaces: what is answered of a floor or a slope.

use convex_support::glam::{DVec2, DVec3, Vec3A};
use convex_support::{Ball, Capsule, Cylinder, Ellipsoid, Polytope, SupportMap, Vector};
use gjk_raycast::{
    HalfSpace, LinearCastOptions, Motion, Outcome, Ray, RayCastOptions, SignedDistance, SignedDistanceOptions,
    StartInContact, contact, signed_distance,
};

use crate::common::{at, cuboid, s, turned, v};

/// The half-space below `height` along `normal`.
fn below<V: Vector>(normal: [f64; 3], height: f64) -> HalfSpace<V> {
    HalfSpace::new(v(normal), s::<V>(height)).expect("a normal")
}

fn holds<V: Vector<Scalar = f64>>(answer: SignedDistance<V>, truth: f64) {
    assert!(answer.lower <= truth && truth <= answer.upper, "{truth}: {answer:?}");
    assert!(answer.upper - answer.lower < 2e-13, "{answer:?}");
    assert_eq!(answer.overlap, answer.signed_distance <= 0.0, "{answer:?}");
    let between = answer.point_a - answer.point_b - answer.normal * answer.signed_distance;
    assert!(between.length() < 1e-14, "{answer:?}");
}

#[test]
fn shapes_are_as_high_as_their_lowest_points() {
    let slope = below::<DVec3>([3.0, 4.0, 0.0], 10.0); // (3, 4)·x/5 ≤ 2
    let here = [30.0, 40.0, -7.0]; // 48 above it
    let turn = convex_support::glam::DQuat::from_rotation_z(0.5_f64.atan2(1.0));
    let ellipsoid = Ellipsoid::new(DVec3::ZERO, DVec3::new(3.0, 1.0, 2.0), convex_support::glam::DQuat::IDENTITY);
    let tilted = (9.0_f64 * 0.36 + 0.64).sqrt();
    let shapes: [(Box<dyn SupportMap<Vector = DVec3>>, f64); 5] = [
        (Box::new(at(Ball::new(0.5).expect("positive"), here)), 47.5),
        (Box::new(at(cuboid([1.0, 2.0, 3.0]), here)), 48.0 - 0.6 - 1.6),
        (Box::new(at(Capsule::new(2.0, 0.25).expect("positive"), here)), 48.0 - 1.6 - 0.25),
        (Box::new(at(Cylinder::new(2.0, 0.25).expect("positive"), here)), 48.0 - 1.6 - 0.15),
        (Box::new(at(ellipsoid.expect("positive"), here)), 48.0 - tilted),
    ];
    for (shape, height) in &shapes {
        holds(slope.signed_distance(shape), *height);
        let distance = slope.distance_from(shape);
        assert!((distance.distance - height).abs() < 1e-14 && !distance.overlap, "{distance:?}");
        // As deep as it was high.
        let sunk = below::<DVec3>([3.0, 4.0, 0.0], 10.0 + 5.0 * (height + 0.125));
        holds(sunk.signed_distance(shape), -0.125);
        let distance = sunk.distance_from(shape);
        assert!(distance.distance == 0.0 && distance.overlap && distance.upper == 0.0, "{distance:?}");
    }
    let die = turned(cuboid::<DVec3>([1.0; 3]), turn, [0.0, 5.0, 0.0]);
    let reach = (turn * DVec3::X).y.abs() + (turn * DVec3::Y).y.abs();
    holds(below([0.0, 1.0, 0.0], 0.0).signed_distance(&die), 5.0 - reach);
}

#[test]
fn how_far_along_the_floor_a_body_is_does_not_matter() {
    let floor = below::<Vec3A>([0.0, 2.0, 0.0], 2.0); // y ≤ 1
    for far in [0.0, 1e3, 1e7] {
        let answer = floor.signed_distance(&at(cuboid::<Vec3A>([0.5; 3]), [far, 1.5 + 1e-6, -far]));
        let truth = f64::from((1.5_f64 + 1e-6) as f32) - 1.5;
        assert!(f64::from(answer.lower) <= truth && truth <= f64::from(answer.upper), "{far}: {answer:?}");
        assert!(answer.lower > 0.0 && answer.upper < 1.5e-6, "{far}: {answer:?}");
    }
}

/// Bodies in contact with a large box and with a half-space are in contact in the same points.
#[test]
fn a_floor_without_an_end_carries_as_a_large_box_does() {
    let floor = below::<DVec3>([0.0, 1.0, 0.0], 0.0);
    let large = at(cuboid::<DVec3>([100.0, 1.0, 100.0]), [0.0, -1.0, 0.0]);
    let roof: [[f64; 3]; 6] =
        [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0]];
    let roof = Polytope::new(roof.map(v::<DVec3>)).expect("finite");
    let lying = convex_support::glam::DQuat::from_rotation_z(core::f64::consts::FRAC_PI_2);
    let shapes: [(&str, Box<dyn SupportMap<Vector = DVec3>>, usize); 6] = [
        ("a box", Box::new(at(cuboid([0.5; 3]), [3.0, 0.49, 0.0])), 4),
        ("a box above", Box::new(at(cuboid([0.5; 3]), [3.0, 0.505, 0.0])), 4),
        ("a ball", Box::new(at(Ball::new(0.5).expect("positive"), [3.0, 0.49, 0.0])), 1),
        ("a roof", Box::new(at(roof, [0.0, -0.01, 2.0])), 4),
        ("a capsule", Box::new(turned(Capsule::new(1.0, 0.25).expect("positive"), lying, [0.0, 0.24, 0.0])), 2),
        ("a cylinder", Box::new(at(Cylinder::new(1.0, 0.25).expect("positive"), [0.0, 0.995, 0.0])), 4),
    ];
    for (name, shape, count) in &shapes {
        let of_floor = floor.contact(shape, 0.02).expect("in contact");
        let of_box = contact(shape, &large, 0.02, SignedDistanceOptions::default()).expect("in contact");
        assert_eq!(of_floor.points().len(), *count, "{name}: {of_floor:?}");
        assert_eq!(of_box.points().len(), *count, "{name}: {of_box:?}");
        assert_eq!(of_floor.normal, DVec3::Y, "{name}");
        for point in of_floor.points() {
            let is_known = |other: &gjk_raycast::ContactPoint<DVec3>| {
                (other.point_a - point.point_a).length() < 1e-12
                    && (other.signed_distance - point.signed_distance).abs() < 1e-12
            };
            // Of a disc any four points carry alike.
            let is_round = *name == "a cylinder" || of_box.points().iter().any(is_known);
            assert!(is_round, "{name}: {point:?} {of_box:?}");
            assert!((point.point_a - point.point_b - DVec3::Y * point.signed_distance).length() < 1e-15, "{name}");
            assert_eq!(point.point_b.y, 0.0, "{name}: {point:?}");
        }
        let deepest = of_floor.points().iter().map(|point| point.signed_distance).fold(f64::INFINITY, f64::min);
        assert!(
            (deepest - signed_distance(shape, &large, SignedDistanceOptions::default()).signed_distance).abs() < 1e-12
        );
        assert!(floor.contact(&at(shape, [0.0, 1.0, 0.0]), 0.02).is_none(), "{name}");
    }
}

#[test]
fn in_the_plane_two_points_carry() {
    let floor = below::<DVec2>([0.0, 1.0, 0.0], 0.0);
    let contact = floor.contact(&at(cuboid([0.5; 3]), [3.0, 0.49, 0.0]), 0.0).expect("in contact");
    let mut at: Vec<f64> = contact.points().iter().map(|point| point.point_a.x).collect();
    at.sort_by(f64::total_cmp);
    assert_eq!(at, [2.5, 3.5]);
    assert!(contact.points().iter().all(|point| (point.signed_distance + 0.01).abs() < 1e-15), "{contact:?}");
}

/// What is on the floor exactly, slides along it, leaves it or goes into it.
#[test]
fn what_begins_on_the_floor() {
    for (normal, along) in [([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]), ([1.0, 1.0, 0.0], [1.0, -1.0, 0.0])] {
        let slope = below::<DVec3>(normal, 0.0);
        // The lower corner is at zero.
        let corner = if normal[0] == 0.0 { [0.0, 1.0, 0.0] } else { [1.0, 1.0, 0.0] };
        let cube = at(cuboid::<DVec3>([1.0; 3]), corner);
        let cast = |velocity: [f64; 3], start| {
            let motion = Motion { velocity_a: v(velocity), velocity_b: DVec3::ZERO };
            slope.linear_cast(&cube, motion, LinearCastOptions::new().with_start_in_contact(start)).expect("finite")
        };
        let down = normal.map(|x| -x);
        for velocity in [along, normal, down, [0.0; 3]] {
            let report = cast(velocity, StartInContact::Report);
            assert_eq!((report.outcome.hit().map(|hit| hit.time), report.lower, report.upper), (Some(0.0), 0.0, 0.0));
            let deeper = cast(velocity, StartInContact::IfDeeper);
            assert_eq!(deeper.outcome.is_miss(), velocity != down, "{velocity:?} {deeper:?}");
        }
        // A little above, it slides or rests for ever.
        let above = at(cube, normal.map(|x| 0.25 * x));
        for velocity in [along, normal, [0.0; 3]] {
            let motion = Motion { velocity_a: v(velocity), velocity_b: DVec3::ZERO };
            let cast = slope.linear_cast(&above, motion, LinearCastOptions::new()).expect("finite");
            assert!(cast.outcome.is_miss(), "{velocity:?} {cast:?}");
        }
        let motion = Motion { velocity_a: v(down), velocity_b: DVec3::ZERO };
        let cast = slope.linear_cast(&above, motion, LinearCastOptions::new()).expect("finite");
        assert_eq!(cast.outcome.hit().map(|hit| hit.time), Some(0.25), "{cast:?}");
    }
}

#[test]
fn rays_that_begin_late_or_end_early() {
    let floor = below::<DVec3>([0.0, 2.0, 0.0], 2.0); // y ≤ 1
    let ray = |direction: [f64; 3]| Ray { source: DVec3::new(0.0, 4.0, 0.0), direction: v(direction) };
    let cast = |direction, options| floor.ray_cast(ray(direction), options).expect("finite");
    let options = RayCastOptions::new();
    let hit = |options| cast([1.0, -1.0, 0.0], options).outcome.hit().map(|hit| (hit.lambda, hit.normal));
    assert_eq!(hit(options), Some((3.0, Some(DVec3::Y))));
    assert_eq!(hit(options.with_max_lambda(3.0)), Some((3.0, Some(DVec3::Y))), "the end belongs to the ray");
    assert_eq!(hit(options.with_max_lambda(2.75)), None);
    assert_eq!(hit(options.with_min_lambda(2.0)), Some((3.0, Some(DVec3::Y))));
    assert_eq!(hit(options.with_min_lambda(3.5)), Some((3.5, None)), "it begins below the floor");
    assert_eq!(hit(options.with_min_lambda(3.5).with_max_lambda(3.25)), None);
    assert!(cast([1.0, 0.0, 0.0], options).outcome.is_miss(), "level");
    assert!(cast([1.0, 1.0, 0.0], options).outcome.is_miss(), "upwards");
    let up = Ray { source: DVec3::new(0.0, -4.0, 0.0), direction: DVec3::Y };
    let cast = |begin| floor.ray_cast(up, options.with_min_lambda(begin)).expect("finite");
    assert_eq!(cast(0.0).outcome.hit().map(|hit| hit.lambda), Some(0.0), "it begins there");
    assert_eq!(cast(4.0).outcome.hit().map(|hit| hit.lambda), Some(4.0), "and is there still");
    assert!(cast(6.0).outcome.is_miss(), "it has left");
}

#[test]
fn what_is_no_number_is_not_decided() {
    struct Broken;
    impl SupportMap for Broken {
        type Vector = DVec3;
        fn support(&self, _: DVec3) -> DVec3 {
            DVec3::NAN
        }
    }
    let floor = below::<DVec3>([0.0, 1.0, 0.0], 0.0);
    let answer = floor.signed_distance(&Broken);
    assert_eq!((answer.lower, answer.upper), (f64::NEG_INFINITY, f64::INFINITY));
    assert!(floor.contact(&Broken, 1.0).is_none());
    let motion = Motion { velocity_a: DVec3::NEG_Y, velocity_b: DVec3::ZERO };
    let cast = floor.linear_cast(&Broken, motion, LinearCastOptions::new()).expect("finite velocities");
    assert_eq!((cast.outcome, cast.lower, cast.upper), (Outcome::Undecided, 0.0, f64::INFINITY));
}
