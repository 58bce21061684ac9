//! What is called certain of a cast is true where rounding alone could decide: of rays through points and specks far
//! smaller than the rounding of their sources' distance, and of casts that end at their own hit.

use std::cmp::Ordering;

use crate::common::{s, v};
use convex_support::glam::{DVec2, DVec3, Vec2, Vec3};
use convex_support::{Ball, Cuboid, Ellipsoid, Point, Posed, Scalar, Segment, SupportMap, Vector};
use gjk_raycast::{
    Cast, CastMethod, LinearCastOptions, Motion, MotionCastOptions, Ray, RayCastOptions, RayEntry, Scene, WarmStart,
    linear_cast, motion_cast, ray_cast, ray_entries_into, ray_exit,
};

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

/// Pseudorandom whole numbers, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn within(&mut self, least: i64, most: i64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        least + ((self.0 >> 33) % (most - least + 1).unsigned_abs()) as i64
    }
}

fn specks<V: Vector>(size: V::Scalar) -> Vec<Shape<V>> {
    const VALID: &str = "finite sizes";
    let zero = V::Scalar::ZERO;
    vec![
        Box::new(Point::new(V::ZERO).expect(VALID)),
        Box::new(Ball::<V>::new(zero).expect(VALID)),
        Box::new(Cuboid::new(V::ZERO).expect(VALID)),
        Box::new(Segment::new([V::ZERO; 2]).expect(VALID)),
        Box::new(Ball::<V>::new(size).expect(VALID)),
        Box::new(Cuboid::new(V::splat(size)).expect(VALID)),
        Box::new(Segment::new([V::splat(-size), V::splat(size)]).expect(VALID)),
        Box::new(Ellipsoid::new(V::ZERO, V::splat(size), Default::default()).expect(VALID)),
    ]
}

/// Of a ray, or of two bodies that move along it: the first common point, by all queries that know one.
fn casts<V: Vector>(target: &Shape<V>, center: V, ray: Ray<V>) -> Vec<(&'static str, bool, Option<bool>)> {
    let target = &Posed::translated(&**target, center).expect("finite");
    let source = &Posed::translated(Point::new(V::ZERO).expect("finite"), ray.source).expect("finite");
    let motion = Motion { velocity_a: V::ZERO, velocity_b: ray.direction };
    let [at_rest, along] = motion.translations();
    fn seen<H, V: Vector>(cast: Cast<H, V>) -> (bool, Option<bool>) {
        assert!(!cast.lower.as_f64().is_nan() && !cast.upper.as_f64().is_nan(), "a bound is a number");
        (cast.is_certain(), if cast.outcome.is_undecided() { None } else { Some(cast.outcome.is_hit()) })
    }
    let rays = RayCastOptions::new();
    let warm = rays.with_warm_start(Some(WarmStart::new(ray.direction)));
    let by_ray = |options| seen(ray_cast(target, ray, options).expect("finite"));
    let by_motion = |options| seen(linear_cast(target, source, motion, options).expect("finite"));
    let turning = |options| seen(motion_cast(target, at_rest, source, along, options).expect("finite"));
    let exit = ray_exit(target, ray, rays).expect("finite");
    let first = Scene::new([target]).expect("finite").all().ray_cast(ray, rays).expect("finite");
    let seen = [
        ("ray", by_ray(rays)),
        ("lean ray", by_ray(RayCastOptions::lean())),
        ("ray by Algorithm 3", by_ray(rays.with_method(CastMethod::Gjk))),
        ("warm ray", by_ray(warm)),
        ("linear cast", by_motion(LinearCastOptions::new())),
        ("lean linear cast", by_motion(LinearCastOptions::lean())),
        ("straight motion", turning(MotionCastOptions::new())),
        ("lean straight motion", turning(MotionCastOptions::lean())),
        ("exit", (exit.is_certain(), Some(exit.outcome.is_hit()))),
        ("scene", (first.is_certain(), Some(first.first.is_some()))),
    ];
    seen.map(|(name, (is_certain, is_hit))| (name, is_certain, is_hit)).into()
}

/// A ray whose source is a whole number of its direction's parts from a point hits it exactly, and one beside a body by
/// twice its size misses it, however small the body is.
fn specks_are_hit_and_passed<V: Vector>(least: i64, farthest: i64, digits: u32) {
    let (mut numbers, most) = (Numbers(1), 1 << digits);
    let power = |n: i64| s::<V>((n as f64).exp2());
    for round in 0..60 {
        let size = power(numbers.within(least, 0));
        let unit = power(numbers.within(-4, farthest));
        let [times, parts] = [numbers.within(1, most), numbers.within(1, most)].map(|n| s::<V>(n as f64));
        let way: V = V::from_fn(|_| s::<V>(numbers.within(-most, most) as f64));
        // Across the way.
        let aside = V::from_fn(|i| [-way.get(1), way.get(0), V::Scalar::ZERO][i]);
        if aside == V::ZERO {
            continue;
        }
        let ray = Ray { source: way * (-times * unit), direction: way * parts };
        for (kind, target) in specks::<V>(size).iter().enumerate() {
            for (name, is_certain, is_hit) in casts(target, V::ZERO, ray) {
                let is_false = is_certain && is_hit == Some(false);
                assert!(!is_false, "{round} {kind} {name}: {ray:?} through a body of {size:?}");
            }
            // No part of it is this near to the line.
            for (name, is_certain, is_hit) in casts(target, aside * (size * s::<V>(4.0)), ray) {
                let is_false = is_certain && is_hit == Some(true);
                assert!(!is_false, "{round} {kind} {name}: {ray:?} beside a body of {size:?}");
            }
        }
    }
}

