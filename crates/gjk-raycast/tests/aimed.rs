//! Casts that are aimed at edges, rims, apexes and along faces, or begin there: where single precision sees one face,
//! the next may be within its error. What it says is held against double precision, asked of the same numbers.

use crate::common::Random;
use crate::common::behind_pointers::{linear_cast, ray_cast, signed_distance};
use convex_support::glam::{DQuat, DVec3, Quat, Vec2, Vec3A};
use convex_support::{
    Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Posed, Rounded, SupportMap, glam::EulerRot,
};
use gjk_raycast::{LinearCastOptions, Motion, Outcome, Ray, RayCastOptions, SignedDistanceOptions, Status};

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

/// A shape in both precisions, of the same numbers.
struct Twin {
    name: &'static str,
    single: Shape<Vec3A>,
    double: Shape<DVec3>,
}

fn single(random: &mut Random, from: f64, to: f64) -> f32 {
    random.number(from, to) as f32
}

fn vector(random: &mut Random, from: f64, to: f64) -> Vec3A {
    Vec3A::from_array([0; 3].map(|_| single(random, from, to)))
}

macro_rules! twin {
    ($name:literal, $shape:expr, $wide:expr) => {
        Twin {
            name: $name,
            single: Box::new($shape.expect("positive sizes")),
            double: Box::new($wide.expect("positive sizes")),
        }
    };
}

fn twin(random: &mut Random) -> Twin {
    let h = vector(random, 0.05, 1.5);
    let wide = h.as_dvec3();
    match random.number(0.0, 7.0) as usize {
        0 => twin!("cuboid", Cuboid::new(h), Cuboid::new(wide)),
        1 => twin!("cylinder", Cylinder::<Vec3A>::new(h.x, h.y), Cylinder::<DVec3>::new(wide.x, wide.y)),
        2 => twin!("cone", Cone::<Vec3A>::new(h.x, h.y), Cone::<DVec3>::new(wide.x, wide.y)),
        3 => twin!("capsule", Capsule::<Vec3A>::new(h.x, h.y), Capsule::<DVec3>::new(wide.x, wide.y)),
        4 => twin!(
            "ellipsoid",
            Ellipsoid::new(Vec3A::ZERO, h, Quat::IDENTITY),
            Ellipsoid::new(DVec3::ZERO, wide, DQuat::IDENTITY)
        ),
        5 => {
            let core = |h| Cuboid::new(h).expect("positive sizes");
            let core_wide = Cuboid::new(wide).expect("positive sizes");
            twin!("rounded box", Rounded::new(core(h), h.x * 0.25), Rounded::new(core_wide, wide.x * 0.25))
        }
        _ => {
            let points: Vec<_> = (0..12).map(|_| vector(random, -1.0, 1.0)).collect();
            let wide: Vec<_> = points.iter().map(|p| p.as_dvec3()).collect();
            twin!("hull", Polytope::new(points), Polytope::new(wide))
        }
    }
}

/// A pose in both precisions, sometimes far away, sometimes none.
fn pose(random: &mut Random) -> (Quat, Vec3A) {
    let far = [0.0, 1.0, 10.0, 100.0][random.number(0.0, 4.0) as usize];
    let translation = vector(random, -1.0, 1.0) * far as f32;
    let [x, y, z] = [0; 3].map(|_| single(random, -3.0, 3.0));
    let is_turned = random.number(0.0, 4.0) > 1.0;
    (if is_turned { Quat::from_euler(EulerRot::XYZ, x, y, z) } else { Quat::IDENTITY }, translation)
}

fn posed(twin: &Twin, (q, t): (Quat, Vec3A)) -> (Posed<&Shape<Vec3A>>, Posed<&Shape<DVec3>>) {
    let wide = Posed::new(&twin.double, q.as_dquat().normalize(), t.as_dvec3()).expect("a rotation");
    (Posed::new(&twin.single, q, t).expect("a rotation"), wide)
}

/// A direction: any, along the surface with the normal, or nearly so.
fn direction(random: &mut Random, normal: DVec3) -> DVec3 {
    let d = vector(random, -1.0, 1.0).as_dvec3();
    let share = [0.0, 1.0, 1.0 - 1e-6, 1.0 - 1e-3 * random.number(0.0, 1.0)][random.number(0.0, 4.0) as usize];
    d - normal * (d.dot(normal) * share)
}

