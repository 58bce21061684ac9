//! Lean options: what they leave out of a program makes answers wider, and never false.

use std::fmt::Debug;

use crate::common::behind_pointers::{distance, linear_cast, motion_cast, ray_cast, signed_distance};
use crate::common::{Random, s, ulps};
use convex_support::glam::{DVec2, DVec3, Vec2, Vec3A};
use convex_support::{Ball, Capsule, Cuboid, Point, Polytope, Posed, Rounded, Scalar, SupportMap, Vector};
use gjk_raycast::{
    CastMethod, DistanceOptions, LinearCastOptions, Motion, MotionCastOptions, Outcome, Ray, RayCastOptions,
    RigidMotion, SignedDistanceOptions, StartInContact, Status,
};

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

const VALID: &str = "valid numbers";

/// How many pairs are asked in each precision and dimension.
const PAIRS: usize = 300;

fn shape<V: Vector>(random: &mut Random, kind: usize) -> Shape<V> {
    let mut size = || s::<V>(random.number(0.2, 1.0));
    match kind % 5 {
        0 => Box::new(Ball::<V>::new(size()).expect(VALID)),
        1 => Box::new(Capsule::<V>::new(size(), size()).expect(VALID)),
        2 => Box::new(Cuboid::new(V::from_fn(|_| size())).expect(VALID)),
        3 => Box::new(Rounded::new(Cuboid::new(V::from_fn(|_| size())).expect(VALID), size()).expect(VALID)),
        _ => Box::new(Polytope::new((0..12).map(|_| random.vector::<V>(1.0)).collect::<Vec<_>>()).expect(VALID)),
    }
}

/// Two shapes, apart or in one another by about `gap`.
fn pair<V: Vector>(random: &mut Random, kind: usize, gap: f64) -> [Posed<Shape<V>>; 2] {
    let [a, b] = [shape(random, kind), shape(random, kind / 5)];
    let a = Posed::translated(a, V::ZERO).expect(VALID);
    let place = random.vector::<V>(1.0);
    let now = signed_distance(&a, &Posed::translated(&b, place).expect(VALID), SignedDistanceOptions::default());
    let place = place + now.normal * (now.signed_distance - s::<V>(gap));
    [a, Posed::translated(b, place).expect(VALID)]
}

/// Brackets of one truth have a number in common.
fn agree<S: Scalar>(lean: [S; 2], full: [S; 2], which: impl Debug) {
    assert!(lean[0] <= full[1] && full[0] <= lean[1], "{lean:?}, {full:?}: {which:?}");
}

/// Where nothing is near contact the code that is left out is not asked, and so the answers are the same.
fn distances_apart<V: Vector>() {
    let mut random = Random(1);
    for kind in 0..PAIRS {
        let gap = random.number(0.01, 2.0);
        let [a, b] = pair::<V>(&mut random, kind, gap);
        let full = distance(&a, &b, DistanceOptions::default());
        assert_eq!(distance(&a, &b, DistanceOptions::lean()), full, "{kind}");
    }
}

/// Near contact and in overlap GJK alone knows less: its bracket holds the truth, and what it decides is right.
fn distances_near_contact<V: Vector>() {
    let mut random = Random(2);
    let mut decided = 0;
    for kind in 0..PAIRS {
        let gap = if kind % 3 == 0 { random.number(-0.3, -0.1) } else { random.number(-30.0, 30.0) * ulps::<V>(1.0) };
        let [a, b] = pair::<V>(&mut random, kind, gap);
        let full = distance(&a, &b, DistanceOptions::default());
        let lean = distance(&a, &b, DistanceOptions::lean());
        agree([lean.lower, lean.upper], [full.lower, full.upper], kind);
        assert!(lean.overlap || lean.lower > V::Scalar::ZERO || lean.status != Status::Converged, "{lean:?}");
        assert!(lean.upper - lean.lower <= s::<V>(ulps::<V>(512.0)), "{kind}: {lean:?}");
        if kind % 3 == 0 {
            assert!(full.overlap && lean.overlap, "{kind}: {lean:?}");
            decided += usize::from(lean.status == Status::Converged);
        }
    }
    // Where the simplex has zero inside, that is a proof.
    assert!(decided > PAIRS / 4, "{decided}");
}

/// Rays at a body from all around: hits that are certain, misses, and grazes.
fn rays<V: Vector>() {
    let mut random = Random(3);
    for kind in 0..PAIRS {
        let target = Posed::translated(shape(&mut random, kind), V::ZERO).expect(VALID);
        let source = random.vector::<V>(1.0).unit().expect("not zero") * s::<V>(4.0);
        let aim = random.vector::<V>(if kind % 2 == 0 { 0.05 } else { 1.5 });
        let ray = Ray { source, direction: aim - source };
        let full = ray_cast(&target, ray, RayCastOptions::default()).expect("finite");
        let lean = ray_cast(&target, ray, RayCastOptions::lean()).expect("finite");
        agree([lean.lower, lean.upper], [full.lower, full.upper], kind);
        assert_eq!(lean.outcome.is_miss(), full.outcome.is_miss(), "{kind}: {lean:?}");
        assert_eq!(lean.is_certain(), full.is_certain(), "{kind}: {lean:?}");
    }
}

