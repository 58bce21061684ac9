//! Casts as those ask them who step a world: from contact on, to a distance from it, from a surface, and through a
//! shape.

use crate::common::behind_pointers::{
    distance, intersects, linear_cast, motion_cast, ray_cast, ray_exit, signed_distance,
};
use crate::common::{Random, at, cuboid, s, ulps, v};
use convex_support::glam::{DQuat, DVec2, DVec3, Vec3};
use convex_support::{Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Posed, Rounded, Segment, SupportMap};
use gjk_raycast::{
    ChainMotion, DistanceOptions, HalfSpace, LinearCastOptions, Motion, MotionCast, MotionCastOptions, Outcome, Ray,
    RayCastError, RayCastOptions, RigidMotion, SignedDistanceOptions, StartInContact, iterative_ray_cast,
};
use std::f64::consts::{PI, TAU};

impl Random {
    fn rotation(&mut self) -> DQuat {
        DQuat::from_axis_angle(self.direction(), self.number(0.0, 3.0))
    }

    fn shape(&mut self) -> Box<dyn SupportMap<Vector = DVec3>> {
        let mut size = || self.number(0.2, 1.0);
        let (x, y, z) = (size(), size(), size());
        let valid = "positive sizes";
        match self.0 % 7 {
            0 => Box::new(Ball::new(x).expect(valid)),
            1 => Box::new(Cuboid::new(DVec3::new(x, y, z)).expect(valid)),
            2 => Box::new(Capsule::new(x, y).expect(valid)),
            3 => Box::new(Cylinder::new(x, y).expect(valid)),
            4 => Box::new(Cone::new(x, y).expect(valid)),
            5 => Box::new(Ellipsoid::new(DVec3::ZERO, DVec3::new(x, y, z), DQuat::IDENTITY).expect(valid)),
            _ => Box::new(Rounded::new(Cuboid::new(DVec3::new(x, y, z)).expect(valid), 0.1).expect(valid)),
        }
    }
}

type AnyShape = Box<dyn SupportMap<Vector = DVec3>>;

fn moving(velocity_a: DVec3) -> Motion<DVec3> {
    Motion { velocity_a, velocity_b: DVec3::ZERO }
}

fn if_deeper() -> LinearCastOptions<DVec3> {
    LinearCastOptions::new().with_start_in_contact(StartInContact::IfDeeper)
}

/// Two shapes moved to their first contact, and the normal there.
fn in_contact(random: &mut Random, target: f64) -> Option<(Posed<AnyShape>, Posed<AnyShape>, DVec3, DVec3)> {
    let (a, b) = (random.shape(), random.shape());
    let from = random.direction() * 5.0;
    let velocity = random.direction() * 0.1 - from;
    let (rotation_a, rotation_b) = (random.rotation(), random.rotation());
    let a_at = |at| Posed::new(&a, rotation_a, at).expect("finite");
    let b = Posed::new(b, rotation_b, DVec3::ZERO).expect("finite");
    let options = if_deeper().with_target_distance(target);
    let hit = linear_cast(&a_at(from), &b, moving(velocity), options).expect("finite").outcome.hit()?;
    let place = from + velocity * hit.time;
    let n = hit.normal.expect("they begin apart");
    Some((Posed::new(a, rotation_a, place).expect("finite"), b, n, velocity))
}

#[test]
fn what_was_moved_to_its_contact_leaves_it_and_does_not_go_deeper() {
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    let (mut contacts, mut deeper) = (0, 0);
    for _ in 0..600 {
        let Some((a, b, n, velocity)) = in_contact(&mut random, 0.0) else { continue };
        contacts += 1;
        let cast = |velocity, options| linear_cast(&a, &b, moving(velocity), options).expect("finite");
        // Bounced off, slid along, and at rest.
        let bounced = velocity - n * (1.5 * n.dot(velocity));
        for leaving in [bounced, n, velocity - n * (1.01 * n.dot(velocity)), DVec3::ZERO] {
            let answer = cast(leaving, if_deeper());
            assert!(answer.outcome.is_miss(), "{leaving} off {n}: {answer:?}");
        }
        let again = cast(velocity, if_deeper());
        let hit = again.outcome.hit().unwrap_or_else(|| panic!("{velocity} into {n}: {again:?}"));
        assert!(hit.time < 1e-12, "{hit:?}");
        assert!((hit.normal.expect("a normal").length() - 1.0).abs() < 1e-12, "{hit:?}");
        deeper += 1;
        // What is reported has a unit normal where it touches.
        let reported = cast(bounced, LinearCastOptions::new());
        if let Some(hit) = reported.outcome.hit() {
            assert!(hit.normal.is_some_and(|n| (n.length() - 1.0).abs() < 1e-12), "{reported:?}");
        }
    }
    assert!(contacts > 500 && deeper == contacts, "{contacts} {deeper}");
}

