//! Single precision held against double: what is claimed of numbers in `f32` is true of the same numbers in `f64`, of
//! which the rounding is nothing beside theirs.
//!
//! Most bodies are needles or plates, nearly touch, and are far from where they are turned about: there claims are the
//! hardest to keep. `PROPTEST_CASES=1000000` takes a minute or two with optimisation.

use core::fmt::Debug;

use convex_support::{Scalar, SupportMap, Vector};
use gjk_raycast::{
    Distance, DistanceOptions, HalfSpace, IntersectOptions, LinearCastOptions, Motion, MotionCastOptions, Outcome, Ray,
    RayCastOptions, RigidMotion, SignedDistance, SignedDistanceOptions, distance, intersects, linear_cast, motion_cast,
    ray_cast, ray_exit, signed_distance,
};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

use crate::common::space::spin as angular_velocity;
use crate::common::v;

mod plane;
mod space;

/// Whether a claim holds.
type Held = Result<(), TestCaseError>;

/// The numbers that a shape is made of.
#[derive(Clone, Copy, Debug)]
struct Shape {
    kind: usize,
    sizes: [f64; 3],
    turn: [f64; 4],
}

/// Vectors that shapes are made of in either precision.
trait Space: Vector {
    /// The shape with its origin at a place.
    fn shape(shape: &Shape, place: [f64; 3]) -> Box<dyn SupportMap<Vector = Self>>;
    /// A vector across `n` that depends on `u`.
    fn across(n: Self, u: Self) -> Self;
}

/// Vectors of which all coordinates are numbers that `f32` has, and the same in `f32`.
trait Double: Space<Scalar = f64> {
    type Single: Space<Scalar = f32>;
}

fn coordinates<V: Vector>(x: V) -> [f64; 3] {
    core::array::from_fn(|i| if i < V::DIM { x.get(i).as_f64() } else { 0.0 })
}

fn single<D: Double>(x: D) -> D::Single {
    v(coordinates(x))
}

/// What `f32` keeps of a vector.
fn rounded<D: Double>(x: D) -> D {
    v(coordinates(single(x)))
}

/// A body by numbers that `f32` has.
#[derive(Clone, Copy, Debug)]
struct Body<D> {
    shape: Shape,
    place: D,
}

impl<D: Double> Body<D> {
    fn is<V: Space>(&self) -> Box<dyn SupportMap<Vector = V>> {
        V::shape(&self.shape, coordinates(self.place))
    }
}

fn vector<D: Double>(reach: f64) -> impl Strategy<Value = D> {
    (-reach..reach, -reach..reach, -reach..reach).prop_map(|(x, y, z)| rounded(v([x, y, z])))
}

fn sizes() -> impl Strategy<Value = [f64; 3]> {
    let size = || prop_oneof![3 => 0.2..1.5, 1 => Just(1e-2), 1 => Just(1e-4), 1 => (-5.0..0.0).prop_map(f64::exp2)];
    (size(), size(), size()).prop_map(|(x, y, z)| [x, y, z].map(|x| f64::from(x as f32)))
}

fn signed<D: Double>([a, b]: [Body<D>; 2]) -> SignedDistance<D> {
    signed_distance(&a.is::<D>(), &b.is::<D>(), SignedDistanceOptions::default())
}

/// Two bodies of which the second was moved to be apart by so many times what `f32` rounds of where they are, or by a
/// length.
fn bodies<D: Double>(shape: impl Fn() -> BoxedStrategy<Shape>) -> impl Strategy<Value = [Body<D>; 2]> {
    let far = prop_oneof![2 => Just(D::ZERO), 1 => vector(3.0), 1 => vector(100.0)];
    let aside = prop_oneof![2 => vector(3.0), 1 => Just(D::axis(0) * 3.0), 1 => Just(-D::axis(1) * 3.0)];
    let gap =
        prop_oneof![3 => (-30.0..30.0).prop_map(|ulps| (ulps, 0.0)), 1 => (-1e-3..1e-3).prop_map(|gap| (0.0, gap))];
    (shape(), shape(), far, aside, gap).prop_map(|(a, b, far, aside, (ulps, gap))| {
        let a = Body { shape: a, place: far };
        let b = Body { shape: b, place: rounded(far + aside) };
        let apart = signed([a, b]);
        let ulp = far.abs().max_element().max(1.0) * f64::from(f32::EPSILON);
        let nearer = apart.normal * (apart.signed_distance - ulps * ulp - gap);
        [a, Body { place: rounded(b.place + nearer), ..b }]
    })
}