/// Casts of shapes that are apart are those of Algorithm 3; of shapes in contact at the start less is known.
fn linear_casts<V: Vector>() {
    let mut random = Random(4);
    let (zero, mut certain) = (V::Scalar::ZERO, 0);
    for kind in 0..PAIRS {
        let gap = [random.number(0.1, 2.0), random.number(-0.2, -0.1), random.number(-30.0, 30.0) * ulps::<V>(1.0)];
        let [a, b] = pair::<V>(&mut random, kind, gap[kind % 3]);
        let between = b.core().origin - a.core().origin;
        let motion = Motion { velocity_a: between + random.vector::<V>(0.5), velocity_b: V::ZERO };
        let cast = |options| linear_cast(&a, &b, motion, options).expect("finite");
        let (full, lean) = (cast(LinearCastOptions::default()), cast(LinearCastOptions::lean()));
        agree([lean.lower, lean.upper], [full.lower, full.upper], (kind, lean, full));
        // Neither contradicts what the other is certain of.
        for (one, other) in [(lean, full), (full, lean)] {
            let contradicts = one.outcome.is_hit() && one.is_certain() && other.outcome.is_miss();
            assert!(!contradicts, "{kind}: {lean:?}, {full:?}");
        }
        if kind % 3 == 0 && ![a.core(), b.core()].iter().any(|core| core.extent == zero) {
            assert_eq!(lean, cast(LinearCastOptions::default().with_method(CastMethod::Gjk)), "{kind}");
        }
        if kind % 3 == 1 {
            let Outcome::Hit(hit) = lean.outcome else { panic!("{kind}: {lean:?}") };
            assert_eq!((hit.time, lean.lower), (zero, zero), "{kind}");
            certain += usize::from(lean.is_certain());
            for body in [&a, &b] {
                let there = distance(body, &Point::new(hit.point).expect("finite"), DistanceOptions::default());
                assert!(there.distance <= s::<V>(ulps::<V>(64.0)), "{kind}: {there:?}");
            }
            let deeper = LinearCastOptions::lean().with_start_in_contact(StartInContact::IfDeeper);
            assert_eq!(cast(deeper).outcome, Outcome::Undecided, "nobody looks how deep they are");
        }
    }
    // Often the simplex that the search ends with has the start inside, which is a proof.
    assert!(certain >= PAIRS / 10, "{certain}");
}

#[test]
fn distances_of_bodies_well_apart_are_the_same_to_the_last_bit() {
    distances_apart::<Vec2>();
    distances_apart::<DVec2>();
    distances_apart::<Vec3A>();
    distances_apart::<DVec3>();
}

#[test]
fn distances_near_contact_are_wider_and_never_false() {
    distances_near_contact::<Vec2>();
    distances_near_contact::<DVec2>();
    distances_near_contact::<Vec3A>();
    distances_near_contact::<DVec3>();
}

#[test]
fn rays_are_decided_alike() {
    rays::<Vec2>();
    rays::<DVec2>();
    rays::<Vec3A>();
    rays::<DVec3>();
}

#[test]
fn linear_casts_are_those_of_algorithm_3() {
    linear_casts::<Vec2>();
    linear_casts::<DVec2>();
    linear_casts::<Vec3A>();
    linear_casts::<DVec3>();
}

/// Two bodies of which one turns, or only moves: the contact is found, and bracketed, as it is with all means.
#[test]
fn motion_casts_find_the_same_contacts() {
    let mut random = Random(5);
    let mut certain = [0; 2];
    for kind in 0..100 {
        let gap = random.number(0.1, 1.0);
        let [a, b] = pair::<DVec3>(&mut random, kind, gap);
        let velocity = b.core().origin - a.core().origin + random.vector::<DVec3>(0.3);
        let angular_velocity = if kind % 4 == 0 { DVec3::ZERO } else { random.vector(2.0) };
        let motion = RigidMotion { velocity, angular_velocity, center: a.core().origin };
        let cast = |options: MotionCastOptions<DVec3>| {
            motion_cast(&a, motion, &b, RigidMotion::default(), options.with_max_time(1.5)).expect("finite")
        };
        let (full, lean) = (cast(MotionCastOptions::default()), cast(MotionCastOptions::lean()));
        agree([lean.lower, lean.upper], [full.lower, full.upper], (kind, lean, full));
        for (count, cast) in certain.iter_mut().zip([&full, &lean]) {
            *count += usize::from(cast.is_certain() || cast.outcome.is_miss());
        }
        if let (Outcome::Hit(found), Outcome::Hit(hit)) = (full.outcome, lean.outcome) {
            assert!((found.time - hit.time).abs() < 1e-9, "{kind}: {found:?}, {hit:?}");
        }
    }
    assert!(certain[1] + 2 >= certain[0], "{certain:?}");
}

/// Lean options are as equal, and as data, as others: what they name is no number of theirs.
#[test]
fn options_know_whether_they_are_lean() {
    let (lean, full) = (DistanceOptions::<DVec3>::lean(), DistanceOptions::<DVec3>::new());
    assert_ne!(lean, full);
    assert_eq!(lean.with_limit(2.0), DistanceOptions::lean().with_limit(2.0));
    assert!(format!("{lean:?}").contains("Lean") && format!("{full:?}").contains("Full"));
}
