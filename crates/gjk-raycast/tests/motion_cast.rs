//! Motion casts whose answers are known in closed form, and what is answered at the edges: at the start, at the end,
//! for bad input.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, TAU};

use crate::common::Random;
use crate::common::behind_pointers::{distance, linear_cast, motion_cast};
use convex_support::glam::{DQuat, DVec2, DVec3, Quat, Vec2, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Point, Posed, Rounded, Scalar as _, Segment, SupportMap,
};
use gjk_raycast::{
    DistanceOptions, LinearCastOptions, Motion, MotionCast, MotionCastOptions, Outcome, Pose, RayCastError,
    RigidMotion, StartInContact, Status, Trajectory,
};

const REST: RigidMotion<DVec2> = RigidMotion { velocity: DVec2::ZERO, angular_velocity: 0.0, center: DVec2::ZERO };
const STILL: RigidMotion<DVec3> =
    RigidMotion { velocity: DVec3::ZERO, angular_velocity: DVec3::ZERO, center: DVec3::ZERO };

fn at<S: SupportMap>(shape: S, translation: S::Vector) -> Posed<S> {
    Posed::translated(shape, translation).expect("finite")
}

fn until<V: convex_support::Vector>(max_time: V::Scalar) -> MotionCastOptions<V> {
    MotionCastOptions::new().with_max_time(max_time)
}

/// The answer is a hit whose narrow bracket holds the true time.
fn holds(cast: MotionCast<DVec2>, time: f64) {
    let hit = cast.outcome.hit().unwrap_or_else(|| panic!("{cast:?} is no hit"));
    // The truth is rounded, by a few ulps of its formula.
    let slack = 4.0 * f64::EPSILON * time;
    assert!(cast.lower <= time + slack && time - slack <= cast.upper, "{time} is not in {cast:?}");
    assert!(cast.upper - cast.lower < 1e-12 * time.max(1.0), "{cast:?} is wide");
    assert!((hit.time - time).abs() < 1e-13 * time.max(1.0), "{time} is not the time of {cast:?}");
}

#[test]
fn the_tip_of_a_rod_meets_a_wall() {
    let wall = at(Cuboid::new(DVec2::new(5.0, 1.0)).expect("positive"), DVec2::new(0.0, 2.0));
    for length in [1.01, 1.5, 4.0] {
        let rod = Segment::new([DVec2::ZERO, DVec2::new(length, 0.0)]).expect("finite");
        for rate in [1e-3, 0.7, 50.0] {
            let truth = (1.0 / length).asin() / rate;
            let swing = RigidMotion::rotation(rate, DVec2::ZERO);
            holds(motion_cast(&rod, swing, &wall, REST, until(10.0 / rate)).expect("finite"), truth);
            holds(motion_cast(&wall, REST, &rod, swing, until(10.0 / rate)).expect("finite"), truth);
        }
    }
}

#[test]
fn the_corner_of_a_box_that_spins_meets_a_wall() {
    // A square of half extent 1 reaches √2 at its corners, after an eighth of a turn.
    let square = Cuboid::new(DVec2::ONE).expect("positive");
    for distance in [1.001, 1.2, 1.41] {
        let wall = at(Cuboid::new(DVec2::new(0.5, 9.0)).expect("positive"), DVec2::new(distance + 0.5, 0.0));
        let truth = TAU / 8.0 - (distance / 2.0_f64.sqrt()).acos();
        let cast =
            motion_cast(&square, RigidMotion::rotation(1.0, DVec2::ZERO), &wall, REST, until(10.0)).expect("finite");
        let hit = cast.outcome.hit().expect("it meets");
        let slow = (TAU / 8.0 - truth).sin();
        assert!(cast.lower <= truth + 1e-15 / slow && truth - 1e-15 / slow <= cast.upper, "{truth} is not in {cast:?}");
        assert!((hit.time - truth).abs() < 1e-14 / slow, "{truth} is not the time of {cast:?}");
    }
    let wall = at(Cuboid::new(DVec2::new(0.5, 9.0)).expect("positive"), DVec2::new(1.9143, 0.0));
    let cast = motion_cast(&square, RigidMotion::rotation(1.0, DVec2::ZERO), &wall, REST, until(10.0)).expect("finite");
    assert!(cast.outcome.is_miss() && cast.lower == 10.0, "the corners pass by 1e-4, many times: {cast:?}");
}

