//! The least distance over a motion: against closed forms, against distances at many times, against the first contact,
//! and put another way; and what is answered at the edges.

use std::f64::consts::{PI, TAU};

use crate::common::Random;
use crate::common::space::{Space, spin};
use convex_support::glam::{DVec2, DVec3, Vec2, Vec3};
use convex_support::{
    Ball, BoundingSphere, Capsule, Cuboid, Polytope, Posed, Rounded, Scalar as _, Segment, SupportMap, Vector,
};
use gjk_raycast::{
    ChainMotion, Displacement, DistanceOptions, HalfSpace, MotionCastOptions, MotionClearance, MotionClearanceOptions,
    RayCastError, RigidMotion, Status, Trajectory, TurningPlane, distance, motion_cast,
};

type Shape<V> = Box<dyn SupportMap<Vector = V> + Sync>;
type Any<'s, V> = &'s dyn SupportMap<Vector = V>;

const REST: RigidMotion<DVec2> = RigidMotion { velocity: DVec2::ZERO, angular_velocity: 0.0, center: DVec2::ZERO };

fn at<S: SupportMap>(shape: S, translation: S::Vector) -> Posed<S> {
    Posed::translated(shape, translation).expect("finite")
}

fn until<V: Vector>(max_time: f64) -> MotionClearanceOptions<V> {
    MotionClearanceOptions::new().with_max_time(V::Scalar::from_f64(max_time))
}

/// Behind pointers, so that it is compiled once.
fn clearance<V: Vector>(
    a: Any<'_, V>,
    motion_a: impl Trajectory<Vector = V>,
    b: Any<'_, V>,
    motion_b: impl Trajectory<Vector = V>,
    options: MotionClearanceOptions<V>,
) -> MotionClearance<V> {
    gjk_raycast::motion_clearance(a, motion_a, b, motion_b, options).expect("finite motions and an end")
}

/// The bracket holds the truth, and is as narrow as asked.
fn holds(least: MotionClearance<DVec2>, truth: f64, time: f64) {
    let slack = 1e-14 * truth.max(1.0);
    assert!(least.lower <= truth + slack && truth - slack <= least.upper, "{truth} is not in {least:?}");
    assert!(least.upper - least.lower <= 1.5e-8 * truth + slack, "{least:?} is wide");
    assert!((least.distance - truth).abs() < 1e-13, "{truth} is not the distance of {least:?}");
    assert!((least.time - time).abs() < 1e-6, "{time} is not the time of {least:?}");
    assert_eq!(least.status, Status::Converged, "{least:?}");
}

#[test]
fn closed_forms() {
    // The tip of a rod passes a wall, and a ball passes a ball.
    let rod = Segment::new([DVec2::ZERO, DVec2::X * 1.5]).expect("finite");
    let wall = at(Cuboid::new(DVec2::new(0.5, 9.0)).expect("positive"), DVec2::X * 2.5);
    let swing = RigidMotion { angular_velocity: 2.0, ..REST };
    let turned = Posed::new(rod, -1.0, DVec2::ZERO).expect("finite");
    holds(clearance(&turned, swing, &wall, REST, until(1.0)), 0.5, 0.5);
    holds(clearance(&wall, REST, &turned, swing, until(1.0)), 0.5, 0.5);
    let ball = at(Ball::new(0.5).expect("positive"), DVec2::new(-3.0, 2.0));
    let other = Ball::new(1.0).expect("positive");
    let passing = RigidMotion { velocity: DVec2::X * 2.0, ..REST };
    holds(clearance(&ball, passing, &other, REST, until(9.0)), 0.5, 1.5);
    // It ends before, and it leaves.
    holds(clearance(&ball, passing, &other, REST, until(1.0)), 5.0_f64.sqrt() - 1.5, 1.0);
    let leaving = RigidMotion { velocity: DVec2::new(-1.0, 3.0), angular_velocity: 5.0, center: DVec2::new(-3.0, 2.0) };
    holds(clearance(&ball, leaving, &other, REST, until(9.0)), 13.0_f64.sqrt() - 1.5, 0.0);
    // A square that turns over a floor reaches √2 below its middle.
    let floor = HalfSpace::new(DVec2::Y * 3.0, 0.0).expect("a direction");
    let square = at(Cuboid::new(DVec2::ONE).expect("positive"), DVec2::Y * 2.0);
    let turning = RigidMotion { angular_velocity: 1.0, center: DVec2::Y * 2.0, ..REST };
    let least = floor.motion_clearance(&square, turning, until(1.5)).expect("finite");
    holds(least, 2.0 - 2.0_f64.sqrt(), PI / 4.0);
    assert!(least.point_b.y.abs() < 1e-15 && (least.point_a - least.point_b).x.abs() < 1e-15, "{least:?}");
}