/// How far from the place that is aimed at a cast begins, in units of its direction.
fn distance_back(random: &mut Random) -> f64 {
    [0.0, 0.0, 1.0, 3.0][random.number(0.0, 4.0) as usize]
}

/// A point moved by an ulp or so.
fn nudged(random: &mut Random, at: DVec3) -> Vec3A {
    let at = at.as_vec3a();
    at + vector(random, -1.5, 1.5).round() * (at.abs().max_element().max(0.5) * f32::EPSILON * 0.5)
}

/// What is wrong with an answer, if another is certain to all of its digits.
fn wrong<H, V, I, W>(
    (outcome, [lower, upper]): (&Outcome<H, V>, [f32; 2]),
    (truth, [least, most], status): (&Outcome<I, W>, [f64; 2], Status),
) -> Option<&'static str> {
    let is_certain = status == Status::Converged && most.is_finite();
    match (outcome, truth) {
        (Outcome::Hit(_), Outcome::Hit(_)) if f64::from(upper) < least => Some("ends too early"),
        (Outcome::Hit(_), Outcome::Hit(_)) if f64::from(lower) > most => Some("begins too late"),
        (Outcome::Miss(_), Outcome::Hit(_)) if is_certain => Some("misses"),
        (Outcome::Hit(_), Outcome::Miss(_)) if upper.is_finite() => Some("is certain of a hit that is none"),
        _ => None,
    }
}

#[test]
fn rays_hold_what_double_precision_finds() {
    let mut random = Random(20_041_120);
    for i in 0..6000 {
        let shape = twin(&mut random);
        let (narrow, wide) = posed(&shape, pose(&mut random));
        // A support point is at an edge, a corner or a rim, and the sum of two may be on a face.
        let [n, m] = [0; 2].map(|_| vector(&mut random, -1.0, 1.0).round().as_dvec3());
        let share = [0.0, random.number(0.0, 1.0)][random.number(0.0, 2.0) as usize];
        let at = wide.support(n) * (1.0 - share) + wide.support(m) * share;
        let d = direction(&mut random, n.normalize_or_zero()).as_vec3a();
        if d == Vec3A::ZERO {
            continue;
        }
        let source = at - d.as_dvec3() * distance_back(&mut random);
        let source = nudged(&mut random, source);
        let ray = Ray { source, direction: d };
        let seen = ray_cast(&narrow, ray, RayCastOptions::default()).expect("a direction");
        let ray = Ray { source: source.as_dvec3(), direction: d.as_dvec3() };
        let truth = ray_cast(&wide, ray, RayCastOptions::default()).expect("a direction");
        let found = wrong(
            (&seen.outcome, [seen.lower, seen.upper]),
            (&truth.outcome, [truth.lower, truth.upper], truth.status),
        );
        assert_eq!(found, None, "{i}: {} {ray:?}\n{seen:?}\n{truth:?}", shape.name);
    }
}

/// In the plane: polygons, thin ones too, and rays at their corners and along their sides.
#[test]
fn planar_rays_hold_what_double_precision_finds() {
    let mut random = Random(20_041_122);
    for i in 0..6000 {
        let thin = [1.0, 1e-3, 1e-6][random.number(0.0, 3.0) as usize] as f32;
        let points = [0; 5].map(|_| Vec2::new(single(&mut random, -1.0, 1.0), thin * single(&mut random, -1.0, 1.0)));
        let (Ok(narrow), Ok(wide)) = (Polytope::new(points), Polytope::new(points.map(|p| p.as_dvec2()))) else {
            continue;
        };
        let turn = [0.0, single(&mut random, -3.0, 3.0)][random.number(0.0, 2.0) as usize];
        let place = Vec2::new(single(&mut random, -1.0, 1.0), single(&mut random, -10.0, 10.0));
        let narrow = Posed::new(narrow, turn, place).expect("a rotation");
        let wide = Posed::new(wide, f64::from(turn), place.as_dvec2()).expect("a rotation");
        let towards = Vec2::new(single(&mut random, -1.0, 1.0), single(&mut random, -1.0, 1.0));
        let (from, to) = (wide.support(towards.as_dvec2()), wide.support(towards.perp().as_dvec2()));
        let along = (to - from) * [0.0, 1.0][random.number(0.0, 2.0) as usize];
        let d = (along + towards.as_dvec2() * random.number(0.0, 1.0).powi(9)).as_vec2();
        let ray = Ray { source: (from - d.as_dvec2() * 3.0).as_vec2(), direction: d };
        let Ok(seen) = ray_cast(&narrow, ray, RayCastOptions::default()) else { continue };
        let ray = Ray { source: ray.source.as_dvec2(), direction: d.as_dvec2() };
        let truth = ray_cast(&wide, ray, RayCastOptions::default()).expect("a direction");
        let found = wrong(
            (&seen.outcome, [seen.lower, seen.upper]),
            (&truth.outcome, [truth.lower, truth.upper], truth.status),
        );
        assert_eq!(found, None, "{i}: {points:?} {turn} {place} {ray:?}\n{seen:?}\n{truth:?}");
    }
}