#[test]
fn balls_that_spin_meet_as_if_they_did_not() {
    let ball = at(Ball::new(0.5).expect("positive"), DVec3::new(-4.0, 0.3, 0.0));
    let other = Ball::new(0.7).expect("positive");
    let spin = RigidMotion {
        velocity: DVec3::new(2.0, 0.0, 0.0),
        angular_velocity: DVec3::new(30.0, -20.0, 11.0),
        center: DVec3::new(-4.0, 0.3, 0.0),
    };
    let truth = (4.0 - (1.2_f64 * 1.2 - 0.3 * 0.3).sqrt()) / 2.0;
    let cast = motion_cast(&ball, spin, &other, STILL, until(5.0)).expect("finite");
    let hit = cast.outcome.hit().expect("they meet");
    assert!(
        cast.lower <= truth && truth <= cast.upper && cast.upper - cast.lower < 1e-13,
        "{truth} is not in {cast:?}"
    );
    let normal = DVec3::new(-4.0 + 2.0 * truth, 0.3, 0.0) / 1.2;
    assert!(
        (hit.normal.expect("apart at first") - normal).length() < 1e-13,
        "{hit:?} has another normal than {normal}"
    );
    assert!((hit.point - normal * 0.7).length() < 1e-13, "{hit:?} is elsewhere");
}

#[test]
fn a_ball_is_carried_round_against_a_wall() {
    // About zero at radius 3: its side is at y = 2 where 3·sin t + 0.5 = 2.
    let ball = at(Ball::new(0.5).expect("positive"), DVec3::new(3.0, 0.0, 0.0));
    let wall = at(Cuboid::new(DVec3::new(9.0, 1.0, 9.0)).expect("positive"), DVec3::new(0.0, 3.0, 0.0));
    let cast =
        motion_cast(&ball, RigidMotion::rotation(DVec3::Z, DVec3::ZERO), &wall, STILL, until(6.0)).expect("finite");
    assert!(cast.lower <= FRAC_PI_6 && FRAC_PI_6 <= cast.upper && cast.upper - cast.lower < 1e-13, "{cast:?}");
}

#[test]
fn a_capsule_sweeps_onto_a_ball() {
    // Along x at first, with radius 0.1; it touches the ball of radius 0.2 at distance 1 where sin(α) = 0.3.
    let rod = Rounded::new(Segment::new([DVec2::ZERO, DVec2::new(2.0, 0.0)]).expect("finite"), 0.1).expect("positive");
    let ball = at(Ball::new(0.2).expect("positive"), DVec2::new(0.0, 1.0));
    let truth = FRAC_PI_2 - 0.3_f64.asin();
    holds(motion_cast(&rod, RigidMotion::rotation(1.0, DVec2::ZERO), &ball, REST, until(6.0)).expect("finite"), truth);
}

#[test]
fn an_ellipse_that_spins_meets_a_wall() {
    // It reaches √(a²cos² + b²sin²) along x.
    let ellipse = Ellipsoid::new(DVec2::ZERO, DVec2::new(1.0, 2.0), 0.0).expect("positive");
    let wall = at(Cuboid::new(DVec2::new(1.0, 9.0)).expect("positive"), DVec2::new(2.5, 0.0));
    let truth = (1.25_f64 / 3.0).sqrt().asin();
    holds(
        motion_cast(&ellipse, RigidMotion::rotation(1.0, DVec2::ZERO), &wall, REST, until(6.0)).expect("finite"),
        truth,
    );
}

#[test]
fn thin_things_are_not_stepped_over() {
    for thickness in [1e-2, 1e-4, 1e-6] {
        let plate = Cuboid::new(DVec3::new(thickness, 1.0, 1.0)).expect("positive");
        let bullet = at(Capsule::new(0.1, 0.01).expect("positive"), DVec3::new(-500.0, 0.0, 0.0));
        let shot = RigidMotion {
            velocity: DVec3::new(1000.0, 0.0, 0.0),
            angular_velocity: DVec3::new(0.0, 0.0, 60.0),
            center: DVec3::new(-500.0, 0.0, 0.0),
        };
        let cast = motion_cast(&bullet, shot, &plate, STILL, until(1.0)).expect("finite");
        let hit = cast.outcome.hit().expect("it strikes");
        assert!((0.4998..0.5).contains(&hit.time) && cast.upper - cast.lower < 1e-12, "{thickness}: {cast:?}");
    }
}