#[test]
fn equal_minima_and_a_thousand_turns() {
    let square: Any<'_, DVec2> = &Cuboid::new(DVec2::ONE).expect("positive");
    let wall = at(Cuboid::new(DVec2::new(0.5, 9.0)).expect("positive"), DVec2::X * 2.5);
    // Four times in each turn a corner points at the wall.
    for turns in [1.0, 20.0, 1000.0] {
        let least = clearance(square, RigidMotion { angular_velocity: TAU * turns, ..REST }, &wall, REST, until(1.0));
        let truth = 2.0 - 2.0_f64.sqrt();
        assert!(least.lower <= truth && truth <= least.upper + 1e-14, "{least:?}");
        assert!((least.distance - truth).abs() < 1e-9, "{least:?}");
        assert!(least.upper - least.lower < if turns < 100.0 { 1e-8 } else { 1e-3 }, "{least:?}");
        // Any of them is right.
        let eighths = least.time * turns * 8.0;
        assert!((eighths - eighths.round()).abs() < 1e-3 && eighths.round() % 2.0 == 1.0, "{least:?}");
    }
    // A ball turns about its own centre: all times are equal.
    let ball = at(Ball::new(0.5).expect("positive"), DVec2::X * 2.0);
    let spinning = RigidMotion { angular_velocity: 100.0, center: DVec2::X * 2.0, ..REST };
    let least = clearance(&ball, spinning, square, REST, until(1.0));
    assert!(least.lower <= 0.5 && 0.5 <= least.upper && least.upper - least.lower < 1e-8, "{least:?}");
}

#[test]
fn bodies_that_meet_are_at_0_when_they_do() {
    let ball = Ball::new(0.5).expect("positive");
    let square: Any<'_, DVec2> = &Cuboid::new(DVec2::ONE).expect("positive");
    let coming = at(ball, DVec2::X * 4.0);
    let motion = RigidMotion { velocity: DVec2::NEG_X, angular_velocity: 1.0, center: DVec2::X * 4.0 };
    let least = clearance(&coming, motion, square, REST, until(9.0));
    assert_eq!((least.distance, least.lower, least.upper), (0.0, 0.0, 0.0), "{least:?}");
    assert!((least.time - 2.5).abs() < 1e-13 && (least.point_a - DVec2::X).length() < 1e-12, "{least:?}");
    assert!((least.normal.expect("apart at first") - DVec2::X).length() < 1e-12, "{least:?}");
    // They overlap all along.
    let inside = clearance(&ball, motion, square, REST, until(0.5));
    assert_eq!((inside.distance, inside.upper, inside.time, inside.normal), (0.0, 0.0, 0.0, None), "{inside:?}");
    assert!(inside.iterations < 100, "at once: {inside:?}");
}

