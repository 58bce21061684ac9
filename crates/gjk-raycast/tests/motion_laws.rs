//! Laws that every motion cast obeys: what is proved agrees with distances at any number of times, and with itself when
//! the question is put another way.

use crate::common::behind_pointers::{distance, linear_cast, motion_cast};
use crate::common::strategies::{rotation, vector};
use convex_support::glam::{DQuat, DVec3};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, InvalidShape, Polytope, Posed, Rounded, SupportMap,
};
use gjk_raycast::{DistanceOptions, LinearCastOptions, Motion, MotionCast, MotionCastOptions, Outcome, RigidMotion};
use proptest::prelude::*;

type Shape = Box<dyn SupportMap<Vector = DVec3>>;

/// A shape of one of eight kinds about zero, of sizes `s`.
fn shape(kind: usize, s: DVec3, rotation: DQuat, place: DVec3) -> Result<Shape, InvalidShape> {
    let shape: Shape = match kind {
        0 => Box::new(Cuboid::new(s)?),
        1 => Box::new(Ball::new(s.x)?),
        2 => Box::new(Capsule::<DVec3>::new(s.x, s.y)?),
        3 => Box::new(Cylinder::<DVec3>::new(s.x, s.y)?),
        4 => Box::new(Cone::<DVec3>::new(s.x, s.y)?),
        5 => Box::new(Ellipsoid::new(DVec3::ZERO, s, DQuat::IDENTITY)?),
        6 => Box::new(Rounded::new(Cuboid::new(s)?, s.z)?),
        _ => {
            let (p, q) = (DVec3::new(s.y, s.z, s.x), DVec3::new(s.z, s.x, s.y));
            Box::new(Polytope::new([s, -s, p, -q, DVec3::new(-s.x, s.z, s.y)])?)
        }
    };
    Ok(Box::new(Posed::new(shape, rotation, place)?))
}

/// A shape at a place, with its motion.
#[derive(Clone, Copy, Debug)]
struct Body {
    kind: usize,
    sizes: DVec3,
    rotation: DQuat,
    place: DVec3,
    motion: RigidMotion<DVec3>,
}

impl Body {
    fn shape(&self) -> Shape {
        shape(self.kind, self.sizes, self.rotation, self.place).expect("valid sizes")
    }

    /// The shape as it is at a time, posed another way than the cast does.
    fn at(&self, time: f64) -> Posed<Shape> {
        let RigidMotion { velocity, angular_velocity, center } = self.motion;
        let turn = DQuat::from_scaled_axis(angular_velocity * time);
        Posed::new(self.shape(), turn, center + velocity * time - turn * center)
            .unwrap_or_else(|error| panic!("at {time}: {error}"))
    }

    /// The same in other units of length and time.
    fn scaled(&self, length: f64, time: f64) -> Self {
        let RigidMotion { velocity, angular_velocity, center } = self.motion;
        let motion = RigidMotion {
            velocity: velocity * (length / time),
            angular_velocity: angular_velocity / time,
            center: center * length,
        };
        Self { sizes: self.sizes * length, place: self.place * length, motion, ..*self }
    }
}

/// Sizes of moderate or of wild aspect.
fn sizes() -> impl Strategy<Value = DVec3> {
    let size = || prop_oneof![4 => 0.2..1.0, 1 => Just(1e-2), 1 => Just(1e-4)];
    (size(), size(), size()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// A body at a place along x, that moves to somewhere near zero within one unit of time and turns about a point near
/// its own.
fn body(x: f64) -> impl Strategy<Value = Body> {
    let spin = prop_oneof![1 => Just(0.0), 3 => Just(2.0), 1 => Just(20.0)];
    (0..8_usize, sizes(), rotation(), vector(0.5), vector(1.5), vector(1.0), vector(1.0), spin).prop_map(
        move |(kind, sizes, rotation, offset, goal, spin, off, rate)| {
            let place = DVec3::X * x + offset;
            let motion = RigidMotion { velocity: goal - place, angular_velocity: spin * rate, center: place + off };
            Body { kind, sizes, rotation, place, motion }
        },
    )
}

/// Half the length of a segment, which may be a point.
fn half_length() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.0..1.0, 1 => Just(0.0), 1 => Just(1e-8), 1 => Just(1e-200)]
}