#[test]
fn a_motion_between_poses_takes_one_to_the_other() {
    let (p, q) = (DVec3::new(1.0, 2.0, -1.0), DVec3::new(-3.0, 0.5, 2.0));
    let from = Pose { rotation: DQuat::from_xyzw(0.1, 0.7, -0.2, 0.6), translation: p };
    let to = Pose { rotation: DQuat::from_xyzw(-0.5, 0.4, 0.3, -0.9), translation: q };
    let place = |pose: Pose<DVec3>, x: DVec3| pose.rotation.normalize() * x + pose.translation;
    for motion in [RigidMotion::between(from, to, 2.5), RigidMotion::screw_between(from, to, 2.5)] {
        for x in [DVec3::ZERO, DVec3::X, DVec3::new(3.0, -2.0, 5.0)] {
            let moved = motion.displacement(2.5).of(place(from, x));
            assert!((moved - place(to, x)).length() < 1e-14, "{moved} is not {}", place(to, x));
        }
    }
    let screw = RigidMotion::screw_between(from, to, 2.5);
    let along = screw.velocity.cross(screw.angular_velocity).length();
    assert!(along < 1e-14, "a screw moves along its axis: {screw:?}");
}

#[test]
fn a_motion_ends_when_it_ends() {
    let rod = Segment::new([DVec2::ZERO, DVec2::new(2.0, 0.0)]).expect("finite");
    let wall = at(Cuboid::new(DVec2::new(5.0, 1.0)).expect("positive"), DVec2::new(0.0, 2.0));
    let swing = RigidMotion::rotation(1.0, DVec2::ZERO);
    let cast = |end| motion_cast(&rod, swing, &wall, REST, until(end)).expect("finite");
    let whole = cast(10.0);
    assert!(cast(whole.upper).outcome.hit().is_some(), "the end belongs to the motion");
    assert!(cast(whole.lower).outcome.is_miss(), "before, it misses");
    assert!(cast(0.0).outcome.is_miss(), "at the start they are apart");
    assert!(cast(-1.0).outcome.is_miss(), "no end before the start");
}

#[test]
fn no_end_is_an_end_too() {
    let rod = Segment::new([DVec2::ZERO, DVec2::new(2.0, 0.0)]).expect("finite");
    let swing = RigidMotion { velocity: DVec2::new(0.0, -1.0), angular_velocity: 1.0, center: DVec2::ZERO };
    let above = at(Ball::new(1.0).expect("positive"), DVec2::new(0.0, 3.5));
    let cast = motion_cast(&rod, swing, &above, REST, MotionCastOptions::new()).expect("finite");
    assert!(cast.outcome.is_miss(), "it leaves for ever: {cast:?}");
    let below = at(Ball::new(1.0).expect("positive"), DVec2::new(0.0, -350.0));
    let cast = motion_cast(&rod, swing, &below, REST, MotionCastOptions::new()).expect("finite");
    assert!(cast.outcome.hit().is_some(), "it gets there at last: {cast:?}");
}

#[test]
fn contact_at_the_start() {
    let floor = Cuboid::new(DVec2::new(10.0, 1.0)).expect("positive");
    let parcel = at(Cuboid::new(DVec2::ONE).expect("positive"), DVec2::new(0.0, 2.0));
    let tilt = |velocity: f64| RigidMotion {
        velocity: DVec2::new(0.0, velocity),
        angular_velocity: 0.1,
        center: DVec2::new(0.0, 2.0),
    };
    for velocity in [-1.0, 5.0] {
        let cast = motion_cast(&parcel, tilt(velocity), &floor, REST, until(1.0)).expect("finite");
        assert_eq!((cast.outcome.hit().map(|hit| hit.time), cast.lower), (Some(0.0), 0.0), "they touch: {cast:?}");
    }
    let leaving = until(1.0).with_start_in_contact(StartInContact::IfDeeper);
    let cast = motion_cast(&parcel, tilt(5.0), &floor, REST, leaving).expect("finite");
    assert!(cast.outcome.is_miss(), "it leaves: {cast:?}");
    let cast = motion_cast(&parcel, tilt(-1.0), &floor, REST, leaving).expect("finite");
    assert_eq!(cast.outcome.hit().map(|hit| hit.time), Some(0.0), "it does not: {cast:?}");

    let sunk = at(Cuboid::new(DVec2::ONE).expect("positive"), DVec2::new(0.0, 1.9));
    let cast = motion_cast(&sunk, tilt(5.0), &floor, REST, until(1.0)).expect("finite");
    assert_eq!((cast.outcome.hit().map(|hit| hit.time), cast.lower, cast.upper), (Some(0.0), 0.0, 0.0), "{cast:?}");
    let cast = motion_cast(&sunk, tilt(5.0), &floor, REST, leaving).expect("finite");
    assert!(cast.outcome.is_miss(), "it gets out: {cast:?}");
}