#[test]
fn edges_of_time() {
    let ball = at(Ball::new(0.5).expect("positive"), DVec2::X * 4.0);
    let square: Any<'_, DVec2> = &Cuboid::new(DVec2::ONE).expect("positive");
    let motion = RigidMotion { velocity: DVec2::NEG_X, angular_velocity: 1.0, center: DVec2::ZERO };
    for (least, name) in [
        (clearance(&ball, motion, square, REST, until(0.0)), "no time"),
        (clearance(&ball, motion, square, REST, until(-1.0)), "less than no time"),
        (clearance(&ball, REST, square, REST, until(7.0)), "at rest"),
        (clearance(&ball, motion, square, motion, until(7.0)), "the same motion"),
    ] {
        assert!(least.lower <= 2.5 && 2.5 <= least.upper && least.upper - least.lower < 3e-14, "{name}: {least:?}");
        assert_eq!((least.distance, least.time, least.status), (2.5, 0.0, Status::Converged), "{name}");
    }
    let ask = |options| gjk_raycast::motion_clearance(&ball, motion, square, REST, options);
    let error = |parameter| Err(RayCastError::NonFinite { parameter, index: 0 });
    assert_eq!(ask(MotionClearanceOptions::new()), error("max_time"), "no end");
    assert_eq!(ask(until(f64::NAN)), error("max_time"));
    assert_eq!(ask(until(1.0).with_tolerance(f64::NAN)), error("tolerance"));
    let bad = RigidMotion { velocity: DVec2::new(f64::NAN, 0.0), ..REST };
    assert_eq!(gjk_raycast::motion_clearance(&ball, REST, square, bad, until(1.0)), error("motion_b"));
    let floor = HalfSpace::new(DVec2::Y, -5.0).expect("a direction");
    assert_eq!(floor.motion_clearance(&ball, motion, MotionClearanceOptions::new()), error("max_time"));
    // Whatever is left, there is a bracket.
    let truth = clearance(&ball, motion, square, REST, until(1.0)).distance;
    for count in [0, 1, 2, 5, 9, 16] {
        let least = clearance(&ball, motion, square, REST, until(1.0).with_max_iterations(count));
        assert!(least.lower <= truth && truth <= least.upper + 1e-12, "{count}: {least:?}");
    }
    for tolerance in [-1.0, 0.0, 1e-12, 1e-3, 1.0, 1e9] {
        let least = clearance(&ball, motion, square, REST, until(0.5).with_tolerance(tolerance));
        let wide = tolerance.max(1e-12) * least.upper;
        assert!(least.lower >= 0.0 && least.upper - least.lower <= wide, "{tolerance}: {least:?}");
        assert_eq!(least.status, Status::Converged, "{tolerance}: {least:?}");
    }
}

/// A trajectory of the user's own: of no numbers, or with a bound that is one.
struct Odd {
    after: f64,
    bound: f64,
}

impl Trajectory for Odd {
    type Vector = DVec2;

    fn displacement(&self, time: f64) -> Displacement<DVec2> {
        Displacement::shifted(DVec2::X * if time > self.after { f64::NAN } else { -time })
    }

    fn velocity(&self, _: f64, _: DVec2) -> DVec2 {
        DVec2::NEG_X
    }

    fn acceleration_along(&self, _: BoundingSphere<DVec2>, _: TurningPlane<DVec2>, _: [f64; 2]) -> f64 {
        self.bound
    }
}

#[test]
fn no_numbers_end_no_search_and_prove_nothing() {
    let ball = at(Ball::new(0.5).expect("positive"), DVec2::X * 4.0);
    let square: Any<'_, DVec2> = &Cuboid::new(DVec2::ONE).expect("positive");
    for (after, bound) in [(-1.0, 0.0), (0.7, 0.0), (0.7, f64::NAN), (2.0, f64::NAN), (2.0, f64::INFINITY)] {
        let least = clearance(&ball, Odd { after, bound }, square, REST, until(1.0));
        assert!(least.status != Status::Converged && least.lower == 0.0, "{after} {bound}: {least:?}");
        assert!(least.upper >= 1.5, "{after} {bound}: {least:?}");
    }
    let least = clearance(&ball, Odd { after: 2.0, bound: 0.0 }, square, REST, until(1.0));
    assert!((least.distance - 1.5).abs() < 1e-14 && least.status == Status::Converged, "{least:?}");
}