#[test]
fn a_speck_that_is_hit_is_no_certain_miss() {
    specks_are_hit_and_passed::<DVec3>(-250, 250, 16);
    specks_are_hit_and_passed::<DVec2>(-250, 250, 16);
    specks_are_hit_and_passed::<Vec3>(-50, 40, 7);
    specks_are_hit_and_passed::<Vec2>(-50, 40, 7);
}

/// A number compared with a fraction of whole numbers, exactly.
fn compared(number: f64, [above, below]: [i64; 2]) -> Ordering {
    let (bits, is_normal) = (number.to_bits(), number >= 1.0 / 1024.0);
    assert!(is_normal && below > 0, "in range");
    let (digits, shift) = (i128::from((bits & ((1 << 52) - 1)) | (1 << 52)), 1075 - (bits >> 52) as i64);
    (digits * i128::from(below)).cmp(&(i128::from(above) << shift))
}

/// A box that is entered through the side across x at a known fraction, by casts that end at the number next to it.
fn casts_end_at_their_hit<V: Vector>(digits: u32) {
    let mut numbers = Numbers(2);
    for round in 0..400 {
        let half = V::from_fn(|_| s::<V>(numbers.within(1, 20) as f64));
        let (gap, speed) = (numbers.within(1, 50), numbers.within(1, 30));
        let source = V::from_fn(|i| if i == 0 { -half.get(0) - s::<V>(gap as f64) } else { V::Scalar::ZERO });
        // So flat that it enters through that side.
        let direction = V::from_fn(|i| s::<V>(if i == 0 { speed as f64 } else { speed as f64 / 1024.0 }));
        let nearest = s::<V>(gap as f64 / speed as f64);
        let ulp = nearest.as_f64() * f64::from(digits).exp2().recip();
        let end = s::<V>(nearest.as_f64() + ulp * numbers.within(-2, 2) as f64);
        let is_hit = compared(end.as_f64(), [gap, speed]) != Ordering::Less;
        let target = Cuboid::new(half).expect("positive");
        let (ray, axis) = (Ray { source, direction }, V::axis(1) - V::axis(0));
        let mut told = Vec::new();
        let rays = RayCastOptions::new();
        let short = rays.with_min_lambda(nearest * s::<V>(0.5));
        let loose = rays.with_tolerance(s::<V>(0.1));
        let by_gjk = rays.with_method(CastMethod::Gjk);
        for options in [rays, short, loose, by_gjk, rays.with_axis(axis), RayCastOptions::lean()] {
            let options = options.with_max_lambda(end);
            let cast = ray_cast(&target, ray, options).expect("finite");
            told.push((cast.outcome.is_miss(), cast.outcome.hit().map(|hit| hit.lambda), cast.upper));
            let mut entry = [RayEntry::default()];
            ray_entries_into(&target, &[ray], options, &mut entry).expect("finite");
            let alone = [RayEntry::from(cast)];
            // NaN is not equal to itself.
            assert_eq!(format!("{entry:?}"), format!("{alone:?}"), "{round}: {options:?}");
        }
        let a = Cuboid::new(half * s::<V>(0.5)).expect("positive");
        let b = Posed::translated(a, source).expect("finite");
        let motion = Motion { velocity_a: -direction, velocity_b: V::ZERO };
        let linear = LinearCastOptions::new();
        for options in [linear, linear.with_method(CastMethod::Gjk), linear.with_axis(axis), LinearCastOptions::lean()]
        {
            let options = options.with_max_time(end);
            let cast = linear_cast(&a, &b, motion, options).expect("finite");
            told.push((cast.outcome.is_miss(), cast.outcome.hit().map(|hit| hit.time), cast.upper));
            let swapped = Motion { velocity_a: motion.velocity_b, velocity_b: motion.velocity_a };
            let cast = linear_cast(&b, &a, swapped, options).expect("finite");
            told.push((cast.outcome.is_miss(), cast.outcome.hit().map(|hit| hit.time), cast.upper));
        }
        let [moves, rests] = motion.translations();
        for options in [MotionCastOptions::new(), MotionCastOptions::lean()] {
            let cast = motion_cast(&a, moves, &b, rests, options.with_max_time(end)).expect("finite");
            told.push((cast.outcome.is_miss(), cast.outcome.hit().map(|hit| hit.time), cast.upper));
        }
        for (index, (is_miss, time, upper)) in told.into_iter().enumerate() {
            let context = format!("{round}, {index}: {time:?}, {upper:?}, {ray:?} until {end:?} at {half:?}");
            let is_bounded = upper.as_f64() < f64::INFINITY;
            assert!(!is_bounded || is_hit && upper <= end, "{context}");
            assert!(!is_miss || !is_hit, "{context}");
            assert!(time.is_none_or(|time| time <= end), "{context}");
        }
    }
}

#[test]
fn a_cast_that_ends_at_its_hit_is_certain_of_nothing_false() {
    casts_end_at_their_hit::<DVec3>(52);
    casts_end_at_their_hit::<DVec2>(52);
    casts_end_at_their_hit::<Vec3>(23);
    casts_end_at_their_hit::<Vec2>(23);
}

/// A ray that ends just where it enters, to the last digit, hits there.
#[test]
fn the_end_of_a_ray_belongs_to_it() {
    let ray = Ray { source: v::<DVec3>([-5.0, 0.0, 0.0]), direction: DVec3::X };
    let ball = Ball::<DVec3>::new(1.0).expect("positive");
    for options in [RayCastOptions::new(), RayCastOptions::lean(), RayCastOptions::new().with_method(CastMethod::Gjk)] {
        let cast = ray_cast(&ball, ray, options.with_max_lambda(4.0)).expect("finite");
        assert!(cast.outcome.hit().is_some_and(|hit| hit.lambda == 4.0), "{cast:?}");
    }
}