#[test]
fn a_target_distance_stops_short() {
    let rod = Segment::new([DVec2::ZERO, DVec2::new(2.0, 0.0)]).expect("finite");
    let wall = at(Cuboid::new(DVec2::new(5.0, 1.0)).expect("positive"), DVec2::new(0.0, 2.0));
    let options = until(10.0).with_target_distance(0.25);
    let swing = RigidMotion::rotation(1.0, DVec2::ZERO);
    holds(motion_cast(&rod, swing, &wall, REST, options).expect("finite"), 0.375_f64.asin());
    let lift = RigidMotion::translation(DVec2::new(0.0, 1.0));
    holds(motion_cast(&rod, lift, &wall, REST, options).expect("finite"), 0.75);
}

#[test]
fn what_nobody_can_know_is_not_claimed() {
    let square = Cuboid::new(DVec2::ONE).expect("positive");
    let wall = at(Cuboid::new(DVec2::new(0.5, 9.0)).expect("positive"), DVec2::new(1.75, 0.0));
    let far = at(Cuboid::new(DVec2::new(0.5, 9.0)).expect("positive"), DVec2::new(17.5, 0.0));
    let spin = RigidMotion { velocity: DVec2::ZERO, angular_velocity: 1e300, center: DVec2::ZERO };
    let cast = motion_cast(&square, spin, &far, REST, until(1.0)).expect("finite");
    assert!(cast.outcome.is_miss(), "however fast it spins it does not reach: {cast:?}");
    let cast = motion_cast(&square, spin, &wall, REST, until(1e10)).expect("finite");
    let sound = match cast.outcome {
        Outcome::Hit(hit) => hit.time < 1e-299,
        Outcome::Undecided => cast.status != Status::Converged,
        Outcome::Miss(_) => false,
    };
    assert!(sound, "it meets the wall at once: {cast:?}");

    // It touches once a turn, to rounding.
    let touched = at(Cuboid::new(DVec2::new(0.5, 9.0)).expect("positive"), DVec2::new(0.5 + 2.0_f64.sqrt(), 0.0));
    let cast =
        motion_cast(&square, RigidMotion::rotation(1.0, DVec2::ZERO), &touched, REST, until(1.0)).expect("finite");
    assert!(cast.lower <= TAU / 8.0 && (cast.upper >= TAU / 8.0), "{cast:?}");
    assert!(!cast.outcome.is_miss(), "a graze is no miss: {cast:?}");
}

#[test]
fn bad_input_is_refused() {
    let ball = Ball::new(1.0).expect("positive");
    let other = at(ball, DVec3::new(5.0, 0.0, 0.0));
    let nan = f64::NAN;
    let cast = |motion, options| motion_cast(&ball, motion, &other, STILL, options);
    for motion in [
        RigidMotion { velocity: DVec3::new(0.0, nan, 0.0), ..STILL },
        RigidMotion { angular_velocity: DVec3::new(0.0, f64::INFINITY, 0.0), ..STILL },
        RigidMotion { center: DVec3::new(0.0, nan, 0.0), ..STILL },
    ] {
        let refused = Err(RayCastError::NonFinite { parameter: "motion_a", index: 1 });
        assert_eq!(cast(motion, until(1.0)), refused, "{motion:?}");
    }
    for (options, parameter) in [
        (until(nan), "max_time"),
        (until(1.0).with_tolerance(nan), "tolerance"),
        (until(1.0).with_target_distance(nan), "target_distance"),
    ] {
        assert_eq!(cast(STILL, options), Err(RayCastError::NonFinite { parameter, index: 0 }));
    }
    let cast = cast(STILL, until(1.0)).expect("finite");
    assert!(cast.outcome.is_miss(), "nothing moves: {cast:?}");
}