/// A chain of one motion, and of two that are the same as one, are answered alike.
#[test]
fn chains_are_motions_too() {
    let rod = Segment::new([DVec2::ZERO, DVec2::X]).expect("finite");
    let wall = at(Cuboid::new(DVec2::new(9.0, 0.5)).expect("positive"), DVec2::Y * 2.6);
    // The forearm turns about the end of an upper arm that turns about zero: straight up both reach 2, at a time of 1.
    let links = [RigidMotion::rotation(PI / 2.0 - 0.2, DVec2::ZERO), RigidMotion::rotation(0.2, DVec2::X)];
    let forearm = at(rod, DVec2::X);
    let least = clearance(&forearm, ChainMotion::new(&links), &wall, REST, until(1.0));
    let reach = (PI / 2.0 - 0.2).sin() + 1.0;
    holds(least, 2.1 - reach, 1.0);
    let one = [RigidMotion::rotation(PI / 4.0, DVec2::ZERO)];
    let [as_chain, as_motion] = [
        clearance(&rod, ChainMotion::new(&one), &wall, REST, until(4.0)),
        clearance(&rod, one[0], &wall, REST, until(4.0)),
    ];
    holds(as_chain, 1.1, 2.0);
    holds(as_motion, 1.1, 2.0);
}

struct Pair<V: Vector> {
    shapes: [Shape<V>; 2],
    motions: [RigidMotion<V>; 2],
    end: f64,
}

fn shape<V: Space>(random: &mut Random, scale: f64) -> Shape<V> {
    let kind = random.number(0.0, 7.0) as usize;
    let size = |random: &mut Random| V::Scalar::from_f64(random.number(0.1, 1.0) * scale);
    let sizes = V::from_fn(|_| size(random));
    match kind {
        0 => Box::new(Cuboid::new(sizes).expect("positive")),
        1 => Box::new(Ball::new(sizes.get(0)).expect("positive")),
        2 => Box::new(Capsule::new(sizes.get(0), sizes.get(1)).expect("positive")),
        3 => Box::new(Rounded::new(Cuboid::new(sizes).expect("positive"), sizes.get(0)).expect("positive")),
        4 | 5 if V::DIM == 3 => V::upright(kind - 4, sizes.get(0), sizes.get(1)).expect("in space"),
        _ => Box::new(Polytope::new((0..9).map(|_| random.vector::<V>(scale))).expect("finite")),
    }
}

/// Bodies that come near one another, in a unit of length and one of time.
fn pair<V: Space>(random: &mut Random, length: f64, time: f64) -> Pair<V> {
    let place = random.vector::<V>(1.0);
    let place = place * V::Scalar::from_f64(random.number(1.0, 4.0) * length) / place.length();
    let turn = random.number(0.0, 1.0);
    let turn = if turn < 0.2 { 0.0 } else { turn * turn * 8.0 / time };
    let [a, b] = [place, V::ZERO].map(|place| {
        let rotation = spin::<V>([1.0; 3].map(|_| random.number(-3.0, 3.0)));
        let rotation = RigidMotion::<V>::rotation(rotation, V::ZERO).displacement(V::Scalar::ONE).rotation();
        let posed = Posed::from_matrix(shape::<V>(random, length), rotation, place).expect("finite");
        let center = place + random.vector::<V>(length);
        let way = random.vector::<V>(2.0 * length) - place * V::Scalar::from_f64(random.number(0.0, 1.5));
        let spin = spin::<V>([1.0; 3].map(|_| random.number(-turn, turn)));
        let velocity = way / V::Scalar::from_f64(time);
        (Box::new(posed) as Shape<V>, RigidMotion { velocity, angular_velocity: spin, center })
    });
    Pair { shapes: [a.0, b.0], motions: [a.1, b.1], end: random.number(0.5, 2.0) * time }
}