/// What a cast claims.
#[derive(Debug)]
struct Claim {
    is_miss: bool,
    lower: f64,
    /// Infinite where no hit is certain.
    upper: f64,
}

impl Claim {
    fn new<H, V>(outcome: &Outcome<H, V>, lower: impl Into<f64>, upper: impl Into<f64>) -> Self {
        Self { is_miss: outcome.is_miss(), lower: lower.into(), upper: upper.into() }
    }

    /// Whether it may be true of a cast until `end` of which more is known.
    fn may_be(&self, truth: &Self, end: f64) -> bool {
        let hits = !truth.is_miss && truth.upper.is_finite();
        if self.is_miss {
            // Where the end is within rounding of a hit, no more is claimed than that nothing is hit before.
            return !(hits && truth.upper < end && truth.upper < self.lower);
        }
        // A later one is that of a motion that goes on.
        let claims_hit = self.upper <= end && self.upper.is_finite();
        !(claims_hit && truth.is_miss)
            && (!hits || self.lower <= truth.upper)
            && (!claims_hit || truth.lower <= self.upper)
    }
}

/// Of distances, signed or not, and of whether bodies have a point in common.
fn brackets_of_distances<D: Double>(pair: [Body<D>; 2], axis: D) -> Held {
    let truth = signed(pair);
    let [a, b] = pair.map(|body| body.is::<D::Single>());
    let axis = single(axis);
    let plain = DistanceOptions::default();
    for answer in [distance(&a, &b, plain), distance(&a, &b, plain.with_axis(axis)), distance(&b, &a, plain)] {
        let holds = f64::from(answer.lower) <= truth.upper.max(0.0) && truth.lower <= f64::from(answer.upper);
        prop_assert!(holds, "{:?} {:?}", answer, truth);
    }
    let plain = SignedDistanceOptions::default();
    for answer in [signed_distance(&a, &b, plain), signed_distance(&a, &b, plain.with_axis(axis))] {
        let holds = f64::from(answer.lower) <= truth.upper && truth.lower <= f64::from(answer.upper);
        prop_assert!(holds, "{:?} {:?}", answer, truth);
    }
    let plain = IntersectOptions::default();
    for answer in [intersects(&a, &b, plain), intersects(&a, &b, plain.with_axis(axis))] {
        prop_assert!(!(answer.decided() == Some(false) && truth.upper < 0.0), "{:?} {:?}", answer, truth);
    }
    Ok(())
}

/// Of a ray from a point seen from the second body to beside its point nearest to the first.
fn brackets_of_rays<D: Double>(pair: [Body<D>; 2], [from, aside]: [D; 2]) -> Held {
    let [_, target] = pair;
    let aim = signed(pair).point_b;
    let source = rounded(target.place + from);
    let direction = rounded(aim + aside - source);
    prop_assume!(direction != D::ZERO);
    let ray = Ray { source: single(source), direction: single(direction) };
    let answer = ray_cast(&target.is::<D::Single>(), ray, RayCastOptions::default()).expect("finite");
    let truth = ray_cast(&target.is::<D>(), Ray { source, direction }, RayCastOptions::default()).expect("finite");
    let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
    let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), f64::INFINITY);
    prop_assert!(is_true, "{:?} {:?}", answer, truth);
    Ok(())
}

/// Of bodies that move at any velocities, or slide along one another.
fn brackets_of_linear_casts<D: Double>(pair: [Body<D>; 2], [u, w]: [D; 2], slides: bool) -> Held {
    let n = signed(pair).normal;
    let velocity_a = if slides { rounded(D::across(n, u) + n * (u.get(0) * 1e-5)) } else { u };
    let velocity_b = if slides { D::ZERO } else { w };
    let options = LinearCastOptions::new().with_max_time(10.0);
    let [a, b] = pair.map(|body| body.is::<D>());
    let truth = linear_cast(&a, &b, Motion { velocity_a, velocity_b }, options).expect("finite");
    let motion = Motion { velocity_a: single(velocity_a), velocity_b: single(velocity_b) };
    let options = LinearCastOptions::new().with_max_time(10.0);
    let [a, b] = pair.map(|body| body.is::<D::Single>());
    let answer = linear_cast(&a, &b, motion, options).expect("finite");
    let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
    let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), 10.0);
    prop_assert!(is_true, "{:?} {:?}", answer, truth);
    Ok(())
}