#[test]
fn single_precision() {
    let rod = Segment::new([Vec2::ZERO, Vec2::new(2.0, 0.0)]).expect("finite");
    let wall = at(Cuboid::new(Vec2::new(5.0, 1.0)).expect("positive"), Vec2::new(0.0, 2.0));
    let swing = RigidMotion::rotation(1.0_f32, Vec2::ZERO);
    let cast = motion_cast(&rod, swing, &wall, RigidMotion::default(), until(10.0_f32)).expect("finite");
    assert!(f64::from(cast.lower) <= FRAC_PI_6 && FRAC_PI_6 <= f64::from(cast.upper), "{cast:?}");
    assert!(cast.upper - cast.lower < 1e-5, "{cast:?}");

    let ball = at(Ball::new(0.5).expect("positive"), Vec3A::new(3.0, 0.0, 0.0));
    let wall = at(Cuboid::new(Vec3A::new(9.0, 1.0, 9.0)).expect("positive"), Vec3A::new(0.0, 3.0, 0.0));
    let carried = RigidMotion::rotation(Vec3A::Z, Vec3A::ZERO);
    let cast = motion_cast(&ball, carried, &wall, RigidMotion::default(), until(6.0_f32)).expect("finite");
    assert!(f64::from(cast.lower) <= FRAC_PI_6 && FRAC_PI_6 <= f64::from(cast.upper), "{cast:?}");
    assert!(cast.upper - cast.lower < 1e-5, "{cast:?}");
}

/// The square of the velocity overflows, and with it the time at which balls about the bodies are nearest. That is no
/// proof of a miss.
#[test]
fn what_turns_and_moves_very_fast_is_not_proved_to_miss() {
    let cube = Cuboid::new(DVec3::ONE).expect("positive");
    let wall = at(Cuboid::new(DVec3::ONE).expect("positive"), DVec3::new(9.0, 0.0, 0.0));
    for speed in [1e150, 1e155, 1e200] {
        let motion = RigidMotion {
            velocity: DVec3::new(speed, 0.0, 0.0),
            angular_velocity: DVec3::new(1.0, 2.0, 3.0),
            center: DVec3::ZERO,
        };
        let cast = motion_cast(&cube, motion, &wall, RigidMotion::default(), until(1.0)).expect("finite");
        assert!(!cast.outcome.is_miss(), "{speed:e}: {cast:?}");
    }
}

/// A ball that spins about its centre meets a box when it would without spinning, and is so small that polytopes within
/// their difference are slivers: zero may be far from one and hardly beyond any facet's plane.
#[test]
fn a_tiny_ball_that_spins_meets_a_box() {
    let (radius, half_extents) = (4.223_605e-5_f32, Vec3A::new(0.611_282_65, 0.855_645_1, 0.692_111_6));
    let rotation = Quat::from_xyzw(0.562_041_04, -0.081_490_494, 0.024_962_984, 0.773_256_24);
    let start = Vec3A::new(0.276_623_34, 0.496_512_4, -1.056_860_9);
    let velocity = Vec3A::new(-0.585_350_1, -0.690_051_6, 1.483_397_5);
    let ball = at(Ball::new(radius).expect("positive"), start);
    let target = Posed::new(Cuboid::new(half_extents).expect("positive"), rotation, Vec3A::ZERO).expect("finite");
    let spins =
        RigidMotion { velocity, angular_velocity: Vec3A::new(-2.658_666, 1.262_782_1, -4.283_83), center: start };
    let cast = motion_cast(&ball, spins, &target, RigidMotion::default(), until(0.7)).expect("finite");

    let ball = at(Ball::new(f64::from(radius)).expect("positive"), start.as_dvec3());
    let cuboid = Cuboid::new(half_extents.as_dvec3()).expect("positive");
    let target = Posed::new(cuboid, rotation.as_dquat(), DVec3::ZERO).expect("finite");
    let motion = Motion { velocity_a: velocity.as_dvec3(), velocity_b: DVec3::ZERO };
    let truth = linear_cast(&ball, &target, motion, LinearCastOptions::new()).expect("finite");
    assert!(f64::from(cast.lower) <= truth.upper && truth.lower <= f64::from(cast.upper), "{cast:?} {truth:?}");
}

