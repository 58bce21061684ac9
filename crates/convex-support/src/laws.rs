//! The laws of a support map as property tests for any shape; with the feature `proptest`.
//!
//! ```
//! use convex_support::{SupportMap, glam::DVec2, laws};
//! use proptest::prelude::*;
//!
//! /// The square |x| + |y| ≤ r.
//! #[derive(Debug)]
//! struct Diamond(f64);
//!
//! impl SupportMap for Diamond {
//!     type Vector = DVec2;
//!
//!     fn support(&self, d: DVec2) -> DVec2 {
//!         self.0 * if d.x.abs() > d.y.abs() { DVec2::X * d.x.signum() } else { DVec2::Y * d.y.signum() }
//!     }
//! }
//!
//! laws::hold((0.1..10.0).prop_map(Diamond));
//! ```
//!
//! Every law holds to within the rounding that the shape itself states: sixteen times the [`error`](crate::Core::error)
//! of its [`core`](SupportMap::core), and as many units in the last place of where it is.

use std::fmt::Debug;
use std::format;

use num_traits::Float as _;
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner, contextualize_config};

use crate::{
    CertainCrossing, CoreKind, Hint, LineQuery, Rounding, Scalar, SupportMap, Vector, bounding_box, bounding_sphere,
    strategies, support_value,
};

/// How many times its own rounding a shape may be off: a law compares up to four support points, each placed and
/// measured.
const SLACK: f64 = 16.0;

/// A shape of any type, so that the laws are compiled once for each vector type.
type AnyShape<'s, V> = &'s dyn SupportMap<Vector = V>;

/// What a law is about: one shape, two directions, and the rounding that the shape states, as a length.
struct Case<'s, V: Vector> {
    shape: AnyShape<'s, V>,
    d: V,
    e: V,
    rounding: V::Scalar,
}

/// Whether a law holds.
type Held = Result<(), TestCaseError>;