fn cast(a: &Body, b: &Body, end: f64) -> MotionCast<DVec3> {
    let options = MotionCastOptions::new().with_max_time(end);
    motion_cast(&a.shape(), a.motion, &b.shape(), b.motion, options).expect("finite")
}

/// Whether two brackets of the same time have one in common. Both hold the truth.
fn agree(one: &MotionCast<DVec3>, other: &MotionCast<DVec3>, unit: f64) -> bool {
    let (a, b) = (&one.outcome, &other.outcome);
    let contradict = a.is_miss() && b.hit().is_some() || b.is_miss() && a.hit().is_some();
    !contradict && one.lower * unit <= other.upper && other.lower <= one.upper * unit
}

proptest! {
    #![proptest_config(convex_support::laws::config(192))]

    /// Distances at many times show no contact before the lower bound, and one at the upper bound.
    #[test]
    fn what_is_proved_is_so(a in body(-3.0), b in body(3.0)) {
        let cast = cast(&a, &b, 1.2);
        let apart = |time: f64| distance(&a.at(time), &b.at(time), DistanceOptions::new());
        // Rounding poses this way moves points by a few ulps of the scene.
        let rounding = 1e-13;
        prop_assert!(cast.lower <= cast.upper, "an empty bracket {:?}", cast);
        if cast.upper > 0.0 {
            for i in 0..200 {
                let time = cast.lower * f64::from(i) / 200.0;
                prop_assert!(apart(time).upper > 0.0 && !apart(time).overlap, "contact at {}: {:?}", time, cast);
            }
        }
        if let Outcome::Hit(hit) = cast.outcome {
            let time = if cast.upper.is_finite() { cast.upper } else { hit.time };
            prop_assert!(apart(time).lower <= rounding, "{} apart at {}: {:?}", apart(time).lower, time, cast);
            prop_assert!(cast.lower <= hit.time && hit.time <= cast.upper, "{:?}", cast);
        }
    }

    #[test]
    fn the_order_of_the_bodies_does_not_matter(a in body(-3.0), b in body(3.0)) {
        let (one, other) = (cast(&a, &b, 1.2), cast(&b, &a, 1.2));
        prop_assert!(agree(&one, &other, 1.0), "{:?} and {:?}", one, other);
    }

    /// Who moves along with both bodies sees the same.
    #[test]
    fn a_common_velocity_does_not_matter(a in body(-3.0), b in body(3.0), common in vector(5.0)) {
        let ride = |body: &Body| {
            let velocity = body.motion.velocity + common;
            Body { motion: RigidMotion { velocity, ..body.motion }, ..*body }
        };
        let (one, other) = (cast(&a, &b, 1.2), cast(&ride(&a), &ride(&b), 1.2));
        // Sums of velocities are rounded: that moves the bodies by some 1e-15.
        let near = |bracket: &MotionCast<DVec3>| MotionCast {
            lower: bracket.lower - 1e-9,
            upper: bracket.upper + 1e-9,
            ..*bracket
        };
        let graze = one.upper - one.lower > 1e-12 || other.upper - other.lower > 1e-12;
        prop_assert!(graze || agree(&near(&one), &near(&other), 1.0), "{:?} and {:?}", one, other);
    }

    /// Powers of two are exact.
    #[test]
    fn units_do_not_matter(a in body(-3.0), b in body(3.0), length in -30..30, time in -30..30) {
        let [length, time] = [length, time].map(|exponent: i32| 2.0_f64.powi(exponent));
        let one = cast(&a, &b, 1.2);
        let other = cast(&a.scaled(length, time), &b.scaled(length, time), 1.2 * time);
        prop_assert!(agree(&one, &other, time), "{:?} and {:?}", one, other);
    }

    /// Moving alike, bodies meet only at the start.
    #[test]
    fn one_motion_for_both_keeps_them_apart(a in body(-3.0), b in body(3.0)) {
        let b = Body { motion: a.motion, ..b };
        let apart = distance(&a.shape(), &b.shape(), DistanceOptions::new()).lower > 0.0;
        let cast = cast(&a, &b, 10.0);
        prop_assert_eq!(cast.outcome.is_miss(), apart, "{:?}", cast);
    }

    #[test]
    fn without_turning_it_is_a_linear_cast(a in body(-3.0), b in body(3.0)) {
        let still = |body: &Body| Body { motion: RigidMotion::translation(body.motion.velocity), ..*body };
        let cast = cast(&still(&a), &still(&b), 1.2);
        let motion = Motion { velocity_a: a.motion.velocity, velocity_b: b.motion.velocity };
        let options = LinearCastOptions::new().with_max_time(1.2);
        let linear = linear_cast(&a.shape(), &b.shape(), motion, options).expect("finite");
        prop_assert_eq!((cast.lower, cast.upper, cast.status), (linear.lower.min(1.2), linear.upper, linear.status));
        let (hit, linear) = (cast.outcome.hit(), linear.outcome.hit());
        prop_assert_eq!(hit.map(|hit| (hit.time, hit.point)), linear.map(|hit| (hit.time, hit.point)));
    }

    /// The closest points of capsules are known in closed form, those of rounded polytopes are searched for.
    #[test]
    fn capsules_meet_as_rounded_polytopes_do(
        a in body(-3.0),
        b in body(3.0),
        lengths in [half_length(), half_length()],
        radii in (0.01..1.0, 0.01..1.0),
        are_parallel in any::<bool>(),
    ) {
        let b = if are_parallel { Body { rotation: a.rotation, ..b } } else { b };
        let posed = |shape: Shape, body: &Body| Posed::new(shape, body.rotation, body.place).expect("a pose");
        let capsule = |length: f64, radius| Box::new(Capsule::<DVec3>::new(length, radius).expect("valid sizes"));
        let searched = |length: f64, radius| {
            let ends = Polytope::new([DVec3::Y * length, DVec3::NEG_Y * length]).expect("finite");
            Box::new(Rounded::new(ends, radius).expect("a valid radius"))
        };
        let options = MotionCastOptions::new().with_max_time(1.2);
        let cast = |shapes: [Shape; 2]| {
            let [one, other] = shapes;
            motion_cast(&posed(one, &a), a.motion, &posed(other, &b), b.motion, options).expect("finite")
        };
        let (known, found) = (
            cast([capsule(lengths[0], radii.0), capsule(lengths[1], radii.1)]),
            cast([searched(lengths[0], radii.0), searched(lengths[1], radii.1)]),
        );
        prop_assert!(agree(&known, &found, 1.0), "{:?} and {:?}", known, found);
        prop_assert_eq!(known.status, found.status, "{:?} and {:?}", known, found);
    }

    /// So slow a turn changes nothing that can be seen.
    #[test]
    fn hardly_turning_it_is_nearly_a_linear_cast(a in body(-3.0), b in body(3.0)) {
        let slow = |body: &Body| {
            let motion = RigidMotion { angular_velocity: DVec3::splat(1e-17), ..body.motion };
            Body { motion, ..*body }
        };
        let cast = cast(&slow(&a), &slow(&b), 1.2);
        let motion = Motion { velocity_a: a.motion.velocity, velocity_b: b.motion.velocity };
        let options = LinearCastOptions::new().with_max_time(1.2);
        let linear = linear_cast(&a.shape(), &b.shape(), motion, options).expect("finite");
        let contradict = cast.outcome.is_miss() && linear.outcome.hit().is_some()
            || cast.outcome.hit().is_some() && linear.outcome.is_miss();
        prop_assert!(!contradict, "{:?} and {:?}", cast, linear);
        if let (Some(one), Some(other)) = (cast.outcome.hit(), linear.outcome.hit()) {
            let width = (cast.upper - cast.lower).max(1e-12);
            prop_assert!((one.time - other.time).abs() <= 2.0 * width, "{:?} and {:?}", cast, linear);
        }
    }
}