/// A needle swings through a plate. A search for their depth that came to no end found a plane between them on the far
/// side, and the gap of that was told of the plane on the near side, where they were in one another: so they were
/// proved to be apart all the way.
#[test]
fn a_needle_does_not_pass_through_a_plate() {
    let needle = Posed::new(
        Cone::<Vec3A>::new(0.01, 0.0001).expect("positive"),
        Quat::from_xyzw(-0.171_572_67, -0.006_724_925, 0.505_764_6, -0.096_517_436),
        Vec3A::new(1.207_028_5, 1.634_110_5, 2.273_767),
    )
    .expect("finite");
    let plate = Posed::new(
        Cone::<Vec3A>::new(0.0001, 0.792_824_1).expect("positive"),
        Quat::from_xyzw(-0.095_159_43, 0.042_797_938, -0.620_893_96, 0.875_209_4),
        Vec3A::new(1.498_158_1, 0.915_896_8, 2.482_680_8),
    )
    .expect("finite");
    let swing = RigidMotion {
        velocity: Vec3A::new(0.900_889_64, -0.635_046_3, -0.319_058_57),
        angular_velocity: Vec3A::new(-1.647_986_7, 2.552_248_2, 0.783_116_3),
        center: Vec3A::new(1.374_358_2, 0.911_760_2, 3.262_739_4),
    };
    let cast = motion_cast(&needle, swing, &plate, RigidMotion::default(), until(1.0_f32)).expect("finite");
    // In double precision.
    assert!(!cast.outcome.is_miss() && cast.lower <= 9.702_485e-6 && 9.702_484e-6 <= cast.upper, "{cast:?}");
}

/// Bodies without an inside: what has passed through another was never deeper in it than rounding, and yet they have
/// met.
fn pass_through<V: convex_support::Vector>(cast: MotionCast<V>, time: f64) {
    let hit = cast.outcome.hit().unwrap_or_else(|| panic!("{cast:?} is no hit"));
    let rounding = 64.0 * V::Scalar::EPSILON.as_f64();
    let [lower, upper, at] = [cast.lower, cast.upper, hit.time].map(convex_support::Scalar::as_f64);
    assert!(lower <= time * (1.0 + rounding) && time * (1.0 - rounding) <= upper, "{time} is not in {cast:?}");
    assert!(
        upper - lower < 64.0 * rounding && (at - time).abs() < 4.0 * rounding,
        "{time} is not the time of {cast:?}"
    );
}

#[test]
fn a_point_passes_through_a_rod_and_a_plate() {
    let rod = Segment::new([DVec2::ZERO, DVec2::X]).expect("finite");
    let swing = RigidMotion::rotation(1.0, DVec2::ZERO);
    for angle in [0.3, 1.0, 3.0] {
        let point = at(Cuboid::new(DVec2::ZERO).expect("not negative"), DVec2::from_angle(angle) * 0.4);
        pass_through(motion_cast(&rod, swing, &point, REST, until(4.0)).expect("finite"), angle);
        pass_through(motion_cast(&point, REST, &rod, swing, until(4.0)).expect("finite"), angle);
        // Beyond its tip it is missed.
        let beyond = at(Cuboid::new(DVec2::ZERO).expect("not negative"), DVec2::from_angle(angle) * 1.001);
        let miss = motion_cast(&rod, swing, &beyond, REST, until(4.0)).expect("finite");
        assert!(miss.outcome.is_miss(), "{miss:?}");
    }
    let swing = RigidMotion::rotation(1.0, Vec2::ZERO);
    let rod = Segment::new([Vec2::ZERO, Vec2::X]).expect("finite");
    let point = at(Cuboid::new(Vec2::ZERO).expect("not negative"), Vec2::from_angle(0.8) * 0.4);
    let rest = RigidMotion { velocity: Vec2::ZERO, angular_velocity: 0.0, center: Vec2::ZERO };
    pass_through(motion_cast(&rod, swing, &point, rest, until(4.0)).expect("finite"), 0.8);
    // A door in the plane x = 0 is hung on the z axis.
    let door = at(Cuboid::new(DVec3::new(0.5, 0.0, 1.0)).expect("not negative"), DVec3::X * 0.5);
    let swing = RigidMotion::rotation(DVec3::Z, DVec3::ZERO);
    let spot = DVec2::from_angle(0.6) * 0.7;
    let point = at(Cuboid::new(DVec3::ZERO).expect("not negative"), spot.extend(0.3));
    pass_through(motion_cast(&door, swing, &point, STILL, until(4.0)).expect("finite"), 0.6);
    // A point that turns, too, and a disc instead of the door.
    let disc = Cylinder::new(0.0, 1.0).expect("not negative");
    let falls = RigidMotion { velocity: -DVec3::Y, angular_velocity: DVec3::ONE, center: DVec3::new(0.3, 2.0, 0.1) };
    let point = at(Cuboid::new(DVec3::ZERO).expect("not negative"), falls.center);
    pass_through(motion_cast(&point, falls, &disc, STILL, until(4.0)).expect("finite"), 2.0);
}

