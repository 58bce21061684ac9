//! Motion casts against half-spaces: closed forms, what is proved against dense sampling, and what is answered at the
//! edges.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, SQRT_2, TAU};

use crate::common::behind_pointers::motion_cast;
use crate::common::space::{Space, spin};
use crate::common::{Random, s, v};
use convex_support::glam::{DQuat, DVec2, DVec3, Vec2, Vec3A};
use convex_support::{
    Ball, Capsule, Cuboid, Ellipsoid, Polytope, Posed, Rotation, Scalar, Segment, SupportMap, Vector,
};
use gjk_raycast::{
    ChainMotion, HalfSpace, MotionCast, MotionCastOptions, Outcome, RayCastError, RigidMotion, StartInContact, Status,
};

/// The half-space below a height.
fn floor<V: Vector>(height: f64) -> HalfSpace<V> {
    HalfSpace::new(v([0.0, 1.0, 0.0]), s::<V>(height)).expect("a normal")
}

fn until<V: Vector>(max_time: f64) -> MotionCastOptions<V> {
    MotionCastOptions::new().with_max_time(s::<V>(max_time))
}

/// The answer is a hit whose narrow bracket holds the true time.
fn holds<V: Vector>(cast: MotionCast<V>, time: f64) {
    let hit = cast.outcome.hit().unwrap_or_else(|| panic!("{cast:?} is no hit"));
    // The truth is rounded, by a few ulps of its formula.
    let slack = 4.0 * f64::EPSILON * time;
    let [lower, upper, found] = [cast.lower, cast.upper, hit.time].map(Scalar::as_f64);
    assert!(lower <= time + slack && time - slack <= upper, "{time} is not in {cast:?}");
    let narrow = 1e3 * V::Scalar::EPSILON.as_f64() * time.max(1.0);
    assert!(upper - lower < narrow && (found - time).abs() < narrow, "{time}: {cast:?} is wide");
    assert_eq!(cast.status, Status::Converged, "{cast:?}");
}

#[test]
fn the_tip_of_a_rod_meets_the_floor() {
    for length in [1.5, 4.0] {
        for rate in [1e-3, 0.7, 50.0] {
            let truth = (1.0_f64 / length).asin() / rate;
            let rod = Segment::new([DVec2::ZERO, DVec2::new(length, 0.0)]).expect("finite");
            let swing = RigidMotion::rotation(-rate, DVec2::ZERO);
            let cast = floor(-1.0).motion_cast(&rod, swing, until(10.0 / rate)).expect("finite");
            holds(cast, truth);
            // Turned back at the start, it is there later.
            let hit = cast.outcome.hit().expect("a hit");
            let gradient = hit.gradient(&swing, &RigidMotion::default()).expect("it falls");
            let later = gradient.pose_a.rotation_about(DVec2::ZERO) * rate;
            assert!((later - 1.0).abs() < 1e-12, "{later}");
            let rod = Segment::new([DVec3::ZERO, DVec3::new(length, 0.0, 0.0)]).expect("finite");
            let swing = RigidMotion::rotation(DVec3::Z * -rate, DVec3::ZERO);
            holds(floor(-1.0).motion_cast(&rod, swing, until(10.0 / rate)).expect("finite"), truth);
        }
    }
    // In single precision, of numbers that are exact in it.
    let rod = Segment::new([Vec2::ZERO, Vec2::new(4.0, 0.0)]).expect("finite");
    let cast = floor(-1.0).motion_cast(&rod, RigidMotion::rotation(-0.5, Vec2::ZERO), until(9.0)).expect("finite");
    holds(cast, 0.25_f64.asin() / 0.5);
}

