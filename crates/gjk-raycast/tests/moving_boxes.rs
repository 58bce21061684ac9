//! Turning casts of boxes, by the facets of their difference, against those of shapes that do not say that they are
//! boxes.

use crate::common::behind_pointers::motion_cast;
use crate::common::{Plain, Random, s};
use convex_support::glam::{DQuat, DVec2, DVec3, Quat, Vec3};
use convex_support::{Ball, Cuboid, Posed, Scalar, SupportMap, Vector};
use gjk_raycast::{
    MotionCast, MotionCastOptions, Outcome, RigidMotion, SignedDistanceOptions, StartInContact, signed_distance,
};

fn within<V: Vector>(random: &mut Random, size: f64) -> V {
    V::from_fn(|_| s::<V>(random.number(-size, size)))
}

/// How two answers to one question compare.
#[derive(Debug, Default)]
struct Counts {
    hits: usize,
    misses: usize,
    /// Only one of both is undecided.
    lost: usize,
    won: usize,
    /// The bracket of the boxes is over four times as wide.
    wide: usize,
}

impl Counts {
    /// Both brackets hold the truth.
    fn add<V: Vector>(&mut self, boxes: &MotionCast<V>, plain: &MotionCast<V>) {
        match (&boxes.outcome, &plain.outcome) {
            (Outcome::Hit(_), Outcome::Hit(_)) => {
                self.hits += 1;
                assert!(boxes.lower <= plain.upper && plain.lower <= boxes.upper, "{boxes:?} and {plain:?}");
                let ulp = V::Scalar::EPSILON * boxes.lower;
                let four = s::<V>(4.0);
                self.wide += usize::from(boxes.upper - boxes.lower > (plain.upper - plain.lower + ulp * four) * four);
            }
            (Outcome::Miss(_), Outcome::Miss(_)) => self.misses += 1,
            (Outcome::Undecided, Outcome::Undecided) => {}
            (Outcome::Undecided, _) => self.lost += 1,
            (_, Outcome::Undecided) => self.won += 1,
            _ => panic!("{boxes:?} and {plain:?}"),
        }
    }
}

/// A motion from elsewhere to where it nearly touches, and on.
fn counts<V: Vector>(
    seed: u64,
    turn: impl Fn(&mut Random, f64) -> V::Rotation,
    spin: impl Fn(&mut Random, f64) -> V::AngularVelocity,
) -> Counts {
    let mut random = Random(seed);
    let mut counts = Counts::default();
    for round in 0..3000 {
        let thin = [1.0_f64, 0.1, 1e-3][round % 3];
        let scale = [1.0, 1e-6, 1e6][round / 3 % 3];
        let lean = [1.0, 1e-3, 1e-9, 0.0][round % 4];
        let is_flat = round % 11 == 0;
        let mut cuboid = || {
            let mut half = |i: usize| if is_flat && i == 0 { 0.0 } else { random.number(thin.ln(), 0.0).exp() * scale };
            Cuboid::new(V::from_fn(|i| s::<V>(half(i)))).expect("not negative")
        };
        let (a, b) = (cuboid(), cuboid());
        let a = Posed::new(a, turn(&mut random, lean), within(&mut random, scale)).expect("a pose");
        let place = V::axis(0) * s::<V>(4.0 * scale) + within(&mut random, 2.0 * scale);
        let b = Posed::new(b, turn(&mut random, lean), place).expect("a pose");
        let center = place + within(&mut random, 0.1 * scale);
        let velocity = within::<V>(&mut random, 2.0 * scale) - place;
        let rate = [0.1, 2.0, 30.0, 1e-6][round % 4];
        let motion = RigidMotion { velocity, angular_velocity: spin(&mut random, rate), center };
        let start = if round % 7 == 0 { StartInContact::IfDeeper } else { StartInContact::Report };
        let options = MotionCastOptions::new().with_max_time(s::<V>(1.5)).with_start_in_contact(start);
        let rest = RigidMotion::default();
        let boxes = motion_cast(&a, rest, &b, motion, options).expect("finite");
        let plain = motion_cast(&Plain(&a), rest, &Plain(&b), motion, options).expect("finite");
        counts.add(&boxes, &plain);
    }
    counts
}

/// Most are decided, and grazes are as often undecided as they are otherwise.
fn holds(counts: &Counts) {
    assert!(counts.hits > 1000 && counts.misses > 300, "{counts:?}");
    assert!(counts.lost <= counts.won + 10 && counts.wide <= 5, "{counts:?}");
}

fn rotation(random: &mut Random, most: f64) -> DQuat {
    DQuat::from_scaled_axis(within(random, most))
}

#[test]
fn boxes_in_space() {
    holds(&counts::<DVec3>(31, rotation, within));
}

#[test]
fn boxes_in_single_precision() {
    let turn = |random: &mut Random, most| Quat::from_scaled_axis(within(random, most));
    holds(&counts::<Vec3>(32, turn, within));
}

#[test]
fn rectangles_in_the_plane() {
    let turn = |random: &mut Random, most: f64| random.number(-most, most);
    holds(&counts::<DVec2>(33, turn, turn));
}

/// How far a point is from a shape.
fn off(point: DVec3, shape: &impl SupportMap<Vector = DVec3>) -> f64 {
    let point = Posed::translated(Ball::new(0.0).expect("not negative"), point).expect("finite");
    signed_distance(&point, shape, SignedDistanceOptions::default()).signed_distance
}

/// The point of a hit is of both boxes, where the normal is that of a facet of their difference as where it is not
/// known by itself which points of two faces touch.
#[test]
fn the_point_of_a_hit_is_of_both() {
    let mut random = Random(34);
    let mut hits = 0;
    for round in 0..1000 {
        let mut cuboid = || {
            let half = DVec3::from_array([0; 3].map(|_| random.number(0.05, 1.0)));
            Cuboid::new(half).expect("positive")
        };
        let (a, b) = (cuboid(), cuboid());
        let lean = if round % 2 == 0 { 0.0 } else { 2.0 };
        let (turn_b, place) = (rotation(&mut random, lean), DVec3::X * 4.0 + within::<DVec3>(&mut random, 2.0));
        let about_z = DVec3::Z * random.number(-1.0, 1.0);
        let angular_velocity = if lean > 0.0 { within(&mut random, 2.0) } else { about_z };
        let motion = RigidMotion { velocity: -place, angular_velocity, center: place };
        let options = MotionCastOptions::new().with_max_time(1.0);
        let posed = Posed::new(b, turn_b, place).expect("a pose");
        let cast = motion_cast(&a, RigidMotion::default(), &posed, motion, options).expect("finite");
        let Outcome::Hit(hit) = cast.outcome else { continue };
        let turned = DQuat::from_scaled_axis(angular_velocity * hit.time) * turn_b;
        let there = Posed::new(b, turned, place + motion.velocity * hit.time).expect("a pose");
        hits += 1;
        let distances = [off(hit.point, &a), off(hit.point, &there)];
        assert!(distances.iter().all(|&distance| distance.abs() < 1e-12), "round {round}: {distances:?}, {cast:?}");
    }
    assert!(hits > 700, "{hits}");
}
