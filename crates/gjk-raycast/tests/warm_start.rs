//! Casts that are told what the last frame was answered: the same answers, by fewer support points.

use crate::common::Random;
use crate::common::behind_pointers::linear_cast;
use convex_support::glam::{DQuat, DVec3};
use convex_support::{Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Posed, Rounded, SupportMap};
use gjk_raycast::{CastMethod, LinearCast, LinearCastOptions, Motion, Outcome};

const VALID: &str = "valid numbers";

type Shape = Box<dyn SupportMap<Vector = DVec3>>;

fn hull(random: &mut Random, corners: usize) -> Shape {
    let points = (0..corners).map(|_| random.direction() * DVec3::new(1.0, 0.8, 0.6));
    Box::new(Polytope::new(points).expect(VALID))
}

fn ellipsoid(random: &mut Random) -> Shape {
    let axes = DVec3::from_array([0; 3].map(|_| random.number(0.4, 1.4)));
    Box::new(Ellipsoid::new(DVec3::ZERO, axes, DQuat::IDENTITY).expect(VALID))
}

fn cylinder(random: &mut Random) -> Shape {
    Box::new(Cylinder::<DVec3>::new(random.number(0.4, 1.4), random.number(0.3, 0.8)).expect(VALID))
}

fn cone(random: &mut Random) -> Shape {
    Box::new(Cone::<DVec3>::new(random.number(0.4, 1.4), random.number(0.3, 0.8)).expect(VALID))
}

fn cuboid(random: &mut Random) -> Cuboid<DVec3> {
    Cuboid::new(DVec3::from_array([0; 3].map(|_| random.number(0.3, 1.3)))).expect(VALID)
}

fn rounded(random: &mut Random) -> Shape {
    Box::new(Rounded::new(cuboid(random), 0.1).expect(VALID))
}

/// What is certain of a cold cast and of a warm one is so of one and the same motion.
fn agree(cold: &LinearCast<DVec3>, warm: &LinearCast<DVec3>, velocity: DVec3) {
    let what = || format!("{cold:?} and {warm:?}");
    assert_eq!(cold.outcome.is_hit(), warm.outcome.is_hit(), "{}", what());
    assert_eq!(cold.outcome.is_miss(), warm.outcome.is_miss(), "{}", what());
    assert!(warm.is_certain() || !cold.is_certain(), "{}", what());
    assert!(warm.lower <= cold.upper && cold.lower <= warm.upper, "{}", what());
    if let (Outcome::Hit(a), Outcome::Hit(b)) = (&cold.outcome, &warm.outcome) {
        // How deep one point is below the other, as points on the same surface.
        let (apart, normal) = (a.point - b.point, a.normal.expect("on the way"));
        assert!((a.time - b.time).abs() * velocity.length() < 1e-12, "{}", what());
        assert!(normal.dot(apart).abs() < 1e-11 && apart.length() < 1e-5, "{}", what());
    }
}

/// The support points of cold and of warm casts at shapes that turn by an angle each frame, as the velocity does, and
/// drift by as much; all bring it about that the normal turns by a few times that.
fn counts(shapes: impl Fn(&mut Random) -> [Shape; 2], angle: f64) -> [usize; 2] {
    let mut random = Random(88_172_645_463_325_252);
    let mut counts = [0; 2];
    for _ in 0..24 {
        let [a, b] = shapes(&mut random);
        let turn = |random: &mut Random| random.direction() * angle;
        let [spin_a, spin_b, veer, drift] = [0; 4].map(|_| turn(&mut random));
        let [at_a, at_b] = [0; 2].map(|_| DQuat::from_axis_angle(random.direction(), random.number(0.0, 6.0)));
        let from = random.direction() * 4.0;
        let aim = random.direction() * random.number(0.0, 1.2);
        let mut told = None;
        for frame in 0..8 {
            let t = f64::from(frame);
            let a = Posed::new(&a, DQuat::from_scaled_axis(spin_a * t) * at_a, from + drift * t).expect(VALID);
            let b = Posed::new(&b, DQuat::from_scaled_axis(spin_b * t) * at_b, DVec3::ZERO).expect(VALID);
            let velocity_a = DQuat::from_scaled_axis(veer * t) * (aim - from);
            let motion = Motion { velocity_a, ..Motion::default() };
            let cold = linear_cast(&a, &b, motion, LinearCastOptions::new()).expect(VALID);
            let warm = linear_cast(&a, &b, motion, LinearCastOptions::new().with_warm_start(told)).expect(VALID);
            agree(&cold, &warm, velocity_a);
            if told.is_some() {
                counts[0] += cold.iterations;
                counts[1] += warm.iterations;
            }
            told = warm.warm_start(told);
        }
    }
    counts
}

