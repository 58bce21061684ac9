//! What holds for the signed distance of any two shapes.

use crate::common::behind_pointers::{distance, signed_distance};
use convex_support::strategies::{AnyShape, combined, direction, pose, primitive, primitive_3d};
use convex_support::{Posed, Scalar, SupportMap, Vector, Vector3, glam, support_value};
use gjk_raycast::{DistanceOptions, SignedDistance, SignedDistanceOptions, Status};
use num_traits::Float as _;
use proptest::prelude::*;

type Shape<V> = Posed<AnyShape<V>>;

/// A shape of a size near one, posed near zero.
fn posed<V: Vector>(shape: BoxedStrategy<AnyShape<V>>) -> BoxedStrategy<Shape<V>> {
    let one = V::Scalar::ONE;
    let combined = combined(shape.clone(), one);
    (prop_oneof![2 => shape, 1 => combined], pose(one))
        .prop_map(|(shape, (rotation, translation))| Posed::new(shape, rotation, translation).expect("a pose"))
        .boxed()
}

fn planar<V: Vector>() -> BoxedStrategy<Shape<V>> {
    posed(primitive(V::Scalar::ONE))
}

fn solid<V: Vector3>() -> BoxedStrategy<Shape<V>> {
    posed(primitive_3d(V::Scalar::ONE))
}

fn ask<A, B>(a: &A, b: &B) -> SignedDistance<A::Vector>
where
    A: SupportMap,
    B: SupportMap<Vector = A::Vector>,
{
    signed_distance(a, b, SignedDistanceOptions::default())
}

/// What a rounding error is relative to.
fn size<V: Vector>(a: &impl SupportMap<Vector = V>, b: &impl SupportMap<Vector = V>) -> V::Scalar {
    let [a, b] = [a.core(), b.core()];
    a.extent + a.radius + b.extent + b.radius + (a.origin - b.origin).norm()
}

fn ulps<S: Scalar>(count: f64) -> S {
    S::from_f64(count) * S::EPSILON
}

/// The bounds are in order, the normal is of unit length, and the points are apart by the signed distance along it.
fn is_consistent<V: Vector>(a: &Shape<V>, b: &Shape<V>) -> Result<(), TestCaseError> {
    let (answer, size) = (ask(a, b), size(a, b));
    prop_assert!(answer.lower <= answer.signed_distance && answer.signed_distance <= answer.upper, "{answer:?}");
    prop_assert!((answer.normal.length() - V::Scalar::ONE).abs() < ulps(4.0), "{answer:?}");
    let apart = answer.point_a - answer.point_b - answer.normal * answer.signed_distance;
    // Planes that prove the lower bound may lean by this from the direction between the points.
    let lean = (size * V::Scalar::from_f64(2.0) * (answer.upper - answer.lower)).sqrt();
    prop_assert!(apart.norm() <= lean + ulps::<V::Scalar>(64.0) * size, "{apart:?} {answer:?}");
    let SignedDistance { lower, upper, status, .. } = answer;
    let error = ulps::<V::Scalar>(8.0) * size + a.core().error + b.core().error;
    let asked = if lower > V::Scalar::ZERO { V::Scalar::ZERO } else { SignedDistanceOptions::<V>::new().tolerance };
    let is_narrow = upper - lower <= error * V::Scalar::from_f64(6.0) + asked * size;
    prop_assert!(status != Status::Converged || is_narrow, "{answer:?}");
    if answer.status == Status::Converged && !answer.overlap {
        let distance = distance(a, b, DistanceOptions::default());
        prop_assert!(distance.lower <= answer.upper + ulps::<V::Scalar>(16.0) * size, "{distance:?} {answer:?}");
        prop_assert!(answer.lower <= distance.upper + ulps::<V::Scalar>(16.0) * size, "{distance:?} {answer:?}");
    }
    Ok(())
}

/// No plane separates the shapes farther than the upper bound, or leaves less of an overlap.
fn no_plane_does_better<V: Vector>(a: &Shape<V>, b: &Shape<V>, directions: &[V]) -> Result<(), TestCaseError> {
    let (answer, size) = (ask(a, b), size(a, b));
    for &d in directions {
        let n = d.unit().expect("a direction");
        let gap = -(support_value(&a, -n) + support_value(&b, n));
        prop_assert!(gap <= answer.upper + ulps::<V::Scalar>(16.0) * size, "{gap} along {n:?} {answer:?}");
    }
    Ok(())
}

/// The other way round it is the same.
fn is_symmetric<V: Vector>(a: &Shape<V>, b: &Shape<V>) -> Result<(), TestCaseError> {
    let (there, back) = (ask(a, b), ask(b, a));
    prop_assert!(there.lower <= back.upper && back.lower <= there.upper, "{there:?} {back:?}");
    Ok(())
}

/// A translation by `t` along the normal adds `t`, through contact and beyond: exactly to the gap along that normal,
/// and to the signed distance all but what the normal is wrong by.
///
/// Of curved bodies a normal is known to an angle `δ` of some roots of the precision, of which `1 − cos δ` is lost.
/// What is allowed here is `δ = 256√ε`.
fn grows_along_the_normal<V: Vector>(a: &Shape<V>, b: &Shape<V>, part: f64) -> Result<(), TestCaseError> {
    let (answer, size) = (ask(a, b), size(a, b));
    let n = answer.normal;
    let gap = -(support_value(&a, -n) + support_value(&b, n));
    let t = answer.signed_distance.abs() * V::Scalar::from_f64(part);
    let moved = ask(&Posed::translated(a, n * t).expect("a finite translation"), b);
    let error = ulps::<V::Scalar>(16.0) * (size + t);
    prop_assert!(moved.lower <= answer.upper + t + error, "{t}: {answer:?} {moved:?}");
    // Support values are rounded where the bodies are in the world.
    let of_gap = error + ulps::<V::Scalar>(16.0) * (a.core().origin.norm() + b.core().origin.norm());
    prop_assert!(gap + t <= moved.upper + of_gap, "{t} and {gap}: {answer:?} {moved:?}");
    let lost = ulps::<V::Scalar>(0.5 * 256.0 * 256.0) * t;
    prop_assert!(answer.lower + t <= moved.upper + error + lost, "{t}: {answer:?} {moved:?}");
    Ok(())
}

macro_rules! laws {
    ($name:ident, $V:ty, $shape:expr) => {
        mod $name {
            use super::*;

            proptest! {
                #![proptest_config(convex_support::laws::config(200))]

                #[test]
                fn answers_are_consistent(a in $shape, b in $shape) {
                    is_consistent::<$V>(&a, &b)?;
                }

                #[test]
                fn planes_do_no_better(a in $shape, b in $shape, d in proptest::array::uniform16(direction())) {
                    no_plane_does_better::<$V>(&a, &b, &d)?;
                }

                #[test]
                fn order_does_not_matter(a in $shape, b in $shape) {
                    is_symmetric::<$V>(&a, &b)?;
                }

                #[test]
                fn translations_along_the_normal_add_up(a in $shape, b in $shape, part in 0.0..2.0) {
                    grows_along_the_normal::<$V>(&a, &b, part)?;
                }
            }
        }
    };
}

laws!(solid_f64, glam::DVec3, solid());
laws!(solid_f32, glam::Vec3A, solid());
laws!(planar_f64, glam::DVec2, planar());
laws!(planar_f32, glam::Vec2, planar());