impl<V: Space> Pair<V> {
    fn shapes(&self) -> [Any<'_, V>; 2] {
        [&*self.shapes[0], &*self.shapes[1]]
    }

    fn clearance(&self) -> MotionClearance<V> {
        let [a, b] = self.shapes();
        clearance(a, self.motions[0], b, self.motions[1], until(self.end))
    }

    fn distance_at(&self, time: V::Scalar) -> gjk_raycast::Distance<V> {
        let [a, b] = [0, 1].map(|i| {
            let placed = at(self.shapes()[i], V::ZERO);
            self.motions[i].displacement(time).moved(&placed).expect("finite")
        });
        distance(&a as Any<'_, V>, &b as Any<'_, V>, DistanceOptions::new())
    }
}

/// Random motions against distances at many times, which are computed another way, and against the first contact.
fn agrees_with_samples<V: Space>(seed: u64, count: usize, samples: usize) {
    let mut random = Random(seed);
    let (mut met, mut apart, epsilon) = (0, 0, V::Scalar::EPSILON.as_f64());
    for case in 0..count {
        let pair = pair::<V>(&mut random, 1.0, 1.0);
        let least = pair.clearance();
        let [a, b] = pair.shapes();
        let options = MotionCastOptions::new().with_max_time(V::Scalar::from_f64(pair.end));
        let cast = motion_cast(a, pair.motions[0], b, pair.motions[1], options).expect("finite");
        let number = V::Scalar::as_f64;
        // The bodies' sizes and places, and their rounding in a pose that is computed another way.
        let rounded = 512.0 * epsilon * 10.0;
        if cast.outcome.is_hit() {
            met += 1;
            let hit = cast.outcome.hit().expect("a hit");
            if cast.is_certain() {
                assert!(least.lower == V::Scalar::ZERO, "{case}: {least:?} {cast:?}");
                assert!(number(least.upper) <= rounded, "{case}: {least:?} {cast:?}");
                assert!((number(least.time) - number(hit.time)).abs() < 1e4 * rounded, "{case}: {least:?} {cast:?}");
            }
            continue;
        }
        assert!(!cast.outcome.is_miss() || number(least.upper) > 0.0, "{case}: {least:?} {cast:?}");
        apart += 1;
        assert_eq!(least.status, Status::Converged, "{case}: {least:?}");
        assert!(least.lower <= least.distance && least.distance <= least.upper, "{case}: {least:?}");
        let width = epsilon.sqrt() * number(least.upper) + rounded;
        assert!(number(least.upper - least.lower) <= width, "{case}: {least:?} is wide");
        let there = pair.distance_at(least.time);
        assert!((number(there.distance) - number(least.distance)).abs() <= rounded, "{case}: {least:?} {there:?}");
        let between = number((least.point_a - least.point_b).length());
        assert!((between - number(least.distance)).abs() <= rounded, "{case}: {least:?}");
        let along = least.normal.map(|n| number((least.point_a - least.point_b - n * least.distance).norm()));
        assert!(along.is_some_and(|off| off <= 4.0 * rounded.sqrt()), "{case}: {least:?}");
        for k in 0..=samples {
            let time = V::Scalar::from_f64(pair.end * k as f64 / samples as f64);
            let sample = pair.distance_at(time);
            assert!(number(sample.upper) >= number(least.lower) - rounded, "{case} at {time}: {sample:?} {least:?}");
            assert!(number(sample.upper) >= number(least.distance) - width, "{case} at {time}: {sample:?} {least:?}");
        }
    }
    assert!(met > count / 10 && apart > count / 10, "{met} met and {apart} did not");
}

#[test]
fn no_sampled_distance_is_below_the_lower_bound() {
    agrees_with_samples::<DVec3>(1, 150, 100);
    agrees_with_samples::<DVec2>(2, 150, 100);
    agrees_with_samples::<Vec3>(3, 100, 60);
    agrees_with_samples::<Vec2>(4, 100, 60);
}

