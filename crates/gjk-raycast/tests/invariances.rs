//! What an answer does not depend on: the unit of length, the order of the bodies, the direction the search begins with.

mod common;

use common::ulps;
use convex_support::glam::{DQuat, DVec3, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, InvalidShape, Polytope, Posed, Rounded, Scalar, SupportMap,
    Vector,
};
use gjk_raycast::{
    Distance, DistanceOptions, LinearCastOptions, Motion, Outcome, Ray, RayCastOptions, Status, distance, intersects,
    linear_cast, ray_cast,
};
use proptest::prelude::*;

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

/// One of eight shapes, of sizes `d` and at a pose, scaled by `unit`.
fn shape(kind: usize, d: DVec3, rotation: DQuat, place: DVec3, unit: f64) -> Result<Shape<DVec3>, InvalidShape> {
    let s = d * unit;
    let shape: Shape<DVec3> = match kind {
        0 => Box::new(Cuboid::new(s)?),
        1 => Box::new(Ball::new(s.x)?),
        2 => Box::new(Capsule::<DVec3>::new(s.x, s.y)?),
        3 => Box::new(Cylinder::<DVec3>::new(s.x, s.y)?),
        4 => Box::new(Cone::<DVec3>::new(s.x, s.y)?),
        5 => Box::new(Ellipsoid::new(DVec3::ZERO, s, DQuat::IDENTITY)?),
        6 => Box::new(Rounded::new(Cuboid::new(s)?, s.z)?),
        _ => Box::new(Polytope::new([s, -s, s.yzx(), -s.zxy(), DVec3::new(-s.x, s.z, s.y)])?),
    };
    Ok(Box::new(Posed::new(shape, rotation, place * unit)?))
}

trait Swizzle {
    fn yzx(self) -> Self;
    fn zxy(self) -> Self;
}

impl Swizzle for DVec3 {
    fn yzx(self) -> Self {
        Self::new(self.y, self.z, self.x)
    }

    fn zxy(self) -> Self {
        Self::new(self.z, self.x, self.y)
    }
}

