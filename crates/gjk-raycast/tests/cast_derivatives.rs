//! Derivatives of the times of hits, and of the parameters of rays, against differences of them.

use crate::common::behind_pointers::{linear_cast, motion_cast, ray_cast};
use crate::differences::{Body, Comparison, Random, Space, central};
use convex_support::glam::{DVec2, DVec3};
use convex_support::{AngularVelocity, Capsule, Cuboid, Posed, Rounded};
use gjk_raycast::{
    Impact, ImpactGradient, LinearCastOptions, Motion, MotionCastOptions, Ray, RayCastOptions, RayHit, RigidMotion,
    Smoothness,
};

const VALID: &str = "positive sizes and finite numbers";

/// The radius by which the first body is grown.
const RADIUS: f64 = 0.1;

/// Asks `compare` of random pairs of all kinds that are apart, and how often it could say something.
fn all_pairs<V: Space, const N: usize>(
    seed: u64,
    rounds: usize,
    mut compare: impl FnMut(&Body<V>, &Body<V>, &mut Random, &mut [Comparison; N], &str),
) where
    [Comparison; N]: Default,
{
    let mut random = Random(seed);
    let mut comparisons: [Comparison; N] = Default::default();
    for (i, kind_a) in V::KINDS.iter().enumerate() {
        for kind_b in &V::KINDS[i..] {
            for round in 0..rounds {
                let a = Body::<V>::random(kind_a, &mut random);
                let b = Body::random(kind_b, &mut random).placed(&a, false, &mut random);
                compare(&a, &b, &mut random, &mut comparisons, &format!("{kind_a} and {kind_b}, round {round}"));
            }
        }
    }
    comparisons.iter().for_each(Comparison::check);
}

/// A velocity that leads one body about to the other.
fn towards<V: Space>(a: &Body<V>, b: &Body<V>, random: &mut Random) -> V {
    b.shape.translation() - a.shape.translation() + random.vector::<V>(1.0) * 0.3
}

fn compare_linear<V: Space>(a: &Body<V>, b: &Body<V>, random: &mut Random, all: &mut [Comparison; 4], what: &str) {
    let motion = Motion { velocity_a: towards(a, b, random), velocity_b: random.vector::<V>(1.0) * 0.3 };
    let (change_a, change_b) = (random.motion(), random.motion());
    let (faster_a, faster_b) = (random.vector::<V>(1.0), random.vector::<V>(1.0));
    let cast = |[poses, velocities, radius]: [f64; 3]| -> Option<Impact<V>> {
        let motion = Motion {
            velocity_a: motion.velocity_a + faster_a * velocities,
            velocity_b: motion.velocity_b + faster_b * velocities,
        };
        let a = Rounded::new(a.moved(&change_a, poses), RADIUS + radius).expect(VALID);
        let options = LinearCastOptions::new().with_tolerance(0.0);
        linear_cast(&a, &b.moved(&change_b, poses), motion, options).expect("finite").outcome.hit()
    };
    let rounded = Rounded::new(&a.shape, RADIUS).expect(VALID);
    let [motion_a, motion_b] = &motion.translations();
    let Some((hit, features)) =
        cast([0.0; 3]).and_then(|hit| Some((hit, hit.closest_features(&rounded, motion_a, &b.shape, motion_b)?)))
    else {
        return;
    };
    assert_eq!(features.smoothness(), Smoothness::Smooth, "{what}: {features:?}");
    let rough = hit.gradient(motion_a, motion_b).expect("it approaches");
    let gradient = hit.refined(&features).gradient(motion_a, motion_b).expect("it approaches");
    let by_velocity = |gradient: &ImpactGradient<V>| gradient.contact_a.translation * hit.time;
    let size = 1.0 + by_velocity(&gradient).length() + gradient.pose_a.translation.length();
    let error = (by_velocity(&rough) - by_velocity(&gradient)).length();
    assert!(error < 1e-6 * size * size, "{what}: {rough:?}, {gradient:?}");

    let rate = hit.rate((&rounded, motion_a, change_a), (&b.shape, motion_b, change_b)).expect("one normal");
    let by_pose = change_a.rate_of(gradient.pose_a) + change_b.rate_of(gradient.pose_b);
    assert!((rate - by_pose).abs() < 1e-10 * size * size, "{what}: {rate} and {by_pose}");
    let by_velocity = by_velocity(&gradient).dot(faster_a - faster_b);
    for (k, ours) in [by_pose, by_velocity, gradient.radius].into_iter().enumerate() {
        let time = |t| cast([0, 1, 2].map(|i| if i == k { t } else { 0.0 })).map_or(f64::NAN, |hit| hit.time);
        all[k].add(ours, central(time, 0.01), &|| format!("derivative {k} of {what}: {hit:?}, {gradient:?}"));
    }
    all[3].add(rate, (by_pose, 1e-9 * size), &|| format!("the rate of {what}"));
}