#[test]
fn the_way_out_of_an_overlap_is_no_hit() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    for _ in 0..300 {
        let (a, b) = (random.shape(), random.shape());
        let a = Posed::new(a, random.rotation(), random.direction() * 0.3).expect("finite");
        let b = Posed::new(b, random.rotation(), DVec3::ZERO).expect("finite");
        let n = signed_distance(&a, &b, SignedDistanceOptions::new()).normal;
        let aside = random.direction();
        for velocity in [n, n + aside * 0.5, aside, -n] {
            let answer = linear_cast(&a, &b, moving(velocity), if_deeper()).expect("finite");
            let closing = -n.dot(velocity);
            match answer.outcome {
                Outcome::Hit(hit) => {
                    assert!(closing > 0.0 && hit.time == 0.0 && hit.normal == Some(n), "{closing} {answer:?}");
                }
                Outcome::Miss(miss) => assert!(closing <= 1e-14 && miss.axis == n, "{closing} {answer:?}"),
                Outcome::Undecided => panic!("{answer:?}"),
            }
        }
    }
}

/// Velocities of a box that touches another in a corner, and whether they take it away.
const FROM_A_CORNER: [([f64; 3], bool); 6] = [
    ([1.0, -1.0, -1.0], true),
    ([-1.0, 1.0, -1.0], true),
    ([-1.0, -1.0, 1.0], true),
    ([-1.0, -1.0, 0.0], true),
    ([-1.0, -1.0, -1.0], false),
    ([-3.0, -1.0, -0.01], false),
];

/// Corners that touch: one of the normals closes in, but the boxes part.
#[test]
fn boxes_that_touch_in_a_corner_part_along_another_normal() {
    let unit = cuboid::<DVec3>([1.0; 3]);
    let corner = at(unit, [2.0, 2.0, 2.0]);
    for (velocity, leaves) in FROM_A_CORNER {
        let answer = linear_cast(&corner, &unit, moving(v(velocity)), if_deeper()).expect("finite");
        assert_eq!(answer.outcome.is_miss(), leaves, "{velocity:?}: {answer:?}");
    }
}

/// Far from the origin a place is rounded, so that the boxes are in one another by two units in the last place, or as
/// far apart.
#[test]
fn so_do_boxes_far_away_whose_corners_touch_to_the_last_digits() {
    let unit = cuboid::<DVec3>([1.0; 3]);
    let still = at(unit, [100.0; 3]);
    let rounded = [-2.0, 0.0, 2.0].map(|ulps| 102.0 + ulps * 102.0 * f64::EPSILON);
    for (x, y, z) in (0..27).map(|i| (rounded[i % 3], rounded[i / 3 % 3], rounded[i / 9])) {
        let corner = at(unit, [x, y, z]);
        // What slides along the box may be within it by that much, and go on so.
        for (velocity, leaves) in FROM_A_CORNER.into_iter().filter(|(velocity, _)| !velocity.contains(&0.0)) {
            let answer = linear_cast(&corner, &still, moving(v(velocity)), if_deeper()).expect("finite");
            let is_told = answer.outcome.is_miss() == leaves && (leaves || answer.outcome.hit().is_some());
            assert!(is_told, "{velocity:?} from {:?}: {answer:?}", (x, y, z));
        }
    }
}

#[test]
fn resting_on_the_floor_in_single_precision_slides() {
    let floor = cuboid::<Vec3>([50.0, 1.0, 50.0]);
    let options = LinearCastOptions::new().with_start_in_contact(StartInContact::IfDeeper);
    for height in [1.5, 1.5 + ulps::<Vec3>(2.0), 1.5 - ulps::<Vec3>(2.0)] {
        let ball = at(Ball::<Vec3>::new(s::<Vec3>(0.5)).expect("positive"), [3.0, height, -20.0]);
        for (down, leaves) in [(0.0, true), (1e-9, true), (-1e-9, true), (0.1, true), (-0.1, false)] {
            let motion = Motion { velocity_a: v([1.0, down, 0.5]), velocity_b: Vec3::ZERO };
            let answer = linear_cast(&ball, &floor, motion, options).expect("finite");
            assert_eq!(answer.outcome.is_miss(), leaves, "{height} {down}: {answer:?}");
        }
    }
}

