//! Single precision held against double: what is claimed of numbers in `f32` is true of the same numbers in `f64`, of which the rounding is
//! nothing beside theirs.
//!
//! Most bodies are needles or plates, nearly touch, and are far from where they are turned about: there claims are the hardest to keep.
//! `PROPTEST_CASES=1000000` takes a minute with optimisation.

use crate::common::{Quaternion, s, turned, v};
use convex_support::glam::{DQuat, DVec3, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Rounded, Segment, SupportMap, Triangle,
};
use gjk_raycast::{
    DistanceOptions, IntersectOptions, LinearCastOptions, Motion, MotionCastOptions, Outcome, Ray, RayCastOptions,
    RigidMotion, SignedDistance, SignedDistanceOptions, distance, intersects, linear_cast, motion_cast, ray_cast,
    signed_distance,
};
use proptest::prelude::*;

/// A body by numbers that `f32` has.
#[derive(Clone, Copy, Debug)]
struct Body {
    kind: usize,
    sizes: DVec3,
    turn: [f64; 4],
    place: DVec3,
}

/// What `f32` keeps of a vector.
fn single(v: DVec3) -> DVec3 {
    v.as_vec3a().as_dvec3()
}

impl Body {
    fn shape<V: Quaternion>(&self) -> Box<dyn SupportMap<Vector = V>> {
        let [x, y, z] = self.sizes.to_array();
        let size = |i: usize| s::<V>([x, y, z][i]);
        let corner = |c: [f64; 3]| v::<V>(c);
        let half_extents = corner([x, y, z]);
        let posed = V::quaternion(self.turn);
        let place = self.place.to_array();
        match self.kind {
            0 => Box::new(turned(Cuboid::new(half_extents).expect("positive"), posed, place)),
            1 => Box::new(turned(Ball::<V>::new(size(0)).expect("positive"), posed, place)),
            2 => Box::new(turned(Capsule::<V>::new(size(0), size(1)).expect("positive"), posed, place)),
            3 => Box::new(turned(Cylinder::<V>::new(size(0), size(1)).expect("positive"), posed, place)),
            4 => Box::new(turned(Cone::<V>::new(size(0), size(1)).expect("positive"), posed, place)),
            5 => {
                let straight = V::quaternion([0.0, 0.0, 0.0, 1.0]);
                let ellipsoid = Ellipsoid::new(V::ZERO, half_extents, straight).expect("positive");
                Box::new(turned(ellipsoid, posed, place))
            }
            6 => {
                let cuboid = Cuboid::new(half_extents).expect("positive");
                Box::new(turned(Rounded::new(cuboid, size(2)).expect("positive"), posed, place))
            }
            7 => {
                let corners = [[x, y, z], [-x, -y, -z], [y, z, x], [-z, -x, -y], [-x, z, y]].map(corner);
                Box::new(turned(Polytope::new(corners).expect("finite"), posed, place))
            }
            8 => {
                let triangle = Triangle::new([[x, y, z], [-x, -y, -z], [y, z, x]].map(corner));
                Box::new(turned(triangle.expect("finite"), posed, place))
            }
            _ => {
                let segment = Segment::new([[x, y, z], [-x, -y, -z]].map(corner));
                Box::new(turned(segment.expect("finite"), posed, place))
            }
        }
    }
}

fn vector(reach: f64) -> impl Strategy<Value = DVec3> {
    (-reach..reach, -reach..reach, -reach..reach).prop_map(|(x, y, z)| single(DVec3::new(x, y, z)))
}

fn body() -> impl Strategy<Value = Body> {
    let size = || prop_oneof![3 => 0.2..1.5, 1 => Just(1e-2), 1 => Just(1e-4), 1 => (-5.0..0.0).prop_map(f64::exp2)];
    let sizes = (size(), size(), size()).prop_map(|(x, y, z)| single(DVec3::new(x, y, z)));
    let turn = (vector(1.0), -1.0..1.0)
        .prop_filter("a quaternion", |(v, w)| v.length() + f64::abs(*w) > 0.1)
        .prop_map(|(v, w)| DQuat::from_xyzw(v.x, v.y, v.z, w).normalize().to_array().map(|c| f64::from(c as f32)));
    let turn = prop_oneof![3 => turn, 1 => Just([0.0, 0.0, 0.0, 1.0])];
    (0_usize..10, sizes, turn).prop_map(|(kind, sizes, turn)| Body { kind, sizes, turn, place: DVec3::ZERO })
}

fn signed<V: Quaternion>([a, b]: [Body; 2]) -> SignedDistance<V> {
    signed_distance(&a.shape::<V>(), &b.shape::<V>(), SignedDistanceOptions::default())
}

