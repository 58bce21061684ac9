//! What answers claim, held against the support maps themselves, on shapes and poses that are adversarial on purpose:
//! ulps apart, from 1e-9 to 1e9, aspects of a million, flat and repeated vertices, parallel faces, grazing rays.

use crate::common::behind_pointers::{distance, intersects, linear_cast, ray_cast};
use crate::common::directions;
use convex_support::glam::{DVec2, DVec3, Vec3A};
use convex_support::strategies::{self, AnyShape};
use convex_support::{Posed, Scalar, SupportMap, Vector, Vector3, support_value};
use gjk_raycast::{DistanceOptions, IntersectOptions, LinearCastOptions, Motion, Outcome, Ray, RayCastOptions};
use proptest::prelude::*;

type Placed<V> = Posed<AnyShape<V>>;

/// Two shapes of one size or of sizes far apart, at poses that make faces parallel and gaps of ulps, and their size.
fn scene<V: Vector + 'static>(
    shape: fn(V::Scalar) -> BoxedStrategy<AnyShape<V>>,
) -> BoxedStrategy<(Placed<V>, Placed<V>, V::Scalar)> {
    let ratio = prop_oneof![3 => Just(1.0), 1 => Just(1e-3), 1 => Just(1e-6)].prop_map(V::Scalar::from_f64);
    (strategies::size::<V::Scalar>(), ratio)
        .prop_flat_map(move |(size, ratio)| {
            let reach = size * V::Scalar::from_f64(3.0);
            (shape(size), shape(size * ratio), strategies::pose::<V>(reach), strategies::pose::<V>(reach), Just(size))
        })
        .prop_map(|(a, b, (turn_a, place_a), (turn_b, place_b), size)| {
            let a = Posed::new(a, turn_a, place_a).expect("a rotation");
            (a, Posed::new(b, turn_b, place_b).expect("a rotation"), size)
        })
        .boxed()
}

fn unit_directions<V: Vector>() -> impl Iterator<Item = V> {
    directions(60).filter_map(|d| crate::common::v::<V>(d).unit())
}

/// How far a point is beyond the shape's planes of support: a lower bound of its distance.
fn beyond<V: Vector>(shape: &Placed<V>, point: V) -> f64 {
    unit_directions::<V>().map(|n| (n.dot(point) - support_value(&shape, n)).as_f64()).fold(f64::NEG_INFINITY, f64::max)
}

/// How far the planes of support across `n` are apart, from b's to a's.
fn gap<V: Vector>(a: &Placed<V>, b: &Placed<V>, n: V) -> f64 {
    -support_value(&a, -n).as_f64() - support_value(&b, n).as_f64()
}