#[test]
fn a_target_distance_is_a_radius_more() {
    let mut random = Random(0xDA94_2042_E4DD_58B5);
    for _ in 0..200 {
        let (a, b) = (random.shape(), random.shape());
        let from = random.direction() * 6.0;
        let velocity = random.direction() * 0.3 - from;
        let target = random.number(0.0, 0.5);
        let b = Posed::new(b, random.rotation(), DVec3::ZERO).expect("finite");
        let rotation = random.rotation();
        let a_at = |at| Posed::new(&a, rotation, at).expect("finite");
        let options = LinearCastOptions::new().with_target_distance(target);
        let near = linear_cast(&a_at(from), &b, moving(velocity), options).expect("finite");
        let grown = Rounded::new(a_at(from), target).expect("positive");
        let rounded = linear_cast(&grown, &b, moving(velocity), LinearCastOptions::new()).expect("finite");
        assert_eq!((near.lower, near.upper), (rounded.lower, rounded.upper));
        let Some(hit) = near.outcome.hit() else {
            assert!(rounded.outcome.is_miss(), "{near:?}");
            continue;
        };
        let gap = distance(&a_at(from + velocity * hit.time), &b, DistanceOptions::default());
        assert!((gap.distance - target).abs() < 1e-12, "{gap:?} {target}");
        assert!(near.lower <= hit.time && hit.time <= near.upper, "{near:?}");
        let point = convex_support::Point::new(hit.point).expect("finite");
        let from_b = distance(&point, &b, DistanceOptions::default());
        assert!(from_b.distance < 1e-12, "the point is b's: {from_b:?}");
    }
}

#[test]
fn a_start_within_the_target_distance_counts_as_contact() {
    let floor = cuboid::<DVec3>([5.0, 1.0, 5.0]);
    let ball = at(Ball::<DVec3>::new(0.5).expect("positive"), [0.0, 1.6, 0.0]);
    let near = if_deeper().with_target_distance(0.2);
    let cast = |velocity, options| linear_cast(&ball, &floor, moving(velocity), options).expect("finite");
    assert!(cast(DVec3::Y, near).outcome.is_miss());
    assert!(cast(DVec3::X, near).outcome.is_miss());
    let hit = cast(DVec3::new(1.0, -1.0, 0.0), near).outcome.hit().expect("it comes nearer");
    assert_eq!((hit.time, hit.normal), (0.0, Some(DVec3::Y)));
    let reported = cast(DVec3::Y, LinearCastOptions::new().with_target_distance(0.2));
    assert_eq!(reported.outcome.hit().map(|hit| (hit.time, hit.normal)), Some((0.0, None)));
    let refused = RayCastError::NonFinite { parameter: "target_distance", index: 0 };
    for none in [f64::NAN, f64::INFINITY] {
        let options = LinearCastOptions::new().with_target_distance(none);
        assert_eq!(linear_cast(&ball, &floor, moving(DVec3::X), options).err(), Some(refused), "{none}");
    }
    let below = cast(DVec3::NEG_Y, LinearCastOptions::new().with_target_distance(-1.0));
    assert!(below.outcome.hit().is_some_and(|hit| (hit.time - 0.1).abs() < 1e-15), "{below:?}");
}

#[test]
fn a_motion_that_does_not_turn_is_asked_alike() {
    let floor = cuboid::<DVec2>([5.0, 1.0, 0.0]);
    let box_on_it = at(cuboid::<DVec2>([0.5, 0.5, 0.0]), [0.0, 1.5, 0.0]);
    let still = RigidMotion::translation(DVec2::ZERO);
    let options = MotionCastOptions::new().with_max_time(1.0).with_start_in_contact(StartInContact::IfDeeper);
    for (velocity, leaves) in [([0.0, 1.0], true), ([1.0, 0.0], true), ([1.0, -0.5], false)] {
        let motion = RigidMotion::translation(DVec2::from_array(velocity));
        let cast = motion_cast(&box_on_it, motion, &floor, still, options).expect("finite");
        assert_eq!(cast.outcome.is_miss(), leaves, "{velocity:?}: {cast:?}");
    }
}