/// The bound of what turns is a product of two angular velocities, whose square underflows of such as these. Taken for
/// zero, it proves that what is above the floor at both ends is so all the way.
#[test]
fn turning_ever_so_slowly_is_turning() {
    for exponent in [-6, -12, -15, -18] {
        let rate = 10.0_f32.powi(exponent);
        let rod = Segment::new([Vec2::ZERO, Vec2::new(2.0, 0.0)]).expect("finite");
        let swing = RigidMotion::rotation(-rate, Vec2::ZERO);
        let cast = floor(-1.0).motion_cast(&rod, swing, MotionCastOptions::new().with_max_time(3.125 / rate));
        let cast = cast.expect("finite");
        let hit = cast.outcome.hit().unwrap_or_else(|| panic!("{rate}: {cast:?}"));
        assert!((hit.time * rate - PI as f32 / 6.0).abs() < 1e-5, "{rate}: {cast:?}");
    }
    for exponent in [-70, -90, -140] {
        let rate = 10.0_f64.powi(exponent);
        let rod = Segment::new([DVec2::ZERO, DVec2::new(2.0, 0.0)]).expect("finite");
        let cast = floor(-1.0).motion_cast(&rod, RigidMotion::rotation(-rate, DVec2::ZERO), until(3.125 / rate));
        let cast = cast.expect("finite");
        let hit = cast.outcome.hit().unwrap_or_else(|| panic!("{rate}: {cast:?}"));
        assert!((hit.time * rate - PI / 6.0).abs() < 1e-14, "{rate}: {cast:?}");
    }
}

#[test]
fn curved_bodies_roll_and_tumble() {
    // An ellipse that turns by the angle a reaches √((3·sin a)² + cos² a) down.
    let ellipse = Ellipsoid::new(DVec2::ZERO, DVec2::new(3.0, 1.0), 0.0).expect("positive");
    let truth = ((2.0_f64 * 2.0 - 1.0) / 8.0).sqrt().asin();
    let turning = RigidMotion::rotation(1.0, DVec2::ZERO);
    let cast = floor(-2.0).motion_cast(&ellipse, turning, until(9.0)).expect("finite");
    holds(cast, truth);
    let hit = cast.outcome.hit().expect("a hit");
    assert!(hit.normal == Some(DVec2::Y) && (hit.point.y + 2.0).abs() < 1e-14, "{hit:?}");

    // A ball that spins about its middle falls as one that does not.
    let ball = Posed::translated(Ball::new(0.5).expect("positive"), DVec3::Y * 3.0).expect("finite");
    let fall = RigidMotion {
        velocity: DVec3::new(30.0, -2.0, 0.0),
        angular_velocity: DVec3::new(3.0, -9.0, 20.0),
        center: DVec3::Y * 3.0,
    };
    holds(floor(0.0).motion_cast(&ball, fall, until(f64::INFINITY)).expect("finite"), 1.25);

    // A forearm of length 1 at the end of an upper arm of length 1, both along x: the hand is −sin a − sin 3a high.
    let hand = Posed::translated(Ball::new(0.25).expect("positive"), DVec3::X * 2.0).expect("finite");
    let joints = [RigidMotion::rotation(-DVec3::Z, DVec3::ZERO), RigidMotion::rotation(DVec3::Z * -2.0, DVec3::X)];
    let height = |a: f64| -a.sin() - (3.0 * a).sin();
    let cast = floor(-1.0).motion_cast(&hand, ChainMotion::new(&joints), until(1.0)).expect("finite");
    let hit = cast.outcome.hit().expect("a hit");
    assert!((height(hit.time) + 0.75).abs() < 1e-14 && cast.upper - cast.lower < 1e-13, "{cast:?}");
}

#[test]
fn a_body_far_along_the_floor_is_known_as_well() {
    // A cube with its middle 1.2 above the floor, turning about it.
    let truth = FRAC_PI_4 - (1.2 / SQRT_2).acos();
    for far in [0.0, 1e3, 1e9] {
        let middle = DVec3::new(far, 1.2, -far);
        let cube = Posed::translated(Cuboid::new(DVec3::ONE).expect("positive"), middle).expect("finite");
        let cast = floor(0.0).motion_cast(&cube, RigidMotion::rotation(DVec3::Z, middle), until(9.0)).expect("finite");
        holds(cast, truth);
        assert!(cast.upper - cast.lower < 1e-13, "{far}: {cast:?}");
    }
}

