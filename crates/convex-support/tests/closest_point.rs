//! Nearest points satisfy the inequality that characterises them, for every shape that gives them, in every space.

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::strategies as any;
use convex_support::strategies::AnyShape;
use convex_support::{Posed, Rounded, Scalar, SupportMap, Vector, Vector3, closest_point, support_value};
use num_traits::Float;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::fmt::Debug;

/// The shape as it is, posed, and posed and rounded.
fn variants<S>(shape: BoxedStrategy<S>, size: <S::Vector as Vector>::Scalar) -> BoxedStrategy<AnyShape<S::Vector>>
where
    S: SupportMap + Clone + Debug + 'static,
{
    (shape, any::pose::<S::Vector>(size), any::length(size), 0..3)
        .prop_map(|(shape, (rotation, translation), radius, variant)| -> AnyShape<S::Vector> {
            let posed = Posed::new(shape.clone(), rotation, translation).expect("a valid pose");
            match variant {
                0 => Box::new(shape),
                1 => Box::new(posed),
                _ => Box::new(Rounded::new(posed, radius).expect("a valid radius")),
            }
        })
        .boxed()
}

fn shapes<V: Vector>(size: V::Scalar) -> BoxedStrategy<AnyShape<V>> {
    prop_oneof![
        variants(any::point(size), size),
        variants(any::segment(size), size),
        variants(any::triangle(size), size),
        variants(any::ball(size), size),
        variants(any::cuboid(size), size),
        variants(any::capsule(size), size),
        variants(any::ellipsoid(size), size),
    ]
    .boxed()
}

fn shapes_3d<V: Vector3>(size: V::Scalar) -> BoxedStrategy<AnyShape<V>> {
    prop_oneof![
        7 => shapes(size),
        1 => variants(any::cylinder(size), size),
        1 => variants(any::cone(size), size),
    ]
    .boxed()
}

/// With `p` nearest `x`: `p` is in the set, and no point `y` of it has `(x − p)·(y − p) > 0`.
fn check<V: Vector>(shape: &AnyShape<V>, x: V, directions: &[V], size: V::Scalar) -> Result<(), TestCaseError> {
    let p = closest_point(shape, x).expect("a closed form");
    let tolerance = V::Scalar::EPSILON * V::Scalar::from_f64(64.0) * (size + x.norm());
    for &d in directions {
        let sticks_out = d.dot(p) - support_value(&shape, d);
        prop_assert!(sticks_out <= tolerance * d.norm(), "{p:?} sticks out by {sticks_out:?} along {d:?}");
    }
    let out = x - p;
    let farther = support_value(&shape, out) - out.dot(p);
    prop_assert!(farther <= tolerance * (size + out.norm()), "the shape reaches {farther:?} beyond {p:?}");
    prop_assert!(
        (closest_point(shape, p).expect("a closed form") - p).norm() <= tolerance,
        "{p:?} is not its own nearest point"
    );
    let _ = closest_point(shape, V::splat(V::Scalar::nan()));
    Ok(())
}

fn satisfies<V: Vector>(shapes: fn(V::Scalar) -> BoxedStrategy<AnyShape<V>>) {
    let strategy = any::size::<V::Scalar>().prop_flat_map(move |size| {
        let reach = prop_oneof![Just(0.5), Just(3.0), Just(1e3)];
        let x = reach.prop_flat_map(move |r| any::vector::<V>(size * V::Scalar::from_f64(r)));
        (shapes(size), x, proptest::collection::vec(any::direction::<V>(), 10), Just(size))
    });
    let mut runner =
        TestRunner::new(ProptestConfig { failure_persistence: None, ..convex_support::laws::config(1000) });
    let outcome = runner
        .run(&strategy, |(shape, x, directions, size)| check(&shape, x, &directions, size * V::Scalar::from_f64(4.0)));
    if let Err(error) = outcome {
        panic!("in {}: {error}", std::any::type_name::<V>());
    }
}

#[test]
fn nearest_points_are_characterised_by_their_inequality() {
    satisfies::<Vec2>(shapes);
    satisfies::<DVec2>(shapes);
    satisfies::<Vec3>(shapes_3d);
    satisfies::<Vec3A>(shapes_3d);
    satisfies::<DVec3>(shapes_3d);
}