#[test]
fn linear_casts_hold_what_double_precision_finds() {
    let mut random = Random(20_041_121);
    for i in 0..3000 {
        let (a, b) = (twin(&mut random), twin(&mut random));
        let (pose_a, (turn, _)) = (pose(&mut random), pose(&mut random));
        let (narrow_a, wide_a) = posed(&a, pose_a);
        let beside = pose_a.1.as_dvec3() + vector(&mut random, -4.0, 4.0).as_dvec3();
        let wide_b = Posed::new(&b.double, turn.as_dquat().normalize(), beside).expect("a rotation");
        let apart = signed_distance(&wide_a, &wide_b, SignedDistanceOptions::default());
        let touching = beside + apart.normal * apart.signed_distance;
        let d = direction(&mut random, apart.normal).as_vec3a();
        let start = touching - d.as_dvec3() * distance_back(&mut random);
        let start = nudged(&mut random, start);
        let (narrow_b, wide_b) = posed(&b, (turn, start));
        let motion = Motion { velocity_a: Vec3A::ZERO, velocity_b: d };
        let seen = linear_cast(&narrow_a, &narrow_b, motion, LinearCastOptions::default()).expect("finite");
        let motion = Motion { velocity_a: DVec3::ZERO, velocity_b: d.as_dvec3() };
        let truth = linear_cast(&wide_a, &wide_b, motion, LinearCastOptions::default()).expect("finite");
        let found = wrong(
            (&seen.outcome, [seen.lower, seen.upper]),
            (&truth.outcome, [truth.lower, truth.upper], truth.status),
        );
        assert_eq!(found, None, "{i}: {} {} {motion:?}\n{seen:?}\n{truth:?}", a.name, b.name);
    }
}

/// A cone comes along its base past an edge of a box, 6e-7 apart: the search counted a point beside the known ones, of
/// a negative weight, for one of the bodies, and reported a hit 3e-6 apart.
#[test]
fn a_combination_with_a_negative_weight_is_no_point_of_the_bodies() {
    let [half_height, radius] = [1.037_221_1_f32, 0.535_111_07].map(f64::from);
    let cone = Cone::<DVec3>::new(half_height, radius).expect("positive sizes");
    let cone = Posed::translated(cone, Vec3A::new(-6.705_014_7, -0.445_399_28, -9.312_343).as_dvec3()).expect("finite");
    let half_extents = Vec3A::new(0.399_812_1, 0.239_074_4, 0.588_285_57).as_dvec3();
    let at = Vec3A::new(-7.465_195_7, -1.721_695_3, -10.296_202).as_dvec3();
    let cuboid = Posed::translated(Cuboid::new(half_extents).expect("positive sizes"), at).expect("finite");
    let velocity = Vec3A::new(-0.954_584, 0.003_154_835_2, 0.850_249_5).as_dvec3();
    let motion = Motion { velocity_a: DVec3::ZERO, velocity_b: velocity };
    let cast = linear_cast(&cone, &cuboid, motion, LinearCastOptions::default()).expect("finite");
    assert!(cast.outcome.is_miss(), "{cast:?}");
}