#[test]
fn times_of_linear_casts_change_as_differences_say() {
    all_pairs::<DVec3, 4>(11, 15, compare_linear);
    all_pairs::<DVec2, 4>(12, 15, compare_linear);
}

fn compare_motion<V: Space>(a: &Body<V>, b: &Body<V>, random: &mut Random, all: &mut [Comparison; 5], what: &str) {
    let motions = [RigidMotion { velocity: towards(a, b, random), ..random.motion() }, random.motion()];
    let [poses, changes] = [0, 1].map(|_| [0, 1].map(|_| random.motion::<V>()));
    // How far apart they are to be at the hit.
    let distance = if random.signed() > 0.0 { 0.07 } else { 0.0 };
    let cast = |[pose, velocity, angular, center, radius]: [f64; 5]| -> Option<Impact<V>> {
        let [motion_a, motion_b] = [0, 1].map(|i| RigidMotion {
            velocity: motions[i].velocity + changes[i].velocity * velocity,
            angular_velocity: V::AngularVelocity::from_coordinates(|k| {
                let coordinate = |m: &RigidMotion<V>| m.angular_velocity.coordinate(k);
                coordinate(&motions[i]) + coordinate(&changes[i]) * angular
            }),
            center: motions[i].center + changes[i].center * center,
        });
        let a = Rounded::new(a.moved(&poses[0], pose), RADIUS + radius).expect(VALID);
        let options = MotionCastOptions::new().with_max_time(3.0).with_tolerance(0.0).with_target_distance(distance);
        motion_cast(&a, motion_a, &b.moved(&poses[1], pose), motion_b, options).expect("finite").outcome.hit()
    };
    let rounded = Rounded::new(&a.shape, RADIUS).expect(VALID);
    let [motion_a, motion_b] = &motions;
    let Some((hit, features)) =
        cast([0.0; 5]).and_then(|hit| Some((hit, hit.closest_features(&rounded, motion_a, &b.shape, motion_b)?)))
    else {
        return;
    };
    assert_eq!(features.smoothness(), Smoothness::Smooth, "{what}: {features:?}");
    let Some(gradient) = hit.refined(&features).gradient(motion_a, motion_b) else { return };
    let by_pose = poses[0].rate_of(gradient.pose_a) + poses[1].rate_of(gradient.pose_b);
    let rate = hit.rate((&rounded, motion_a, poses[0]), (&b.shape, motion_b, poses[1])).expect("one normal");
    assert!((rate - by_pose).abs() < 1e-9 * (1.0 + rate * rate), "{what}: {rate} and {by_pose}");
    let [by_a, by_b] = [(motion_a, gradient.contact_a), (motion_b, gradient.contact_b)]
        .map(|(motion, force)| motion.gradient(hit.time, force));
    let turning = |by: V::AngularVelocity, change: &RigidMotion<V>| -> f64 {
        (0..V::DIM * (V::DIM - 1) / 2).map(|k| by.coordinate(k) * change.angular_velocity.coordinate(k)).sum()
    };
    let ours = [
        by_pose,
        by_a.velocity.dot(changes[0].velocity) + by_b.velocity.dot(changes[1].velocity),
        turning(by_a.angular_velocity, &changes[0]) + turning(by_b.angular_velocity, &changes[1]),
        by_a.center.dot(changes[0].center) + by_b.center.dot(changes[1].center),
        gradient.radius,
    ];
    for (k, ours) in ours.into_iter().enumerate() {
        let parameters = |t: f64| [0, 1, 2, 3, 4].map(|i| if i == k { t } else { 0.0 });
        let time = |t| cast(parameters(t)).map_or(f64::NAN, |hit| hit.time);
        all[k].add(ours, central(time, 0.01), &|| format!("derivative {k} of {what}: {hit:?}, {gradient:?}"));
    }
}