/// Two bodies of which the second was moved to be apart by so many times what `f32` rounds of where they are, or by a length.
fn bodies() -> impl Strategy<Value = [Body; 2]> {
    let far = prop_oneof![2 => Just(DVec3::ZERO), 1 => vector(3.0), 1 => vector(100.0)];
    let aside = prop_oneof![2 => vector(3.0), 1 => Just(DVec3::X * 3.0), 1 => Just(DVec3::NEG_Y * 3.0)];
    let gap =
        prop_oneof![3 => (-30.0..30.0).prop_map(|ulps| (ulps, 0.0)), 1 => (-1e-3..1e-3).prop_map(|gap| (0.0, gap))];
    (body(), body(), far, aside, gap).prop_map(|(a, b, far, aside, (ulps, gap))| {
        let a = Body { place: far, ..a };
        let b = Body { place: single(far + aside), ..b };
        let apart = signed::<DVec3>([a, b]);
        let ulp = far.abs().max_element().max(1.0) * f64::from(f32::EPSILON);
        let nearer = apart.normal * (apart.signed_distance - ulps * ulp - gap);
        [a, Body { place: single(b.place + nearer), ..b }]
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
            return !(hits && truth.upper < end);
        }
        let claims_hit = self.upper.is_finite();
        !(claims_hit && truth.is_miss)
            && (!hits || self.lower <= truth.upper)
            && (!claims_hit || truth.lower <= self.upper)
    }
}

proptest! {
    #[test]
    fn brackets_of_distances_hold_the_truth(pair in bodies(), axis in vector(1.0)) {
        let truth = signed::<DVec3>(pair);
        let [a, b] = pair.map(|body| body.shape::<Vec3A>());
        let axis = axis.as_vec3a();
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
    }

    #[test]
    fn brackets_of_rays_hold_the_truth(
        pair in bodies(),
        (from, aside) in (vector(3.0), prop_oneof![vector(1e-6), vector(0.5)]),
    ) {
        let [_, target] = pair;
        let aim = signed::<DVec3>(pair).point_b;
        let source = single(target.place + from);
        let direction = single(aim + aside - source);
        prop_assume!(direction != DVec3::ZERO);
        let ray = Ray { source: source.as_vec3a(), direction: direction.as_vec3a() };
        let answer = ray_cast(&target.shape::<Vec3A>(), ray, RayCastOptions::default()).expect("finite");
        let truth = ray_cast(&target.shape::<DVec3>(), Ray { source, direction }, RayCastOptions::default());
        let truth = truth.expect("finite");
        let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
        let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), f64::INFINITY);
        prop_assert!(is_true, "{:?} {:?}", answer, truth);
    }

    #[test]
    fn brackets_of_linear_casts_hold_the_truth(pair in bodies(), (u, w) in (vector(1.0), vector(1.0)), slides: bool) {
        let n = signed::<DVec3>(pair).normal;
        let velocity_a = if slides { single(n.cross(u) + n * (u.x * 1e-5)) } else { u };
        let velocity_b = if slides { DVec3::ZERO } else { w };
        let options = LinearCastOptions::new().with_max_time(10.0);
        let [a, b] = pair.map(|body| body.shape::<DVec3>());
        let truth = linear_cast(&a, &b, Motion { velocity_a, velocity_b }, options).expect("finite");
        let motion = Motion { velocity_a: velocity_a.as_vec3a(), velocity_b: velocity_b.as_vec3a() };
        let options = LinearCastOptions::new().with_max_time(10.0);
        let [a, b] = pair.map(|body| body.shape::<Vec3A>());
        let answer = linear_cast(&a, &b, motion, options).expect("finite");
        let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
        let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), 10.0);
        prop_assert!(is_true, "{:?} {:?}", answer, truth);
    }

    /// Nor is a start in contact looked at again and again.
    #[test]
    fn brackets_of_motion_casts_hold_the_truth(
        pair in bodies(),
        (velocity, angular_velocity, center) in (vector(1.0), vector(3.0), vector(1.0)),
    ) {
        let center = single(pair[0].place + center);
        let options = MotionCastOptions::new().with_max_time(1.0);
        let [a, b] = pair.map(|body| body.shape::<DVec3>());
        let motion = RigidMotion { velocity, angular_velocity, center };
        let truth = motion_cast(&a, motion, &b, RigidMotion::default(), options).expect("finite");
        let motion = RigidMotion {
            velocity: velocity.as_vec3a(),
            angular_velocity: angular_velocity.as_vec3a(),
            center: center.as_vec3a(),
        };
        let options = MotionCastOptions::new().with_max_time(1.0);
        let [a, b] = pair.map(|body| body.shape::<Vec3A>());
        let answer = motion_cast(&a, motion, &b, RigidMotion::default(), options).expect("finite");
        let claim = Claim::new(&answer.outcome, answer.lower, answer.upper);
        let is_true = claim.may_be(&Claim::new(&truth.outcome, truth.lower, truth.upper), 1.0);
        prop_assert!(is_true, "{:?} {:?}", answer, truth);
        prop_assert!(answer.iterations < 10_000, "{:?}", answer);
    }
}