#[test]
fn the_length_of_the_normal_does_not_matter() {
    let cube = Cuboid::new(DVec3::ONE).expect("positive");
    let turning = RigidMotion::rotation(DVec3::new(0.3, 0.2, 1.0), DVec3::new(0.0, 0.5, 0.0));
    let cast = |length: f64| {
        let below = HalfSpace::new(DVec3::new(0.25, 1.0, -0.5) * length, -1.25 * length).expect("a normal");
        below.motion_cast(&cube, turning, until(9.0)).expect("finite")
    };
    assert!(cast(1.0).outcome.hit().is_some(), "{:?}", cast(1.0));
    for exponent in [-900, -500, -1, 1, 500, 900] {
        assert_eq!(cast(2.0_f64.powi(exponent)), cast(1.0), "2^{exponent}");
    }
}

#[test]
fn starts_in_contact() {
    let cube = |height: f64| Posed::translated(Cuboid::new(DVec2::ONE).expect("positive"), DVec2::Y * height);
    let cast = |height: f64, velocity: f64, rate: f64, pivot: DVec2, start| {
        let motion = RigidMotion { velocity: DVec2::Y * velocity, angular_velocity: rate, center: pivot };
        let options = until(1.0).with_start_in_contact(start);
        floor(0.0).motion_cast(&cube(height).expect("finite"), motion, options).expect("finite")
    };
    let (report, if_deeper) = (StartInContact::Report, StartInContact::IfDeeper);
    let corner = DVec2::new(1.0, 0.0);
    // It rests, and tips over a corner that rises, or turns about its middle into the floor.
    for (pivot, velocity, rate, start, is_hit) in [
        (corner, 0.1, -1.0, report, true),
        (corner, 0.1, -1.0, if_deeper, false),
        (DVec2::Y, 0.0, 1.0, report, true),
        (DVec2::Y, 0.0, 1.0, if_deeper, true),
    ] {
        let answer = cast(1.0, velocity, rate, pivot, start);
        assert_eq!(answer.outcome.hit().map(|hit| (hit.time, hit.normal)), is_hit.then_some((0.0, Some(DVec2::Y))));
        assert_eq!(answer.lower, if is_hit { 0.0 } else { 1.0 }, "{answer:?}");
    }
    // Sunk in, it has no normal; its lowest point is in both bodies.
    let sunk = cast(0.5, 0.0, 1.0, DVec2::ZERO, report);
    assert_eq!((sunk.lower, sunk.upper), (0.0, 0.0), "{sunk:?}");
    let hit = sunk.outcome.hit().expect("a hit");
    assert!(hit.normal.is_none() && hit.point.y == -0.5, "{hit:?}");
    // Thrown up, it leaves though a corner turns down.
    let thrown = cast(0.5, 2.0, 1.0, DVec2::Y * 0.5, if_deeper);
    assert!(thrown.outcome.is_miss(), "{thrown:?}");
    let again = {
        let motion = RigidMotion { velocity: DVec2::Y * 0.4, angular_velocity: 1.5, center: DVec2::Y };
        let upright =
            Posed::translated(Cuboid::new(DVec2::new(0.2, 1.0)).expect("positive"), DVec2::Y).expect("finite");
        floor(0.0).motion_cast(&upright, motion, until(9.0).with_start_in_contact(if_deeper)).expect("finite")
    };
    // At 1 + 0.4·t − 0.2·|sin 1.5t| − |cos 1.5t| it is above the floor from the start on, where that grows by 0.4 −
    // 0.3.
    assert!(again.outcome.is_miss() && again.lower == 9.0, "{again:?}");
}