#[test]
fn times_of_motion_casts_change_as_differences_say() {
    all_pairs::<DVec3, 5>(13, 8, compare_motion);
    all_pairs::<DVec2, 5>(14, 8, compare_motion);
}

fn compare_ray<V: Space>(target: &Body<V>, from: &Body<V>, random: &mut Random, all: &mut [Comparison; 4], what: &str) {
    let ray = Ray { source: from.shape.translation(), direction: towards(from, target, random) };
    let (pose, source, direction) = (random.motion(), random.vector::<V>(1.0), random.vector::<V>(1.0));
    let cast = |[moved, shifted, turned, grown]: [f64; 4]| -> Option<RayHit<V>> {
        let target = Rounded::new(target.moved(&pose, moved), RADIUS + grown).expect(VALID);
        let ray = Ray { source: ray.source + source * shifted, direction: ray.direction + direction * turned };
        ray_cast(&target, ray, RayCastOptions::new().with_tolerance(0.0)).expect("finite").outcome.hit()
    };
    let rounded = Rounded::new(&target.shape, RADIUS).expect(VALID);
    let Some((hit, features)) = cast([0.0; 4]).and_then(|hit| Some((hit, hit.closest_features(&rounded, ray)?))) else {
        return;
    };
    assert_eq!(features.smoothness(), Smoothness::Smooth, "{what}: {features:?}");
    let gradient = hit.refined(&features).gradient(ray).expect("it comes from outside");
    let ours = [
        pose.rate_of(gradient.target),
        gradient.source.dot(source),
        gradient.direction.dot(direction),
        gradient.radius,
    ];
    for (k, ours) in ours.into_iter().enumerate() {
        let lambda = |t| cast([0, 1, 2, 3].map(|i| if i == k { t } else { 0.0 })).map_or(f64::NAN, |hit| hit.lambda);
        all[k].add(ours, central(lambda, 0.01), &|| format!("derivative {k} of {what}: {hit:?}, {gradient:?}"));
    }
}

#[test]
fn parameters_of_rays_change_as_differences_say() {
    all_pairs::<DVec3, 4>(15, 20, compare_ray);
    all_pairs::<DVec2, 4>(16, 20, compare_ray);
}

/// A link that turns by 0.8 rad while it is cast. To take its point of contact for one that only moves, with the
/// velocity of the centre, as some do, is wrong by a good part.
#[test]
fn a_turning_cast_is_derived_with_its_turn() {
    let bin = Posed::translated(Cuboid::new(DVec3::new(0.3, 0.2, 0.4)).expect(VALID), DVec3::new(0.9, 0.55, 0.1))
        .expect(VALID);
    let motion =
        RigidMotion { velocity: DVec3::new(0.25, 0.0, 0.05), angular_velocity: DVec3::Z * -0.8, center: DVec3::ZERO };
    let rest = RigidMotion::default();
    let time = |by: f64| {
        let at = DVec3::new(0.1 + by, 0.0, 0.0);
        let link = Posed::translated(Capsule::<DVec3>::new(0.6, 0.08).expect(VALID), at).expect(VALID);
        let options = MotionCastOptions::new().with_max_time(2.0).with_tolerance(0.0);
        motion_cast(&link, motion, &bin, rest, options).expect("finite").outcome.hit()
    };
    let hit = time(0.0).expect("it swings into the bin");
    let gradient = hit.gradient(&motion, &rest).expect("it approaches");
    let (difference, error) = central(|by| time(by).map_or(f64::NAN, |hit| hit.time), 1e-2);
    let ours = gradient.pose_a.translation.x;
    assert!((ours - difference).abs() < 1e-10 + 4.0 * error, "{ours}, not {difference} ± {error}");
    let normal = hit.normal.expect("they touch later");
    let frozen = -normal.x / normal.dot(motion.velocity);
    assert!((frozen / ours - 1.0).abs() > 0.1, "frozen it would be {frozen}, and is {ours}");
    // A hit at the start has no time to change.
    assert_eq!(Impact { time: 0.0, normal: None, ..hit }.gradient(&motion, &rest), None);
}