#[test]
fn a_half_space_is_asked_alike() {
    let ground = HalfSpace::new(DVec3::Y * 2.0, 2.0).expect("a normal");
    let ball = at(Ball::<DVec3>::new(0.5).expect("positive"), [3.0, 1.5, 0.0]);
    for (velocity, leaves) in [(DVec3::Y, true), (DVec3::X, true), (DVec3::new(1.0, -1.0, 0.0), false)] {
        let cast = ground.linear_cast(&ball, moving(velocity), if_deeper()).expect("finite");
        assert_eq!(cast.outcome.is_miss(), leaves, "{velocity}: {cast:?}");
    }
    let above = at(Ball::<DVec3>::new(0.5).expect("positive"), [3.0, 2.5, 0.0]);
    let options = LinearCastOptions::new().with_target_distance(0.25);
    let cast = ground.linear_cast(&above, moving(DVec3::NEG_Y), options).expect("finite");
    let hit = cast.outcome.hit().expect("it falls");
    assert!((hit.time - 0.75).abs() < 1e-15 && hit.point.y == 1.0, "{hit:?}");
    assert!(cast.lower <= 0.75 && 0.75 <= cast.upper, "{cast:?}");

    let ray = Ray { source: DVec3::new(0.0, 0.5, 0.0), direction: DVec3::Y };
    let from = |lambda| RayCastOptions::new().with_min_lambda(lambda);
    assert_eq!(ground.ray_cast(ray, from(0.25)).expect("finite").outcome.hit().map(|hit| hit.lambda), Some(0.25));
    assert!(ground.ray_cast(ray, from(0.75)).expect("finite").outcome.is_miss());
}