/// The bodies in the other order have the same distance, and a power of two changes no bit.
fn put_another_way<V: Space>(seed: u64, count: usize) {
    for case in 0..count as u64 {
        let pair = |length, time| pair::<V>(&mut Random(seed + 977 * case), length, time);
        let plain = pair(1.0, 1.0);
        let least = plain.clearance();
        let [a, b] = plain.shapes();
        let swapped = clearance(b, plain.motions[1], a, plain.motions[0], until(plain.end));
        let overlap = if least.upper < swapped.upper { least.upper } else { swapped.upper };
        assert!(least.lower <= overlap && swapped.lower <= overlap, "{case}: {least:?} {swapped:?}");
        for (length, time) in [(1024.0, 1.0), (1.0, 0.25), (0.5_f64.powi(20), 8.0)] {
            let other = pair(length, time).clearance();
            let [length, time] = [length, time].map(V::Scalar::from_f64);
            let back = |x: V::Scalar| x / length;
            let scaled = [back(other.distance), back(other.lower), back(other.upper), other.time / time];
            assert_eq!(scaled, [least.distance, least.lower, least.upper, least.time], "{case}: {least:?} {other:?}");
            assert_eq!((other.point_a / length, other.point_b / length), (least.point_a, least.point_b), "{case}");
            assert_eq!((other.normal, other.status), (least.normal, least.status), "{case}");
        }
    }
}

#[test]
fn the_order_of_bodies_and_the_units_do_not_matter() {
    put_another_way::<DVec3>(11, 40);
    put_another_way::<DVec2>(12, 40);
    put_another_way::<Vec3>(13, 30);
    put_another_way::<Vec2>(14, 30);
}

/// What is proved is what the observer sees: at the times up to which iterates are proved, one of them was examined.
#[test]
fn observers_see_the_search_come_to_its_end() {
    let mut random = Random(5);
    for case in 0..20 {
        let pair = pair::<DVec3>(&mut random, 1.0, 1.0);
        let [a, b] = pair.shapes();
        let (mut seen, mut last, mut count) = (Vec::new(), 0.0, 0);
        let watch = |there: gjk_raycast::MotionIterate<DVec3>| {
            assert!(there.lower >= last, "{case}: {there:?} after {last}");
            (last, count) = (there.lower, count + 1);
            seen.push((there.time, there.gap));
        };
        let options = until(pair.end);
        let least = gjk_raycast::motion_clearance_with(a, pair.motions[0], b, pair.motions[1], options, watch);
        let least = least.expect("finite");
        assert_eq!(least, pair.clearance(), "{case}: the same, watched or not");
        if least.lower > 0.0 {
            assert!(seen.iter().any(|(time, _)| *time == least.time), "{case}: {least:?}");
            assert!(seen.iter().all(|(_, gap)| *gap < f64::INFINITY), "{case}: {least:?}");
        }
    }
}

/// The times examined are about ten for a minimum, and few for its proof, whatever the tolerance.
#[test]
fn a_minimum_and_its_proof_take_few_looks() {
    let mut random = Random(9);
    let (mut counts, mut narrow) = (Vec::new(), Vec::new());
    while counts.len() < 60 {
        let pair = pair::<DVec3>(&mut random, 1.0, 1.0);
        let [a, b] = pair.shapes();
        let looks = |tolerance| {
            let (options, mut count) = (until(pair.end).with_tolerance(tolerance), 0);
            let ask = gjk_raycast::motion_clearance_with;
            let least = ask(a, pair.motions[0], b, pair.motions[1], options, |_| count += 1).expect("finite");
            (least.lower > 0.0).then_some(count)
        };
        if let (Some(count), Some(more)) = (looks(1e-6), looks(1e-12)) {
            counts.push(count);
            narrow.push(more);
        }
    }
    counts.sort_unstable();
    narrow.sort_unstable();
    assert!(counts[30] <= 14 && counts[54] <= 28, "{counts:?}");
    assert!(narrow[30] <= 20 && narrow[54] <= 40, "{narrow:?}");
}