/// Of a body that moves and turns about a point near it. Nor is a start in contact looked at again and again.
fn brackets_of_motion_casts<D: Double>(pair: [Body<D>; 2], [velocity, center]: [D; 2], spin: [f64; 3]) -> Held {
    let center = rounded(pair[0].place + center);
    let options = MotionCastOptions::new().with_max_time(1.0);
    let [a, b] = pair.map(|body| body.is::<D>());
    let motion = RigidMotion { velocity, angular_velocity: angular_velocity::<D>(spin), center };
    let truth = motion_cast(&a, motion, &b, RigidMotion::default(), options).expect("finite");
    let motion = RigidMotion {
        velocity: single(velocity),
        angular_velocity: angular_velocity::<D::Single>(spin),
        center: single(center),
    };
    let options = MotionCastOptions::new().with_max_time(1.0);
    let [a, b] = pair.map(|body| body.is::<D::Single>());
    let answer = motion_cast(&a, motion, &b, RigidMotion::default(), options).expect("finite");
    let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
    let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), 1.0);
    prop_assert!(is_true, "{:?} {:?}", answer, truth);
    prop_assert!(answer.iterations < 10_000, "{:?}", answer);
    Ok(())
}

/// Of a body over a half-space that it nearly touches: of its distance, of how it moves with and without turning, and
/// of a ray from its lowest point.
fn brackets_over_half_spaces<D: Double>(
    body: Body<D>,
    [normal, velocity, center]: [D; 3],
    ulps: f64,
    spin: [f64; 3],
) -> Held {
    let normal = if normal.length() > 0.1 { normal } else { D::axis(1) };
    // Somewhere near its lowest point, of which the offset is rounded like everything.
    let lowest = rounded(body.is::<D>().support(-normal));
    let level = normal.dot(lowest);
    let ulp = normal.abs().dot(lowest.abs()).max(0.1) * f64::from(f32::EPSILON);
    let offset = f64::from((level - ulps * ulp) as f32);
    let double = HalfSpace::new(normal, offset).expect("a normal");
    let half_space = HalfSpace::new(single(normal), offset as f32).expect("a normal");
    let [truth, answer] = [double.distance_from(&body.is::<D>()), {
        let answer = half_space.distance_from(&body.is::<D::Single>());
        Distance {
            distance: answer.distance.into(),
            lower: answer.lower.into(),
            upper: answer.upper.into(),
            overlap: answer.overlap,
            point_a: D::ZERO,
            point_b: D::ZERO,
            normal: None,
            status: answer.status,
            iterations: 1,
        }
    }];
    prop_assert!(answer.lower <= truth.upper && truth.lower <= answer.upper, "{:?} {:?}", answer, truth);

    let end = 10.0;
    let options = LinearCastOptions::new().with_max_time(end);
    let motion = Motion { velocity_a: velocity, velocity_b: D::ZERO };
    let truth = double.linear_cast(&body.is::<D>(), motion, options).expect("finite");
    let motion = Motion { velocity_a: single(velocity), velocity_b: D::Single::ZERO };
    let options = LinearCastOptions::new().with_max_time(end as f32);
    let answer = half_space.linear_cast(&body.is::<D::Single>(), motion, options).expect("finite");
    let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
    let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), end);
    prop_assert!(is_true, "{:?} {:?}", answer, truth);

    let truth = double.ray_cast(Ray { source: lowest, direction: velocity }, RayCastOptions::default());
    let truth = truth.expect("finite");
    let ray = Ray { source: single(lowest), direction: single(velocity) };
    let answer = half_space.ray_cast(ray, RayCastOptions::default()).expect("finite");
    let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
    let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), f64::INFINITY);
    prop_assert!(is_true, "{:?} {:?}", answer, truth);

    let center = rounded(body.place + center);
    let options = MotionCastOptions::new().with_max_time(1.0);
    let motion = RigidMotion { velocity, angular_velocity: angular_velocity::<D>(spin), center };
    let truth = double.motion_cast(&body.is::<D>(), motion, options).expect("finite");
    let motion = RigidMotion {
        velocity: single(velocity),
        angular_velocity: angular_velocity::<D::Single>(spin),
        center: single(center),
    };
    let options = MotionCastOptions::new().with_max_time(1.0);
    let answer = half_space.motion_cast(&body.is::<D::Single>(), motion, options).expect("finite");
    let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
    let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), 1.0);
    prop_assert!(is_true, "{:?} {:?}", answer, truth);
    Ok(())
}