#[test]
fn options_are_kept() {
    let rod = Capsule::<DVec3>::new(1.0, 0.25).expect("positive");
    let turning = RigidMotion::rotation(DVec3::X, DVec3::ZERO);
    let lying = Posed::new(&rod, DQuat::from_rotation_x(FRAC_PI_2), DVec3::ZERO).expect("finite");
    let cast = |options| floor(-1.0).motion_cast(&lying, turning, options).expect("finite");
    // Its end is at −sin t, less the radius.
    holds(cast(until(9.0)), 0.75_f64.asin());
    let stopped = cast(until(9.0).with_target_distance(0.25));
    holds(stopped, 0.5_f64.asin());
    assert!((stopped.outcome.hit().expect("a hit").point.y + 1.0).abs() < 1e-15, "on the floor: {stopped:?}");
    assert!(cast(until(0.8)).outcome.is_miss() && cast(until(0.8)).lower == 0.8, "not yet");
    assert!(cast(until(0.0)).outcome.is_miss(), "not at once");
    let rough = cast(until(9.0).with_tolerance(1e-3));
    assert!(
        rough.lower <= 0.75_f64.asin() && 0.75_f64.asin() <= rough.upper && rough.upper - rough.lower < 1e-3,
        "{rough:?}"
    );
    assert!(rough.iterations <= cast(until(9.0)).iterations, "{rough:?} {:?}", cast(until(9.0)));
    for limit in [0, 1] {
        let given_up = cast(until(9.0).with_max_iterations(limit));
        assert_eq!((given_up.outcome, given_up.status), (Outcome::Undecided, Status::IterationLimit), "{limit}");
    }

    let mut times = Vec::new();
    let observed = floor(-1.0).motion_cast_with(&lying, turning, until(9.0), |seen| {
        assert_eq!(seen.normal, DVec3::Y, "{seen:?}");
        let truth = 0.75 - seen.time.sin().abs();
        assert!(seen.gap <= truth + 1e-15 && (seen.gap - truth).abs() < 1e-13, "{seen:?} of {truth}");
        assert!(seen.lower <= seen.upper && seen.iteration == times.len(), "{seen:?}");
        times.push(seen.time);
    });
    assert!(observed == Ok(cast(until(9.0))) && times.len() > 2 && times[0] == 0.0, "{times:?}");

    let refused = |parameter| Err(RayCastError::NonFinite { parameter, index: 0 });
    let nan = RigidMotion::translation(DVec3::X * f64::NAN);
    assert_eq!(floor(0.0).motion_cast(&rod, nan, until(1.0)), refused("motion_a"));
    assert_eq!(floor(0.0).motion_cast(&rod, turning, until(f64::NAN)), refused("max_time"));
    assert_eq!(
        floor(0.0).motion_cast(&rod, turning, until(1.0).with_target_distance(f64::NAN)),
        refused("target_distance")
    );
}

/// A support map that answers NaN, or points without end.
struct Broken(f64);

impl SupportMap for Broken {
    type Vector = DVec3;

    fn support(&self, _: DVec3) -> DVec3 {
        DVec3::splat(self.0)
    }
}

#[test]
fn what_is_no_body_is_not_decided() {
    let turning = RigidMotion::rotation(DVec3::new(1.0, 2.0, 3.0), DVec3::X);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let cast = floor(-1.0).motion_cast(&Broken(bad), turning, until(9.0)).expect("the motion is finite");
        assert!(cast.outcome == Outcome::Undecided && cast.iterations < 100, "{bad}: {cast:?}");
    }
    // A plane that cannot be computed with.
    let far = HalfSpace::new(DVec3::Y * 1e-200, 1e200).expect("a normal");
    let cast = far.motion_cast(&Cuboid::new(DVec3::ONE).expect("positive"), turning, until(9.0)).expect("finite");
    assert!(cast.outcome == Outcome::Undecided || cast.upper == 0.0, "{cast:?}");
}

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

/// A body that moves over a half-space, all in numbers that are exact in the precision it is asked in.
#[derive(Debug)]
struct Case {
    kind: usize,
    sizes: DVec3,
    corners: Vec<DVec3>,
    rotation: DQuat,
    place: DVec3,
    velocity: DVec3,
    spin: DVec3,
    center: DVec3,
    normal: DVec3,
    offset: f64,
    target: f64,
    end: f64,
}

impl Case {
    /// How far the body's lowest point is above the half-space, less the target distance: in closed form for each kind
    /// of shape.
    fn height(&self, time: f64) -> f64 {
        let turn = DQuat::from_scaled_axis(self.spin * time);
        let middle = self.center + self.velocity * time + turn * (self.place - self.center);
        let n = self.normal.normalize();
        // The normal as seen from the body.
        let local = (turn * self.rotation.normalize()).inverse() * n;
        let DVec3 { x, y, z } = self.sizes;
        let reach = match self.kind {
            0 => (local * self.sizes).abs().element_sum(),
            1 => x * local.y.abs() + y,
            2 => (local * self.sizes).length(),
            3 => self.corners.iter().map(|&corner| -local.dot(corner)).fold(f64::NEG_INFINITY, f64::max),
            _ => x * local.y.abs() + y * local.x.hypot(local.z),
        };
        debug_assert!(z >= 0.0, "sizes");
        n.dot(middle) - self.offset / self.normal.length() - reach - self.target
    }