type Law<V> = fn(&Case<'_, V>) -> Held;

/// The configuration of property tests that draw the same `cases` in every run, so that one commit has one verdict.
///
/// The environment variable `PROPTEST_RNG_SEED`, a number, draws others, and `PROPTEST_CASES` another number of them.
#[must_use]
pub fn config(cases: u32) -> ProptestConfig {
    let rng_seed = RngSeed::Fixed(20_041_120);
    contextualize_config(ProptestConfig { cases, rng_seed, ..ProptestConfig::default() })
}

/// Checks every law for the shapes of a strategy, along [directions](strategies::direction) that are adversarial.
///
/// # Panics
/// If a law is broken. The message names the law, the shape and the directions.
pub fn hold<S: SupportMap + Debug>(shapes: impl Strategy<Value = S>) {
    let directions = strategies::direction::<S::Vector>;
    let mut runner = TestRunner::new(ProptestConfig { failure_persistence: None, ..config(256) });
    let outcome = runner.run(&(shapes, directions(), directions()), |(shape, d, e)| check(&shape, d, e));
    if let Err(error) = outcome {
        panic!("in {}: {error}", std::any::type_name::<S::Vector>());
    }
}

/// Checks every law for one shape and two directions, neither of which is zero.
///
/// # Errors
/// Names the first law that is broken, and by how much it is.
pub fn check<V: Vector>(shape: AnyShape<'_, V>, d: V, e: V) -> Result<(), TestCaseError> {
    let laws: [(&str, Law<V>); 12] = [
        ("the support point reaches the support value", support_point_reaches_the_support_value),
        ("no support point reaches farther", no_support_point_reaches_farther),
        ("the support value is positively homogeneous", support_value_is_positively_homogeneous),
        ("the support value is subadditive", support_value_is_subadditive),
        ("origin, core and radius make the set", origin_core_and_radius_make_the_set),
        ("the extent bounds the core", extent_bounds_the_core),
        ("the rounding covers what support points show", rounding_covers_what_support_points_show),
        ("the closest point of the core is the closest", closest_point_of_the_core_is_the_closest),
        ("a line enters where it certainly does", line_enters_where_it_certainly_does),
        ("hints never change the value", hints_never_change_the_value),
        ("bounds contain the set and touch it", bounds_contain_the_set_and_touch_it),
        ("zero gives a point of the set, and nothing panics", zero_gives_a_point_of_the_set),
    ];
    let core = shape.core();
    let place = core.origin.norm() + core.size();
    let rounding = V::Scalar::from_f64(SLACK) * (core.error + V::Scalar::EPSILON * place);
    let case = Case { shape, d, e, rounding };
    laws.into_iter()
        .try_for_each(|(name, law)| law(&case).map_err(|broken| TestCaseError::fail(format!("{name}: {broken}"))))
}

/// Fails unless `a` is at most `b`, as lengths along a direction.
fn at_most<S: Scalar>(a: S, b: S, rounding: S) -> Held {
    // NaN fails this too.
    prop_assert!(a <= b + rounding, "{:?} is more than {:?} by more than {:?}", a, b, rounding);
    Ok(())
}

fn equal<S: Scalar>(a: S, b: S, rounding: S) -> Held {
    at_most(a, b, rounding)?;
    at_most(b, a, rounding)
}

/// The point of the core farthest along a direction, found without a hint.
fn core_point<V: Vector>(shape: AnyShape<'_, V>, d: V) -> V {
    shape.core_support(d, &mut Hint::new())
}

fn support_point_reaches_the_support_value<V: Vector>(&Case { shape, d, rounding, .. }: &Case<'_, V>) -> Held {
    equal(d.dot(shape.support(d)), support_value(shape, d), rounding * d.norm())
}

fn no_support_point_reaches_farther<V: Vector>(&Case { shape, d, e, rounding }: &Case<'_, V>) -> Held {
    at_most(e.dot(shape.support(d)), support_value(shape, e), rounding * e.norm())
}

fn support_value_is_positively_homogeneous<V: Vector>(&Case { shape, d, rounding, .. }: &Case<'_, V>) -> Held {
    let t = V::Scalar::from_f64(1.7);
    equal(support_value(shape, d * t), support_value(shape, d) * t, rounding * d.norm() * t)
}

fn support_value_is_subadditive<V: Vector>(&Case { shape, d, e, rounding }: &Case<'_, V>) -> Held {
    // Directions of like length, or the sum would say nothing about the shorter.
    let (Some(d), Some(e)) = (d.unit(), e.unit()) else { return Ok(()) };
    at_most(support_value(shape, d + e), support_value(shape, d) + support_value(shape, e), rounding)
}

fn origin_core_and_radius_make_the_set<V: Vector>(&Case { shape, d, rounding, .. }: &Case<'_, V>) -> Held {
    let core = shape.core();
    let value = d.dot(core.origin) + d.dot(core_point(shape, d)) + d.norm() * core.radius;
    equal(value, support_value(shape, d), rounding * d.norm())
}

fn extent_bounds_the_core<V: Vector>(&Case { shape, d, .. }: &Case<'_, V>) -> Held {
    let extent = shape.core().extent;
    at_most(core_point(shape, d).norm(), extent, extent * V::Scalar::EPSILON * V::Scalar::from_f64(8.0))
}

/// Answers near contact are proved by the [rounding](SupportMap::rounding) alone. One that is copied from another
/// shape, such as the part that a shape is made of, is mostly too small.
fn rounding_covers_what_support_points_show<V: Vector>(&Case { shape, d, e, .. }: &Case<'_, V>) -> Held {
    let Rounding { extent, error, error_length } = shape.rounding();
    let (Some(d), Some(n)) = (d.unit(), e.unit()) else { return Ok(()) };
    // A point is beyond the core by an error at most, and the farthest one short of it by another; the products round.
    let claimed = n.abs().dot(error).min(error_length);
    let products = V::Scalar::EPSILON * V::Scalar::from_f64(8.0) * n.abs().dot(extent);
    let farthest = n.dot(core_point(shape, n));
    // The support points along a direction nearby reach nearly as far, so that errors are seen.
    for d in [d, n + d * V::Scalar::EPSILON.sqrt()] {
        let k = core_point(shape, d);
        for i in 0..V::DIM {
            at_most(k.get(i).abs(), extent.get(i), V::Scalar::ZERO)?;
        }
        at_most(n.dot(k), farthest, claimed + claimed + products)?;
    }
    Ok(())
}

fn closest_point_of_the_core_is_the_closest<V: Vector>(&Case { shape, d, e, rounding }: &Case<'_, V>) -> Held {
    let core = shape.core();
    if let CoreKind::Point(point) = core.kind {
        prop_assert_eq!(point, core_point(shape, d), "the only point of the core");
    }
    let (surface, away) = (core_point(shape, e), e * (core.extent / e.norm()));
    for x in [surface + away, surface - away, surface * V::Scalar::from_f64(0.5), e] {
        let Some(p) = shape.core_closest_point(x) else { return Ok(()) };
        at_most(d.dot(p), d.dot(core_point(shape, d)), rounding * d.norm())?;
        // (x − p)·(k − p) ≤ 0 for every point k of the core; an error of p costs as much as x is away.
        let out = x - p;
        let lengths = x.norm() + core.extent;
        let slack = rounding + V::Scalar::from_f64(SLACK) * V::Scalar::EPSILON * lengths;
        at_most(out.dot(core_point(shape, out)) - out.dot(p), V::Scalar::ZERO, slack * lengths)?;
    }
    Ok(())
}

/// Algorithms trust this without a check. Lines are aimed at the surface along a direction, from beyond it and from
/// within, and past it.
fn line_enters_where_it_certainly_does<V: Vector>(&Case { shape, d, e, rounding }: &Case<'_, V>) -> Held {
    let core = shape.core();
    let size = core.size();
    let (at, away) = (shape.support(d), e * (size / e.norm()));
    for (source, direction) in [(at + away, -away), (at + away, away), (core.origin + away, at - core.origin)] {
        // Lengths whose squares are no numbers tell nothing.
        if !(direction.length_squared() > V::Scalar::ZERO && direction.length_squared().is_finite()) {
            continue;
        }
        let line = LineQuery::new(source, direction);
        let closely = || shape.certain_crossing(LineQuery { is_close: true, ..line });
        match shape.certain_crossing(line).or_else(closely) {
            None => {}
            Some(CertainCrossing::Misses(axis)) => {
                let Some((axis, d)) = axis.unit().zip(direction.unit()) else { continue };
                let Some(n) = (axis - d * axis.dot(d)).unit() else { continue };
                at_most(support_value(shape, n), n.dot(source), rounding + rounding)?;
            }
            Some(CertainCrossing::Enters { entry, bounds: [earliest, latest], normal }) => {
                at_most(earliest, entry, V::Scalar::ZERO)?;
                at_most(entry, latest, V::Scalar::ZERO)?;
                let inside = source + direction * latest;
                for n in [d, -d, e, -e, normal] {
                    at_most(n.dot(inside), support_value(shape, n), rounding * n.norm())?;
                }
            }
        }
    }
    Ok(())
}

fn hints_never_change_the_value<V: Vector>(&Case { shape, d, e, rounding }: &Case<'_, V>) -> Held {
    let fresh = d.dot(core_point(shape, d));
    let mut hint = Hint::new();
    shape.core_support(e, &mut hint);
    hint.rewind();
    equal(d.dot(shape.core_support(d, &mut hint)), fresh, rounding * d.norm())?;
    // Not even where the hint is another body's.
    let mut foreign = Hint::new();
    while let Some(slot) = foreign.next_slot() {
        *slot = u32::MAX;
    }
    foreign.rewind();
    equal(d.dot(shape.core_support(d, &mut foreign)), fresh, rounding * d.norm())
}

fn bounds_contain_the_set_and_touch_it<V: Vector>(&Case { shape, d, rounding, .. }: &Case<'_, V>) -> Held {
    let (aabb, sphere, p) = (bounding_box(shape), bounding_sphere(shape), shape.support(d));
    at_most((p - sphere.center).norm(), sphere.radius, rounding)?;
    at_most(sphere.radius, aabb.half_extents().norm(), rounding)?;
    for i in 0..V::DIM {
        at_most(aabb.min.get(i), p.get(i), rounding)?;
        at_most(p.get(i), aabb.max.get(i), rounding)?;
        equal(aabb.min.get(i), shape.support(-V::axis(i)).get(i), rounding)?;
        equal(aabb.max.get(i), shape.support(V::axis(i)).get(i), rounding)?;
    }
    Ok(())
}

fn zero_gives_a_point_of_the_set<V: Vector>(&Case { shape, d, e, rounding }: &Case<'_, V>) -> Held {
    let zero = shape.support(V::ZERO);
    prop_assert!(zero.is_finite(), "the support point for no direction is a point, not {:?}", zero);
    at_most(e.dot(zero), support_value(shape, e), rounding * e.norm())?;
    for bad in [V::Scalar::nan(), V::Scalar::infinity(), V::Scalar::neg_infinity()] {
        let _ = (shape.support(d * bad), support_value(shape, V::splat(bad)), core_point(shape, d * bad));
    }
    Ok(())
}