fn vector(reach: f64) -> impl Strategy<Value = DVec3> {
    (-reach..reach, -reach..reach, -reach..reach).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Sizes of moderate or of wild aspect.
fn sizes() -> impl Strategy<Value = DVec3> {
    let size = || prop_oneof![3 => 0.2..1.5, 1 => Just(1e-3), 1 => Just(1e-6)];
    (size(), size(), size()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn rotation() -> impl Strategy<Value = DQuat> {
    (vector(1.0), -3.0..3.0)
        .prop_filter("an axis", |(axis, _)| axis.length() > 0.1)
        .prop_map(|(axis, angle)| DQuat::from_axis_angle(axis.normalize(), angle))
}

fn answer_scaled(answer: &Distance<DVec3>, unit: f64) -> [DVec3; 3] {
    let values = DVec3::new(answer.distance, answer.lower, answer.upper);
    [values * unit, answer.point_a * unit, answer.point_b * unit]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// A power of two changes no bit of any mantissa, of distances and of casts.
    #[test]
    fn the_unit_of_length_does_not_matter(
        (kind_a, kind_b) in (0_usize..8, 0_usize..8),
        (d_a, d_b) in (sizes(), sizes()),
        (turn_a, turn_b) in (rotation(), rotation()),
        (place, velocity) in (vector(3.0), vector(2.0)),
        exponent in -60_i32..60,
    ) {
        let unit = 2.0_f64.powi(exponent);
        let pair = |unit: f64| Ok::<_, InvalidShape>((
            shape(kind_a, d_a, turn_a, DVec3::ZERO, unit)?,
            shape(kind_b, d_b, turn_b, place, unit)?,
        ));
        let ((a, b), (a_big, b_big)) = (pair(1.0).expect("valid"), pair(unit).expect("valid"));
        let small = distance(&a, &b, DistanceOptions::default());
        let big = distance(&a_big, &b_big, DistanceOptions::default());
        prop_assert_eq!(answer_scaled(&small, unit), answer_scaled(&big, 1.0));
        prop_assert_eq!((small.normal, small.overlap, small.iterations), (big.normal, big.overlap, big.iterations));

        let motion = |unit: f64| Motion { velocity_a: velocity * unit, velocity_b: DVec3::ZERO };
        let small = linear_cast(&a, &b, motion(1.0), LinearCastOptions::default()).expect("finite");
        let big = linear_cast(&a_big, &b_big, motion(unit), LinearCastOptions::default()).expect("finite");
        prop_assert_eq!((small.lower, small.upper, small.iterations), (big.lower, big.upper, big.iterations));
        match (small.outcome, big.outcome) {
            (Outcome::Hit(x), Outcome::Hit(y)) => {
                prop_assert_eq!((x.time, x.normal, x.point * unit), (y.time, y.normal, y.point));
            }
            (x, y) => prop_assert_eq!(x, y),
        }
    }

    /// Swapping the bodies swaps the witnesses, and the start axis changes nothing, beyond rounding.
    #[test]
    fn neither_order_nor_start_matters(
        (kind_a, kind_b) in (0_usize..8, 0_usize..8),
        (d_a, d_b) in (sizes(), sizes()),
        (turn_a, turn_b) in (rotation(), rotation()),
        (place, axis) in (vector(3.0), vector(1.0)),
    ) {
        let a = shape(kind_a, d_a, turn_a, DVec3::ZERO, 1.0).expect("valid");
        let b = shape(kind_b, d_b, turn_b, place, 1.0).expect("valid");
        let one = distance(&a, &b, DistanceOptions::default());
        let size = d_a.length() + d_b.length() + place.length();
        for other in [
            distance(&b, &a, DistanceOptions::default()),
            distance(&a, &b, DistanceOptions::new().with_axis(axis)),
        ] {
            // The brackets meet, and are as narrow as rounding, unless they say that they are not.
            prop_assert!(one.lower <= other.upper && other.lower <= one.upper, "{:?} {:?}", one, other);
            if one.status == Status::Converged && other.status == Status::Converged {
                prop_assert!((one.distance - other.distance).abs() <= 64.0 * f64::EPSILON * size, "{:?} {:?}", one, other);
            }
        }
        let meets = intersects(&a, &b, Default::default());
        prop_assert_eq!(meets.overlap, one.overlap);
    }

    /// The answer of a ray cast is that of the same ray elsewhere: started farther back, and with another length.
    #[test]
    fn the_ray_is_its_points(
        (kind, d, turn) in (0_usize..8, sizes(), rotation()),
        (aim, from) in (vector(1.0), vector(1.0)),
        (back, stretch) in (0_i32..12, -20_i32..20),
    ) {
        prop_assume!(from.length() > 0.1);
        let target = shape(kind, d, turn, DVec3::ZERO, 1.0).expect("valid");
        let from = from.normalize() * 8.0;
        let (stretch, back) = (2.0_f64.powi(stretch), 2.0_f64.powi(back));
        let direction = aim - from;
        let near = Ray { source: from, direction };
        let far = Ray { source: from - direction * back, direction: direction * stretch };
        let near = ray_cast(&target, near, RayCastOptions::default()).expect("finite");
        let far = ray_cast(&target, far, RayCastOptions::default()).expect("finite");
        if let (Some(x), Some(y)) = (near.outcome.hit(), far.outcome.hit()) {
            let slope = x.normal.map_or(1.0, |n| -n.dot(direction.normalize())).max(1e-9);
            let tolerance = ulps::<DVec3>(256.0) * (back + 2.0) / slope;
            prop_assert!((x.lambda - (y.lambda * stretch - back)).abs() <= tolerance, "{:?} {:?}", near, far);
        }
    }

    /// Double and single precision answer the same question, to single precision.
    #[test]
    fn precisions_agree(h in sizes(), aim in vector(0.9), from in vector(1.0)) {
        prop_assume!(from.length() > 0.1);
        let (h, from) = (h.as_vec3a(), (from.normalize() * 4.0).as_vec3a());
        let direction = aim.as_vec3a() - from;
        let single = ray_cast(&Cuboid::<Vec3A>::new(h).expect("positive"), Ray { source: from, direction }, Default::default());
        let ray = Ray { source: from.as_dvec3(), direction: direction.as_dvec3() };
        let double = ray_cast(&Cuboid::new(h.as_dvec3()).expect("positive"), ray, Default::default());
        let (single, double) = (single.expect("finite"), double.expect("finite"));
        if let (Some(x), Some(y)) = (single.outcome.hit(), double.outcome.hit()) {
            prop_assert!(f64::from(single.lower) <= y.lambda && y.lambda <= f64::from(single.upper), "{:?} {:?}", single, y);
            prop_assert!(x.normal.is_none_or(|n| (n.norm().as_f64() - 1.0).abs() < ulps::<Vec3A>(4.0)));
        }
    }
}