    /// What heights are rounded relative to.
    fn reach(&self) -> f64 {
        let arm = self.place - self.center;
        let lengths = [self.sizes, self.place, self.center, arm, self.velocity * self.end];
        let sum: f64 = lengths.iter().map(|x| x.length()).sum();
        sum + self.offset.abs() / self.normal.length() + self.target
    }

    fn parts<V: Space>(&self) -> (Posed<Shape<V>>, RigidMotion<V>, HalfSpace<V>) {
        let vector = |x: DVec3| v::<V>(x.to_array());
        let [x, y] = [self.sizes.x, self.sizes.y].map(s::<V>);
        let shape: Shape<V> = match self.kind {
            0 => Box::new(Cuboid::new(vector(self.sizes)).expect("positive")),
            1 => Box::new(Capsule::<V>::new(x, y).expect("positive")),
            2 => Box::new(Ellipsoid::new(V::ZERO, vector(self.sizes), V::Rotation::default()).expect("positive")),
            3 => Box::new(Polytope::new(self.corners.iter().map(|&corner| vector(corner))).expect("finite")),
            _ => V::upright(0, s::<V>(self.sizes.x), s::<V>(self.sizes.y)).expect("in space"),
        };
        let rotation = V::Rotation::from_xyzw(self.rotation.to_array().map(s::<V>));
        let motion = RigidMotion {
            velocity: vector(self.velocity),
            angular_velocity: spin::<V>(self.spin.to_array()),
            center: vector(self.center),
        };
        let half_space = HalfSpace::new(vector(self.normal), s::<V>(self.offset)).expect("a normal");
        (Posed::new(shape, rotation, vector(self.place)).expect("finite"), motion, half_space)
    }
}

/// How the plane lies to a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Plane {
    /// Somewhere between the lowest and the first height.
    Met,
    /// Below all heights.
    Missed,
    /// Touched at the start.
    Touched,
    /// Within a few roundings, or more, of the lowest height.
    Grazed,
}

fn case<V: Vector>(random: &mut Random, plane: Plane) -> Case {
    let exact = |x: f64| s::<V>(x).as_f64();
    let vector = |random: &mut Random, size: f64| {
        let mut direction = DVec3::ZERO;
        while !(0.1..1.0).contains(&direction.length()) {
            direction = DVec3::from_array([(); 3].map(|()| random.number(-1.0, 1.0)));
            if V::DIM == 2 {
                direction.z = 0.0;
            }
        }
        DVec3::from_array((direction.normalize() * size).to_array().map(exact))
    };
    let pick = |random: &mut Random, values: &[f64]| values[random.number(0.0, values.len() as f64) as usize];
    let scale = pick(random, &[1.0, 1.0, 1e-6, 1e6]);
    let kind = random.number(0.0, if V::DIM == 2 { 4.0 } else { 5.0 }) as usize;
    let thickness = pick(random, &[1.0, 1.0, 1e-3]);
    let mut sizes = DVec3::from_array([1.0, thickness, 1.0].map(|x| exact(scale * x * random.number(0.1, 1.0))));
    let corners = (0..12).map(|_| vector(random, scale)).collect();
    let [far, arm] = [pick(random, &[0.0, 1.0, 100.0]), pick(random, &[0.0, 0.3, 30.0])].map(|x| x * scale);
    let place = vector(random, far);
    let center = DVec3::from_array((place + vector(random, arm)).to_array().map(exact));
    let end = exact(pick(random, &[0.7, 3.0]));
    let rate = pick(random, &[1.0, TAU, 10.0 * TAU]) / end;
    let (length, speed) = (pick(random, &[1.0, 1e-3, 1e3]), pick(random, &[0.0, 1.0, 10.0]) * scale);
    let normal = if random.number(0.0, 3.0) < 1.0 { DVec3::Y } else { vector(random, length) };
    let velocity = vector(random, speed);
    let rate = rate * random.number(0.1, 1.0);
    let mut spin = vector(random, rate);
    let mut rotation = DQuat::from_array([(); 4].map(|()| exact(random.number(-1.0, 1.0))));
    if V::DIM == 2 {
        (sizes.z, spin, rotation) = (0.0, DVec3::Z * spin.length(), DQuat::IDENTITY);
        spin.z = exact(spin.z);
    }
    let target = if random.number(0.0, 4.0) < 1.0 { exact(scale * random.number(0.0, 0.1)) } else { 0.0 };
    let mut case =
        Case { kind, sizes, corners, rotation, place, velocity, spin, center, normal, offset: 0.0, target, end };
    let heights: Vec<f64> = (0..=400).map(|i| case.height(end * f64::from(i) / 400.0)).collect();
    let least = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let height = match plane {
        Plane::Met => least + (heights[0] - least) * random.number(0.05, 0.95),
        Plane::Missed => least - scale * random.number(0.05, 1.0),
        Plane::Touched => heights[0],
        Plane::Grazed => least + scale * pick(random, &[0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-6, -1e-6]),
    };
    case.offset = exact(height * normal.length());
    case
}