/// Frame coherence. Between frames a tenth of a degree apart a warm cast takes half of the support points of a cold one
/// at hulls and ellipsoids. Where a cylinder's side or rim is hit, it has to look around the line as well for an upper
/// bound, and takes two thirds; and of boxes a cold cast takes little more than the four that a face takes.
#[test]
fn a_warm_cast_takes_fewer_support_points_to_the_same_answer() {
    let tenth = 0.1_f64.to_radians();
    let few = |name, shapes: fn(&mut Random) -> [Shape; 2], angle, part: f64| {
        let [cold, warm] = counts(shapes, angle);
        assert!(warm as f64 <= part * cold as f64, "{name} {angle}: {warm} of {cold}");
    };
    let hulls: fn(&mut Random) -> _ = |random| [hull(random, 64), hull(random, 64)];
    few("hulls", hulls, tenth, 0.5);
    few("hulls", hulls, 10.0 * tenth, 0.65);
    let ellipsoids: fn(&mut Random) -> _ = |random| [ellipsoid(random), ellipsoid(random)];
    few("ellipsoids", ellipsoids, tenth, 0.5);
    few("ellipsoids", ellipsoids, 10.0 * tenth, 0.6);
    few("box, ellipsoid", |random| [Box::new(cuboid(random)), ellipsoid(random)], tenth, 0.5);
    few("cylinder, hull", |random| [cylinder(random), hull(random, 300)], tenth, 0.7);
    few("cylinder, cone", |random| [cylinder(random), cone(random)], tenth, 0.7);
    few("boxes", |random| [0; 2].map(|_| Box::new(cuboid(random)) as Shape), tenth, 0.7);
    few("rounded boxes", |random| [rounded(random), rounded(random)], tenth, 0.85);
}

/// What is told may be wrong by as much as it likes. A search that it leaves in doubt is forgotten, and the cast begins
/// as a cold one does.
#[test]
fn a_warm_start_that_is_wrong_does_no_harm() {
    let mut random = Random(7);
    for i in 0..64 {
        let shapes = [cylinder(&mut random), hull(&mut random, 40), cone(&mut random), ellipsoid(&mut random)];
        let turn = DQuat::from_axis_angle(random.direction(), 1.0);
        let a = Posed::new(&shapes[i % 4], turn, random.direction() * 4.0).expect(VALID);
        let velocity_a = random.direction() * random.number(0.0, 0.5) - a.translation();
        let motion = Motion { velocity_a, ..Motion::default() };
        let b = &shapes[(i / 4 + 1) % 4];
        let cold = linear_cast(&a, b, motion, LinearCastOptions::new()).expect(VALID);
        let normal = cold.outcome.hit().and_then(|hit| hit.normal).unwrap_or(DVec3::X);
        let wrong = [random.direction(), -normal, normal.any_orthonormal_vector(), normal, DVec3::ZERO, DVec3::NAN];
        for axis in wrong {
            let options = LinearCastOptions::new().with_axis(axis);
            let warm = linear_cast(&a, b, motion, options).expect(VALID);
            agree(&cold, &warm, velocity_a);
            let by_gjk = linear_cast(&a, b, motion, options.with_method(CastMethod::Gjk)).expect(VALID);
            assert!(by_gjk.lower <= cold.upper && cold.lower <= by_gjk.upper, "{axis} {by_gjk:?} {cold:?}");
        }
    }
}

/// Where a warm cast takes all support points that it may, its bracket is the answer: a cold cast without any knows
/// less.
#[test]
fn a_warm_cast_that_uses_up_its_iterations_keeps_its_bracket() {
    let mut random = Random(11);
    let mut hits = 0;
    for _ in 0..32 {
        let [a, b] = [hull(&mut random, 40), cylinder(&mut random)];
        let a = Posed::translated(a, random.direction() * 4.0).expect(VALID);
        let motion = Motion { velocity_a: -a.translation(), ..Motion::default() };
        let cold = linear_cast(&a, &b, motion, LinearCastOptions::new()).expect(VALID);
        let Some(hit) = cold.outcome.hit() else { continue };
        let options = LinearCastOptions::new().with_axis(hit.normal.expect("on the way")).with_method(CastMethod::Gjk);
        let warm = linear_cast(&a, &b, motion, options.with_max_iterations(1)).expect(VALID);
        // The plane that is told is that of the contact.
        assert!(warm.iterations == 1 && (warm.lower - hit.time).abs() < 1e-12, "{warm:?} {cold:?}");
        hits += 1;
    }
    assert!(hits > 16, "{hits}");
}