/// Of a ray as above that begins later, and of where it leaves the body.
fn brackets_of_late_rays_and_exits<D: Double>(pair: [Body<D>; 2], [from, aside]: [D; 2], begin: f64) -> Held {
    let [_, target] = pair;
    let aim = signed(pair).point_b;
    let source = rounded(target.place + from);
    let direction = rounded(aim + aside - source);
    prop_assume!(direction != D::ZERO);
    let begin = begin as f32;
    let ray = Ray { source: single(source), direction: single(direction) };
    let late = RayCastOptions::new().with_min_lambda(begin);
    let answer = ray_cast(&target.is::<D::Single>(), ray, late).expect("finite");
    let double = Ray { source, direction };
    let late = RayCastOptions::new().with_min_lambda(f64::from(begin));
    let truth = ray_cast(&target.is::<D>(), double, late).expect("finite");
    let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
    let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), f64::INFINITY);
    prop_assert!(is_true, "{:?} {:?}", answer, truth);

    let answer = ray_exit(&target.is::<D::Single>(), ray, RayCastOptions::default()).expect("finite");
    let truth = ray_exit(&target.is::<D>(), double, RayCastOptions::default()).expect("finite");
    let (claims_exit, is_left) = (answer.lower.is_finite(), truth.lower.is_finite());
    let is_true = if answer.outcome.is_miss() {
        !is_left
    } else {
        !(claims_exit && truth.outcome.is_miss())
            && (!is_left || truth.lower <= answer.upper.into())
            && (!claims_exit || truth.upper >= answer.lower.into())
    };
    prop_assert!(is_true, "{:?} {:?}", answer, truth);
    Ok(())
}

/// Of distances that need not be known beyond limits, and of casts to a distance.
fn brackets_within_limits<D: Double>(pair: [Body<D>; 2], [u, w]: [D; 2], target: f64) -> Held {
    let target = target as f32;
    let plain = signed(pair);
    let [a, b] = pair.map(|body| body.is::<D::Single>());
    let limited = SignedDistanceOptions::default().with_limit(target * 1e-3).with_depth_limit(target * 1e-6);
    let answer = signed_distance(&a, &b, limited);
    let holds = f64::from(answer.lower) <= plain.upper && plain.lower <= f64::from(answer.upper);
    prop_assert!(holds, "{:?} {:?}", answer, plain);
    let answer = distance(&a, &b, DistanceOptions::default().with_limit(target * 1e-3));
    let holds = f64::from(answer.lower) <= plain.upper.max(0.0) && plain.lower <= f64::from(answer.upper);
    prop_assert!(holds, "{:?} {:?}", answer, plain);

    let end = 10.0;
    let apart = Body { place: rounded(pair[1].place - plain.normal * f64::from(target)), ..pair[1] };
    let options = LinearCastOptions::new().with_max_time(end).with_target_distance(f64::from(target));
    let [a, b] = [pair[0], apart].map(|body| body.is::<D>());
    let truth = linear_cast(&a, &b, Motion { velocity_a: u, velocity_b: w }, options).expect("finite");
    let options = LinearCastOptions::new().with_max_time(end as f32).with_target_distance(target);
    let [a, b] = [pair[0], apart].map(|body| body.is::<D::Single>());
    let motion = Motion { velocity_a: single(u), velocity_b: single(w) };
    let answer = linear_cast(&a, &b, motion, options).expect("finite");
    let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
    let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), end);
    prop_assert!(is_true, "{:?} {:?}", answer, truth);
    Ok(())
}