/// Asks about many motions and samples what is proved of each.
fn agrees_with_samples<V: Space>(seed: u64, count: usize) {
    let mut random = Random(seed);
    let epsilon = V::Scalar::EPSILON.as_f64();
    for plane in [Plane::Met, Plane::Missed, Plane::Touched, Plane::Grazed] {
        let (mut hits, mut misses, mut undecided) = (0, 0, 0);
        for _ in 0..count {
            let case = case::<V>(&mut random, plane);
            let (body, motion, half_space) = case.parts::<V>();
            let options = until::<V>(case.end).with_target_distance(s::<V>(case.target));
            let cast = half_space.motion_cast(&body, motion, options).expect("finite");
            let (lower, upper) = (cast.lower.as_f64(), cast.upper.as_f64());
            let (reach, told) = (case.reach(), || format!("{cast:?} {plane:?} {case:?}"));
            // What the heights themselves are rounded by.
            let slack = 64.0 * f64::EPSILON * reach;
            assert!(lower <= upper, "{}", told());
            if lower > 0.0 {
                for i in 0..=300 {
                    let time = lower.min(case.end) * f64::from(i) / 300.0;
                    assert!(case.height(time) > -slack, "{} at {time}: {}", case.height(time), told());
                }
            }
            if upper > 0.0 && upper.is_finite() {
                assert!(case.height(upper) < slack, "{}: {}", case.height(upper), told());
            }
            match cast.outcome {
                Outcome::Hit(hit) => {
                    hits += 1;
                    let time = hit.time.as_f64();
                    assert!(lower <= time && time <= upper, "{}", told());
                    assert!(case.height(time).abs() < 1e3 * epsilon * reach || time == 0.0, "{}", told());
                    let apart = |from: f64, to: f64| (case.height(from) - case.height(to)) / (to - from);
                    let step = 1e-4 * case.end;
                    let slope = apart(time - step, time + step);
                    if plane == Plane::Met && time > 0.0 {
                        // What is known of heights, by how fast they fall.
                        let narrow = 1e3 * epsilon * reach / slope + 8.0 * epsilon * case.end;
                        assert!(upper - lower < narrow || slope * case.end < 1e-2 * reach, "{narrow}: {}", told());
                        let on_plane = hit.point.dot(half_space.normal()) - half_space.offset();
                        let wrong = on_plane.as_f64().abs() / case.normal.length();
                        assert!(wrong < 1e2 * epsilon * reach && hit.normal.is_some(), "{wrong}: {}", told());
                    }
                }
                Outcome::Miss(_) => {
                    misses += 1;
                    assert_eq!(lower, case.end, "{}", told());
                }
                Outcome::Undecided => {
                    undecided += 1;
                    assert!(case.height(lower).abs() < 1e3 * epsilon * reach + 1e-6 * reach, "{}", told());
                }
            }
        }
        let all = [hits, misses, undecided];
        match plane {
            Plane::Met => assert!(hits > count * 8 / 10 && undecided * 50 <= count, "{all:?}"),
            Plane::Missed => assert!(misses == count || epsilon > 1e-10 && misses > count * 9 / 10, "{all:?}"),
            Plane::Touched => assert!(hits > count / 2, "{all:?}"),
            Plane::Grazed => assert!(hits > count / 50 && misses > count / 50 && undecided > 0, "{all:?}"),
        }
    }
}