fn holds<V: Vector>(a: &Placed<V>, b: &Placed<V>, size: V::Scalar, velocity: V) -> Result<(), TestCaseError> {
    let rounding = 64.0 * V::Scalar::EPSILON.as_f64() * 10.0 * size.as_f64();

    let apart = distance(a, b, DistanceOptions::default());
    let [d, lower, upper] = [apart.distance, apart.lower, apart.upper].map(Scalar::as_f64);
    prop_assert!(lower <= d && d <= upper, "{:?}", apart);
    // Where they touch, it is the gap as it is measured.
    prop_assert!(if apart.overlap { lower == 0.0 && d <= rounding } else { d > 0.0 }, "{:?}", apart);
    for (shape, point) in [(a, apart.point_a), (b, apart.point_b)] {
        prop_assert!(beyond(shape, point) <= rounding, "a witness outside by {}: {:?}", beyond(shape, point), apart);
    }
    let between = (apart.point_a - apart.point_b).norm().as_f64();
    prop_assert!(apart.overlap || (between - d).abs() <= rounding, "witnesses {} apart: {:?}", between, apart);
    // No plane separates more than the upper bound says.
    let planes = unit_directions::<V>().chain(apart.normal).map(|n| gap(a, b, n)).fold(f64::NEG_INFINITY, f64::max);
    prop_assert!(planes <= upper + rounding, "a plane {} apart: {:?}", planes, apart);

    // Stopped at a limit, it still says how far apart two points of the shapes are.
    let limit = apart.distance * V::Scalar::from_f64(0.5);
    let far = distance(a, b, DistanceOptions::default().with_limit(limit));
    let between = (far.point_a - far.point_b).norm().as_f64();
    prop_assert!(far.lower <= apart.upper && apart.lower <= far.upper, "{:?}, but {:?}", far, apart);
    prop_assert!(between <= far.upper.as_f64() + rounding, "witnesses {} apart: {:?}", between, far);

    let meets = intersects(a, b, IntersectOptions::default());
    if let Some(overlap) = meets.decided() {
        prop_assert!(!overlap || planes <= rounding, "a plane {} apart: {:?}", planes, meets);
        let separates = meets.axis.map_or(0.0, |n| gap(a, b, n));
        prop_assert!(overlap || separates >= -rounding, "an axis that does not separate: {} {:?}", separates, meets);
        prop_assert!(overlap == apart.overlap || d <= rounding, "{:?} {:?}", meets, apart);
    }

    if velocity == V::ZERO {
        return Ok(());
    }
    let speed = velocity.norm().as_f64();
    let motion = Motion { velocity_a: velocity, velocity_b: V::ZERO };
    let cast = linear_cast(a, b, motion, LinearCastOptions::default()).expect("finite velocities");
    prop_assert!(cast.lower <= cast.upper, "{:?}", cast);
    if let Outcome::Hit(hit) = cast.outcome {
        prop_assert!(cast.lower <= hit.time && hit.time <= cast.upper, "{:?}", cast);
        prop_assert!(hit.normal.is_none_or(|n| (n.norm().as_f64() - 1.0).abs() < 1e-5), "{:?}", cast);
        // They cannot meet before they have come as far as they are apart.
        prop_assert!(hit.time.as_f64() * speed >= lower - rounding, "{:?} {:?}", apart, cast);
    } else if apart.overlap && d == 0.0 && planes < -rounding {
        prop_assert!(false, "they overlap: {:?} {:?}", apart, cast);
    }

    let ray = Ray { source: b.core().origin, direction: velocity };
    let cast = ray_cast(a, ray, RayCastOptions::default()).expect("a finite ray");
    prop_assert!(cast.lower <= cast.upper, "{:?}", cast);
    if let Outcome::Hit(hit) = cast.outcome {
        prop_assert!(cast.lower <= hit.lambda && hit.lambda <= cast.upper, "{:?}", cast);
        prop_assert!(beyond(a, hit.point) <= rounding, "a hit spot outside by {}: {:?}", beyond(a, hit.point), cast);
    }
    Ok(())
}

fn solid<V: Vector3>(size: V::Scalar) -> BoxedStrategy<AnyShape<V>> {
    prop_oneof![
        4 => strategies::primitive_3d::<V>(size),
        1 => strategies::combined::<V>(strategies::primitive_3d::<V>(size), size),
    ]
    .boxed()
}

proptest! {
    #![proptest_config(convex_support::laws::config(1500))]

    #[test]
    fn in_space((a, b, size) in scene::<DVec3>(solid), velocity in strategies::direction::<DVec3>()) {
        holds(&a, &b, size, velocity)?;
    }

    #[test]
    fn in_single_precision((a, b, size) in scene::<Vec3A>(solid), velocity in strategies::direction::<Vec3A>()) {
        holds(&a, &b, size, velocity)?;
    }

    #[test]
    fn in_the_plane(
        (a, b, size) in scene::<DVec2>(strategies::primitive::<DVec2>),
        velocity in strategies::direction::<DVec2>(),
    ) {
        holds(&a, &b, size, velocity)?;
    }
}