#[test]
fn a_ray_leaves_where_its_reverse_enters() {
    let mut random = Random(0x1234_5678_9ABC_DEF1);
    let mut hits = 0;
    for _ in 0..500 {
        let shape = Posed::new(random.shape(), random.rotation(), random.direction()).expect("finite");
        let source = random.direction() * random.number(0.0, 4.0);
        let aim = shape.core().origin + random.direction() * 0.4;
        let ray = Ray { source, direction: (aim - source) * random.number(0.1, 10.0) };
        let exit = ray_exit(&shape, ray, RayCastOptions::new()).expect("finite");
        let back = Ray { source: ray.at(100.0), direction: -ray.direction };
        let entry = ray_cast(&shape, back, RayCastOptions::new()).expect("finite");
        let Some(hit) = exit.outcome.hit() else {
            assert!(entry.outcome.hit().is_none_or(|hit| hit.lambda >= 100.0 - 1e-9), "{exit:?} {entry:?}");
            continue;
        };
        hits += 1;
        let reverse = entry.outcome.hit().expect("the line leaves");
        let per_length = 1.0 / ray.direction.length();
        assert!((100.0 - reverse.lambda - hit.lambda).abs() < 1e-9 * (1.0 + per_length), "{exit:?} {entry:?}");
        assert!(exit.lower <= hit.lambda && hit.lambda <= exit.upper, "{exit:?}");
        let n = hit.normal.expect("it leaves");
        assert!(n.dot(ray.direction) > 0.0 && (n.length() - 1.0).abs() < 1e-12, "{exit:?}");

        // A beginning and an end cut what is between.
        let begin = random.number(0.0, 2.0);
        let first = ray_cast(&shape, ray, RayCastOptions::new()).expect("finite").outcome.hit().map(|hit| hit.lambda);
        let from = ray_cast(&shape, ray, RayCastOptions::new().with_min_lambda(begin)).expect("finite");
        let expected = first.filter(|_| begin <= hit.lambda).map(|first| first.max(begin));
        let found = from.outcome.hit().map(|hit| hit.lambda);
        assert_eq!(found.is_some(), expected.is_some(), "{first:?} {hit:?} from {begin}: {from:?}");
        if let (Some(found), Some(expected)) = (found, expected) {
            assert!((found - expected).abs() < 1e-12 * (1.0 + per_length), "{found} {expected}");
            assert!(from.lower <= found && found <= from.upper && from.lower >= begin, "{from:?}");
        }
        let cut = ray_exit(&shape, ray, RayCastOptions::new().with_max_lambda(begin)).expect("finite");
        let expected = first.filter(|&first| first <= begin).map(|_| hit.lambda.min(begin));
        assert_eq!(cut.outcome.hit().map(|hit| hit.lambda), expected, "{first:?} {hit:?} to {begin}: {cut:?}");
        let late = RayCastOptions::new().with_min_lambda(hit.lambda * 1.5 + 1.0);
        assert!(ray_exit(&shape, ray, late).expect("finite").outcome.is_miss());
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn exits_in_closed_form() {
    let ball = at(Ball::<DVec3>::new(2.0).expect("positive"), [10.0, 0.0, 0.0]);
    let exit = |lambda: f64| {
        let ray = Ray { source: DVec3::new(lambda, 1.0, 0.0), direction: DVec3::X * 4.0 };
        ray_exit(&ball, ray, RayCastOptions::new()).expect("finite")
    };
    let leaves = 10.0 + 3.0_f64.sqrt();
    for source in [-1e6, -3.0, 9.0, 10.0, 11.5] {
        let answer = exit(source);
        let truth = (leaves - source) / 4.0;
        assert!(answer.lower <= truth && truth <= answer.upper, "{answer:?} {truth}");
        assert!(
            (answer.outcome.hit().expect("it leaves").lambda - truth).abs() < 1e-15 * (8.0 + source.abs()),
            "{answer:?}"
        );
    }
    assert!(exit(11.8).outcome.is_miss());
    let far = Ray { source: DVec3::ZERO, direction: DVec3::Y };
    assert!(ray_exit(&ball, far, RayCastOptions::new()).expect("finite").outcome.is_miss());
    let nan = Ray { source: DVec3::NAN, direction: DVec3::Y };
    assert!(ray_exit(&ball, nan, RayCastOptions::new()).is_err());
}

/// The shadow ray of a point of a surface, to rounding of it or not, is not in the shadow of that surface.
#[test]
fn shadow_rays_leave_their_surface() {
    let mut random = Random(0x0F0F_F0F0_1357_9BDF);
    for _ in 0..300 {
        let shape = Posed::new(random.shape(), random.rotation(), random.direction()).expect("finite");
        let source = random.direction() * 6.0;
        let ray = Ray { source, direction: shape.core().origin - source };
        let Some(hit) = ray_cast(&shape, ray, RayCastOptions::new()).expect("finite").outcome.hit() else { continue };
        let n = hit.normal.expect("it starts outside");
        let light = (random.direction() + n * 1.1).normalize();
        let shadow = Ray { source: hit.point, direction: light };
        let answer = ray_cast(&shape, shadow, RayCastOptions::new().with_min_lambda(1e-6)).expect("finite");
        assert!(answer.outcome.is_miss(), "{answer:?}");
        // Into the shape it is hit where it begins.
        let into = Ray { source: hit.point, direction: -n };
        let inside = ray_cast(&shape, into, RayCastOptions::new().with_min_lambda(1e-6)).expect("finite");
        assert_eq!(inside.outcome.hit().map(|hit| (hit.lambda, hit.normal)), Some((1e-6, None)), "{inside:?}");
    }
}

#[test]
fn closest_points_begin_a_ray_alike() {
    let cuboid = cuboid::<DVec3>([1.0; 3]);
    let closest = |x: DVec3| Some(x.clamp(DVec3::NEG_ONE, DVec3::ONE));
    let ray = Ray { source: DVec3::new(-4.0, 0.25, 0.5), direction: DVec3::new(1.0, 0.01, -0.02) };
    for begin in [0.0, 1.0, 2.9, 3.5, 4.9, 5.1, 7.0] {
        let options = RayCastOptions::new().with_min_lambda(begin);
        let marched = iterative_ray_cast(closest, ray, options).expect("finite");
        let cast = ray_cast(&cuboid, ray, options).expect("finite");
        let lambdas = [marched.outcome.hit(), cast.outcome.hit()].map(|hit| hit.map(|hit| hit.lambda));
        match lambdas {
            [Some(x), Some(y)] => assert!((x - y).abs() < 1e-14, "{begin}: {lambdas:?}"),
            _ => assert!(marched.outcome.is_miss() && cast.outcome.is_miss(), "{begin}: {lambdas:?}"),
        }
    }
    let inside = at(Ball::<DVec3>::new(0.1).expect("positive"), [0.0; 3]);
    assert!(intersects(&inside, &cuboid, Default::default()).overlap);
}

const STILL: RigidMotion<DVec3> =
    RigidMotion { velocity: DVec3::ZERO, angular_velocity: DVec3::ZERO, center: DVec3::ZERO };

/// The same motion of a body on the ground, which ends at a height, asked of a box, of a half-space, and of a chain of
/// one joint.
fn on_the_ground<S: SupportMap<Vector = DVec3>>(
    body: &S,
    motion: RigidMotion<DVec3>,
    height: f64,
    until: f64,
) -> [MotionCast<DVec3>; 3] {
    let options = MotionCastOptions::new().with_max_time(until).with_start_in_contact(StartInContact::IfDeeper);
    let floor = at(cuboid::<DVec3>([8.0, 2.0, 8.0]), [0.0, height - 2.0, 0.0]);
    let ground = HalfSpace::new(DVec3::Y, height).expect("a normal");
    let (any, joint): (&dyn SupportMap<Vector = DVec3>, _) = (body, [motion]);
    [
        motion_cast(body, motion, &floor, STILL, options).expect("finite"),
        ground.motion_cast(any, motion, options).expect("finite"),
        motion_cast(body, ChainMotion::new(&joint), &floor, STILL, options).expect("finite"),
    ]
}

/// A ball that touches the floor and comes to rest for an instant, as it turns about an axis and falls at once, has
/// gone 0.9989 into the floor by 1.33. What closes in with no speed but that of rounding was looked for after a time
/// that is a quotient of roundings, so far ahead that it was out again.
#[test]
fn a_touching_ball_does_not_fall_through_the_floor() {
    let ball = at(Ball::<DVec3>::new(0.5).expect("positive"), [1.0, 1.5, 1.0]);
    let falling = RigidMotion {
        velocity: DVec3::new(0.0, -1.0, -1.0),
        angular_velocity: DVec3::X,
        center: DVec3::new(0.0, 0.0, 2.0),
    };
    for cast in on_the_ground(&ball, falling, 1.0, 2.0) {
        assert_eq!(cast.outcome.hit().map(|hit| hit.time), Some(0.0), "{cast:?}");
        assert!(cast.lower == 0.0 && cast.upper < 1e-3, "{cast:?}");
    }
}

/// About an axis below, what touches from above swings in from rest: it sinks with the square of time, and is deeper
/// from the start on, though no look at the start can tell.
#[test]
fn what_swings_in_from_rest_gets_deeper_at_once() {
    for i in 0..40 {
        let arm = 3.0 + 0.25 * f64::from(i);
        let lean = f64::from(i) * 0.7;
        let axis = DVec3::new(lean.cos(), 0.0, lean.sin()) * (0.1 + 0.05 * f64::from(i));
        let swinging = RigidMotion::rotation(axis, DVec3::new(0.25, 0.5 - arm, 0.5));
        let ball = at(Ball::<DVec3>::new(0.5).expect("positive"), [0.25, 0.5, 0.5]);
        let capsule = at(Capsule::<DVec3>::new(0.25, 0.25).expect("positive"), [0.25, 0.5, 0.5]);
        for cast in
            on_the_ground(&ball, swinging, 0.0, 1.0).into_iter().chain(on_the_ground(&capsule, swinging, 0.0, 1.0))
        {
            assert_eq!(cast.outcome.hit().map(|hit| hit.time), Some(0.0), "{arm}: {cast:?}");
            assert!(cast.lower == 0.0 && cast.upper < 1e-3, "{arm}: {cast:?}");
        }
    }
}

/// A ball on a circle begins in the floor, comes out and touches it again. Between two looks at an overlap it may have
/// been out: whole turns were skipped, since the ball was seen apart after some, and nobody had asked what was before.
#[test]
fn no_contact_after_leaving_is_skipped() {
    let (radius, circle) = (0.5, 0.2);
    // The deepest point of the circle, and the phase of the start.
    for (deep, phase) in [(0.01, 0.007), (0.01, 0.003), (0.2, 0.3), (0.39, 0.0), (0.3999, 0.1), (1e-6, 1e-4)] {
        let center = DVec3::Y * (radius - deep + circle);
        let start = center + DVec3::new(f64::sin(phase), -f64::cos(phase), 0.0) * circle;
        let ball = at(Ball::<DVec3>::new(radius).expect("positive"), start.to_array());
        let going_round = RigidMotion::rotation(DVec3::Z * TAU, center);
        let truth = (TAU - (1.0 - deep / circle).acos() - phase) / TAU;
        for cast in on_the_ground(&ball, going_round, 0.0, 3.5) {
            let hit = cast.outcome.hit().unwrap_or_else(|| panic!("{truth}: {cast:?}"));
            assert!((hit.time - truth).abs() < 1e-10, "{truth}: {cast:?}");
            let slack = 1e-15 / (deep + phase);
            assert!(cast.lower <= truth + slack && truth - slack <= cast.upper, "{truth}: {cast:?}");
        }
    }
}

/// Turning in place, rolling and sliding is no hit, whether the body touches or has sunk in. Of a box that turns about
/// the normal of the floor one plane proves that it gets no deeper in any time; that it stays in contact is proved step
/// by step.
#[test]
fn what_stays_as_deep_as_it_began_is_no_hit() {
    for sunk in [0.0, 0.25, 1e-3] {
        let place = [0.5, 0.5 - sunk, -0.25];
        let ball = at(Ball::<DVec3>::new(0.5).expect("positive"), place);
        let parcel = at(cuboid::<DVec3>([0.75, 0.5, 0.5]), place);
        let rolling = |axis: DVec3, velocity| RigidMotion { velocity, angular_velocity: axis, center: v(place) };
        let about_the_normal = DVec3::Y * 20.0;
        let still = [
            on_the_ground(&parcel, rolling(about_the_normal, DVec3::X), 0.0, 2.0),
            on_the_ground(&ball, rolling(about_the_normal, DVec3::ZERO), 0.0, 2.0),
        ];
        let round = [on_the_ground(&ball, rolling(DVec3::new(3.0, 1.0, -2.0), DVec3::new(1.0, 0.0, -1.0)), 0.0, 2.0)];
        // How a chain moves its bodies is bounded alike in all directions, so that it does not know what moves along
        // the floor.
        for cast in still.iter().chain(&round).flat_map(|casts| &casts[..2]) {
            assert!(cast.outcome.is_miss() && cast.lower == 2.0, "{sunk}: {cast:?}");
        }
        for cast in still.iter().chain(&round).map(|casts| casts[2]) {
            assert!(cast.outcome.hit().is_none(), "{sunk}: {cast:?}");
        }
    }
}

/// A rod 0.01 below the top of a block turns about the vertical, leaves the block, and its other end runs into the
/// block's edge after three eighths of a turn. It is never deeper than 0.01, and one plane proves that: but it was out,
/// and met the block again.
#[test]
fn what_left_by_the_side_meets_again() {
    let rod = Segment::new([DVec3::new(-1.0, -0.01, 0.0), DVec3::new(1.0, -0.01, 0.0)]).expect("finite");
    let rod = Rounded::new(rod, 0.0).expect("not negative");
    let block = at(cuboid::<DVec3>([0.5, 1.0, 0.5]), [1.0, -1.0, 0.0]);
    let options = MotionCastOptions::new().with_max_time(3.0).with_start_in_contact(StartInContact::IfDeeper);
    let turning = RigidMotion::rotation(DVec3::Y, DVec3::ZERO);
    let cast = motion_cast(&rod, turning, &block, STILL, options).expect("finite");
    let hit = cast.outcome.hit().unwrap_or_else(|| panic!("{cast:?}"));
    assert!((hit.time - 0.75 * PI).abs() < 1e-12, "{cast:?}");
}

/// Where two ways out of an overlap are equally short, it gets deeper only if both get longer. By the one normal that
/// the signed distance names, half of these motions were hits at 0.
#[test]
fn of_two_equal_ways_out_the_shorter_one_counts() {
    let unit = cuboid::<DVec3>([1.0; 3]);
    let corner = at(unit, [1.75, 1.75, 0.0]);
    for (velocity, deepens) in [
        ([1.0, -1.0, 0.0], false),
        ([-1.0, 1.0, 0.0], false),
        ([-3.0, 0.125, 0.0], false),
        ([0.125, -3.0, 1.0], false),
        ([-1.0, -1e-3, 0.5], true),
        ([-1e-3, -1.0, 0.5], true),
    ] {
        let answer = linear_cast(&corner, &unit, moving(v(velocity)), if_deeper()).expect("finite");
        assert_eq!(answer.outcome.hit().map(|hit| hit.time), deepens.then_some(0.0), "{velocity:?}: {answer:?}");
        assert_eq!(answer.outcome.is_miss(), !deepens, "{velocity:?}: {answer:?}");
    }
}