#[test]
fn what_is_proved_is_so_in_space() {
    agrees_with_samples::<DVec3>(0x1357_9BDF_0246_8ACE, 150);
    agrees_with_samples::<Vec3A>(0x0F1E_2D3C_4B5A_6978, 150);
}

#[test]
fn what_is_proved_is_so_in_the_plane() {
    agrees_with_samples::<DVec2>(0x1122_3344_5566_7788, 150);
    agrees_with_samples::<Vec2>(0x8877_6655_4433_2211, 150);
}

/// A box below the plane, so wide that no body comes near its sides, is met at the same time.
#[test]
fn a_wide_box_is_met_alike() {
    let mut random = Random(0x2468_ACE0_1357_9BDF);
    let (mut hits, mut misses) = (0, 0);
    for i in 0..200 {
        let case = case::<DVec3>(&mut random, if i % 2 == 0 { Plane::Met } else { Plane::Missed });
        let (body, motion, half_space) = case.parts::<DVec3>();
        let reach = case.reach();
        if case.height(0.0) < 1e-9 * reach {
            // Which of them they touch at the start, rounding decides.
            continue;
        }
        let n = case.normal.normalize();
        let wide = Cuboid::new(DVec3::new(4.0, 1.0, 4.0) * reach).expect("positive");
        let middle = n * (case.offset / case.normal.length() - reach);
        let wide = Posed::new(wide, DQuat::from_rotation_arc(DVec3::Y, n), middle).expect("finite");
        let options = until(case.end).with_target_distance(case.target);
        let below = half_space.motion_cast(&body, motion, options).expect("finite");
        let other = motion_cast(&body, motion, &wide, RigidMotion::default(), options).expect("finite");
        let told = || format!("{below:?} {other:?} {case:?}");
        match (below.outcome, other.outcome) {
            (Outcome::Hit(hit), Outcome::Hit(same)) => {
                hits += 1;
                // The box is turned and moved to rounding.
                let slack = (1e-12 * reach / case.sizes.max_element()).sqrt().min(1e-6);
                assert!(below.lower <= other.upper + slack && other.lower <= below.upper + slack, "{}", told());
                assert!((hit.time - same.time).abs() < slack * case.end.max(1.0), "{}", told());
                assert!(below.iterations <= other.iterations, "one support point a look: {}", told());
            }
            (Outcome::Miss(_), Outcome::Miss(_)) => misses += 1,
            (Outcome::Undecided, _) | (_, Outcome::Undecided) => {}
            _ => panic!("{}", told()),
        }
    }
    assert!(hits > 60 && misses > 60, "{hits} {misses}");
}

/// A motion of many turns over the floor is proved at no more cost than the turns near it take.
#[test]
fn many_turns_are_few_looks() {
    let rod = Cuboid::new(DVec3::new(1.0, 0.1, 0.1)).expect("positive");
    let spinning = RigidMotion { velocity: DVec3::X, angular_velocity: DVec3::Z * TAU, center: DVec3::ZERO };
    let high = floor(-1.1).motion_cast(&rod, spinning, until(1e6)).expect("finite");
    assert!(high.outcome.is_miss() && high.lower == 1e6 && high.iterations <= 1, "its ball is clear: {high:?}");
    let near = floor(-1.01).motion_cast(&rod, spinning, until(10.0)).expect("finite");
    assert!(near.outcome.is_miss() && near.lower == 10.0 && near.iterations < 600, "twenty passes: {near:?}");
    // About the vertical, it does not come nearer at all.
    let about = RigidMotion { velocity: DVec3::X, angular_velocity: DVec3::Y * TAU, center: DVec3::ZERO };
    let level = floor(-0.2).motion_cast(&rod, about, until(1e3)).expect("finite");
    assert!(level.outcome.is_miss() && level.iterations < 5, "{level:?}");
}