#[test]
fn rods_pass_through_one_another() {
    let rod = Segment::new([DVec3::ZERO, DVec3::X]).expect("finite");
    let swing = RigidMotion::rotation(DVec3::Z, DVec3::ZERO);
    for angle in [0.3, 1.0, 3.0] {
        let post = at(
            Segment::new([-DVec3::Z, DVec3::Z * 0.5]).expect("finite"),
            (DVec2::from_angle(angle) * 0.4).extend(0.0),
        );
        pass_through(motion_cast(&rod, swing, &post, STILL, until(4.0)).expect("finite"), angle);
        let thin =
            at(Capsule::<DVec3>::new(0.5, 0.0).expect("not negative"), (DVec2::from_angle(angle) * 0.4).extend(0.0));
        let tilted = Posed::new(thin, DQuat::IDENTITY, DVec3::ZERO).expect("a pose");
        let beside = motion_cast(&rod, swing, &at(tilted, DVec3::Z * 0.01), STILL, until(4.0)).expect("finite");
        assert!(beside.outcome.is_miss(), "a hundredth above: {beside:?}");
    }
}

/// The way out of an overlap leads from the deepest point of one body to that of the other, and neither need be in
/// both: of a small body deep in a large one, the other's is on the far surface. A hit at the start once told one of
/// them, up to 0.17 sizes outside.
#[test]
fn the_point_of_an_overlap_at_the_start_is_in_both_bodies() {
    let mut random = Random(0x0070_1234_5678);
    let mut vector = |size: f64| DVec3::from_array([0; 3].map(|_| random.number(-size, size)));
    let mut asked = 0;
    for i in 0..120 {
        let sizes = vector(1.0).abs() + 0.05;
        let solids: [Box<dyn SupportMap<Vector = DVec3>>; 2] =
            [sizes, DVec3::new(sizes.z, sizes.x, sizes.y)].map(|size| {
                let [radius, half_height, half_width] = size.to_array();
                let solid: Box<dyn SupportMap<Vector = DVec3>> = match i % 3 {
                    0 => Box::new(Cone::<DVec3>::new(half_height, radius).expect("positive")),
                    1 => Box::new(Cylinder::<DVec3>::new(half_height, radius).expect("positive")),
                    _ => Box::new(
                        Rounded::new(Cuboid::<DVec3>::new(size).expect("positive"), half_width).expect("positive"),
                    ),
                };
                solid
            });
        let [turn_a, turn_b] = [vector(1.0), vector(1.0)].map(|v| DQuat::from_xyzw(v.x, v.y, v.z, 0.3).normalize());
        let [a, b] = solids;
        let a = Posed::new(a, turn_a, vector(0.6)).expect("finite");
        let b = Posed::new(b, turn_b, DVec3::ZERO).expect("finite");
        let turning = RigidMotion { velocity: vector(1.0), angular_velocity: vector(1.0), center: DVec3::ZERO };
        let cast = motion_cast(&a, turning, &b, STILL, until(1.0)).expect("finite");
        let Some(hit) = cast.outcome.hit().filter(|hit| hit.time == 0.0 && hit.normal.is_none()) else { continue };
        asked += 1;
        let point = Point::new(hit.point).expect("finite");
        for body in [&a, &b] {
            let off = distance(&point, body, DistanceOptions::new());
            assert!(off.distance <= 1e-14, "{i}: {:?} is {} outside", hit.point, off.distance);
        }
    }
    assert!(asked > 60, "{asked} overlap at the start");
}
