//! The laws of support maps, one property each, over every shape and combinator in every space.

use convex_support::glam::{DMat3, DQuat, DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::strategies::{self, AnyShape};
use convex_support::{
    Affine, Ball, CoreKind, Difference, Hint, Hull, Matrix, MinkowskiSum, Posed, Rotation, Rounded, Scalar, SupportMap,
    Vector, bounding_box, bounding_sphere,
};
use num_traits::Float;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

/// A law of one shape and two directions, for any vector type.
trait Law {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, e: V, tolerance: V::Scalar) -> Result<(), TestCaseError>;
}

/// Checks a law over the shapes of all five vector types.
fn holds<L: Law>() {
    holds_in::<Vec2>(strategies::primitive, &L::check);
    holds_in::<DVec2>(strategies::primitive, &L::check);
    holds_in::<Vec3>(strategies::primitive_3d, &L::check);
    holds_in::<Vec3A>(strategies::primitive_3d, &L::check);
    holds_in::<DVec3>(strategies::primitive_3d, &L::check);
}

type Statement<'a, V> = &'a dyn Fn(&AnyShape<V>, V, V, <V as Vector>::Scalar) -> Result<(), TestCaseError>;

// By `dyn`, so that the strategies and the runner are compiled once for each vector type, not once for each law.
fn holds_in<V: Vector>(primitive: fn(V::Scalar) -> BoxedStrategy<AnyShape<V>>, statement: Statement<'_, V>) {
    let cases = strategies::size::<V::Scalar>()
        .prop_flat_map(move |size| (strategies::combined(primitive(size), size), Just(size)));
    let strategy = (cases, strategies::direction::<V>(), strategies::direction::<V>());
    let mut runner = TestRunner::new(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) });
    let outcome = runner.run(&strategy, |((shape, size), d, e)| {
        // No combination of the strategies reaches farther than some twenty sizes.
        statement(&shape, d, e, V::Scalar::EPSILON * size * V::Scalar::from_f64(400.0))
    });
    if let Err(error) = outcome {
        panic!("in {}: {error}", std::any::type_name::<V>());
    }
}

/// `what` is the same by both accounts.
fn close<S: Scalar>(what: &str, a: S, b: S, tolerance: S) -> Result<(), TestCaseError> {
    prop_assert!((a - b).abs() <= tolerance, "{}: {:?} against {:?}, allowed {:?}", what, a, b, tolerance);
    Ok(())
}

/// What an error of `tolerance`, a length, amounts to along a direction.
fn along<V: Vector>(tolerance: V::Scalar, direction: V) -> V::Scalar {
    tolerance * direction.norm()
}

struct SupportPointReachesTheSupportValue;
impl Law for SupportPointReachesTheSupportValue {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, _: V, tolerance: V::Scalar) -> Result<(), TestCaseError> {
        close("d·s(d) = h(d)", d.dot(shape.support(d)), shape.support_value(d), along(tolerance, d))
    }
}

#[test]
fn support_point_reaches_the_support_value() {
    holds::<SupportPointReachesTheSupportValue>();
}

struct NoSupportPointReachesFarther;
impl Law for NoSupportPointReachesFarther {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, e: V, tolerance: V::Scalar) -> Result<(), TestCaseError> {
        let (reach, best) = (e.dot(shape.support(d)), shape.support_value(e));
        prop_assert!(reach <= best + along(tolerance, e), "s(d) reaches {reach:?} along e, but h(e) = {best:?}");
        Ok(())
    }
}

#[test]
fn no_support_point_reaches_farther() {
    holds::<NoSupportPointReachesFarther>();
}

struct SupportValueIsPositivelyHomogeneous;
impl Law for SupportValueIsPositivelyHomogeneous {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, _: V, tolerance: V::Scalar) -> Result<(), TestCaseError> {
        let t = V::Scalar::from_f64(1.7);
        close("h(t·d) = t·h(d)", shape.support_value(d * t), shape.support_value(d) * t, along(tolerance, d * t))
    }
}

#[test]
fn support_value_is_positively_homogeneous() {
    holds::<SupportValueIsPositivelyHomogeneous>();
}

struct SupportValueIsSubadditive;
impl Law for SupportValueIsSubadditive {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, e: V, tolerance: V::Scalar) -> Result<(), TestCaseError> {
        // Directions of like length, or the sum would say nothing about the shorter.
        let (Some(d), Some(e)) = (d.unit(), e.unit()) else { return Err(TestCaseError::reject("zero direction")) };
        let (sum, parts) = (shape.support_value(d + e), shape.support_value(d) + shape.support_value(e));
        prop_assert!(sum <= parts + tolerance, "h(d + e) = {sum:?} > h(d) + h(e) = {parts:?}");
        Ok(())
    }
}

#[test]
fn support_value_is_subadditive() {
    holds::<SupportValueIsSubadditive>();
}

struct OriginCoreAndRadiusMakeTheSet;
impl Law for OriginCoreAndRadiusMakeTheSet {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, _: V, tolerance: V::Scalar) -> Result<(), TestCaseError> {
        let core = shape.core_support(d, &mut Hint::new());
        let value = d.dot(shape.core().origin) + d.dot(core) + d.norm() * shape.core().radius;
        close("d·o + d·k(d) + r·|d| = h(d)", value, shape.support_value(d), along(tolerance, d))
    }
}

#[test]
fn origin_core_and_radius_make_the_set() {
    holds::<OriginCoreAndRadiusMakeTheSet>();
}

struct CoreExtentBoundsTheCore;
impl Law for CoreExtentBoundsTheCore {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, _: V, _: V::Scalar) -> Result<(), TestCaseError> {
        let (reach, extent) = (shape.core_support(d, &mut Hint::new()).norm(), shape.core().extent);
        let ulps = V::Scalar::ONE + V::Scalar::EPSILON * V::Scalar::from_f64(8.0);
        prop_assert!(reach <= extent * ulps, "the core reaches {reach:?}, beyond its extent {extent:?}");
        Ok(())
    }
}

#[test]
fn core_extent_bounds_the_core() {
    holds::<CoreExtentBoundsTheCore>();
}

struct ClosestPointOfTheCoreIsTheClosest;
impl Law for ClosestPointOfTheCoreIsTheClosest {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, e: V, tolerance: V::Scalar) -> Result<(), TestCaseError> {
        let core = |d: V| shape.core_support(d, &mut Hint::new());
        if let CoreKind::Point(point) = shape.core().kind {
            prop_assert_eq!(point, core(d), "the only point of the core");
        }
        let rounding = V::Scalar::EPSILON * V::Scalar::from_f64(400.0);
        let away = e * (tolerance / rounding / e.norm());
        for x in [core(e) + away, core(e) - away, core(e) * V::Scalar::from_f64(0.5), e] {
            let Some(p) = shape.core_closest_point(x) else { return Ok(()) };
            let reach = d.dot(core(d));
            prop_assert!(d.dot(p) <= reach + along(tolerance, d), "{p:?} is beyond {reach:?} along {d:?}");
            // (x − p)·(k − p) ≤ 0 for every point k of the core; an error of p costs as much as x is away.
            let out = x - p;
            let (excess, lengths) = (out.dot(core(out)) - out.dot(p), x.norm() + shape.core().extent);
            prop_assert!(excess <= rounding * lengths * lengths, "{p:?} is not the closest to {x:?}, by {excess:?}");
        }
        Ok(())
    }
}

#[test]
fn closest_point_of_the_core_is_the_closest() {
    holds::<ClosestPointOfTheCoreIsTheClosest>();
}

struct HintsNeverChangeTheValue;
impl Law for HintsNeverChangeTheValue {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, e: V, tolerance: V::Scalar) -> Result<(), TestCaseError> {
        let mut hint = Hint::new();
        let fresh = d.dot(shape.core_support(d, &mut Hint::new()));
        shape.core_support(e, &mut hint);
        hint.rewind();
        let hinted = d.dot(shape.core_support(d, &mut hint));
        close("with a hint from another direction", hinted, fresh, along(tolerance, d))?;
        // Not even where the hint is another body's.
        let mut stale = Hint::new();
        while let Some(slot) = stale.next_slot() {
            *slot = u32::MAX;
        }
        stale.rewind();
        close("with a foreign hint", d.dot(shape.core_support(d, &mut stale)), fresh, along(tolerance, d))
    }
}

#[test]
fn hints_never_change_the_value() {
    holds::<HintsNeverChangeTheValue>();
}

struct CombinatorsAreTheirFormulas;
impl Law for CombinatorsAreTheirFormulas {
    fn check<V: Vector>(a: &AnyShape<V>, d: V, e: V, tolerance: V::Scalar) -> Result<(), TestCaseError> {
        let within = along(tolerance, d);
        let two = V::Scalar::from_f64(2.0);
        let b = Affine::new(a, V::Matrix::from_diagonal(V::axis(0) * two), V::ZERO).expect("finite");
        let (ha, hb) = (a.support_value(d), b.support_value(d));
        close("sum", MinkowskiSum::new(a, &b).support_value(d), ha + hb, within)?;
        close("difference", Difference::new(a, &b).support_value(d), ha + b.support_value(-d), within)?;
        close("hull", Hull::new(a, &b).support_value(d), ha.max(hb), within)?;
        let r = tolerance / (V::Scalar::EPSILON * V::Scalar::from_f64(400.0));
        close("rounded", Rounded::new(a, r).expect("r ≥ 0").support_value(d), ha + r * d.norm(), within)?;
        let ball = Ball::<V>::new(r).expect("r ≥ 0");
        close("swept by a ball", MinkowskiSum::new(a, ball).support_value(d), ha + r * d.norm(), within)?;

        let columns: V::Matrix = Matrix::from_cols_fn(|j| if j == 0 { e / e.norm() } else { V::axis(j) });
        let shift = V::ONE * r;
        let affine = Affine::new(a, columns, shift).expect("finite");
        let formula = a.support_value(columns.transpose_mul(d)) + d.dot(shift);
        close("affine", affine.support_value(d), formula, within)?;
        let q = V::Rotation::from_xyzw([0.1, 0.2, 0.3, 0.9].map(V::Scalar::from_f64));
        let rotation = q.matrix();
        let formula = a.support_value(rotation.transpose_mul(d)) + d.dot(shift);
        close("posed", Posed::new(a, q, shift).expect("finite").support_value(d), formula, within)
    }
}

#[test]
fn combinators_are_their_formulas() {
    holds::<CombinatorsAreTheirFormulas>();
}

/// The same draws at two sizes: scaling a shape by a power of two scales every answer by it, to the last bit.
fn same_bits<V: Vector>(primitive: fn(V::Scalar) -> BoxedStrategy<AnyShape<V>>) {
    for (seed, factor) in (0u8..200).zip([1024.0, 2f64.powi(-40), 2f64.powi(30)].into_iter().cycle()) {
        let factor = V::Scalar::from_f64(factor);
        let draw = |size: V::Scalar| {
            let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]);
            let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
            let strategy = (strategies::direction::<V>(), strategies::combined(primitive(size), size));
            strategy.new_tree(&mut runner).expect("strategies reject nothing").current()
        };
        let ((d, unit), (_, scaled)) = (draw(V::Scalar::ONE), draw(factor));
        assert_eq!(scaled.support(d), unit.support(d) * factor, "{unit:?} along {d:?}");
        assert_eq!(scaled.support_value(d), unit.support_value(d) * factor, "{unit:?} along {d:?}");
        let (unit_core, scaled_core) = (unit.core(), scaled.core());
        assert_eq!(scaled_core.origin, unit_core.origin * factor, "{unit:?}");
        assert_eq!(scaled_core.radius, unit_core.radius * factor, "{unit:?}");
        assert_eq!(scaled_core.extent, unit_core.extent * factor, "{unit:?}");
        assert_eq!(unit.support(d * factor), unit.support(d), "{unit:?} along {d:?}");
    }
}

#[test]
fn powers_of_two_change_no_bit() {
    same_bits::<Vec2>(strategies::primitive);
    same_bits::<DVec2>(strategies::primitive);
    same_bits::<Vec3>(strategies::primitive_3d);
    same_bits::<Vec3A>(strategies::primitive_3d);
    same_bits::<DVec3>(strategies::primitive_3d);
}

struct NothingPanics;
impl Law for NothingPanics {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, e: V, _: V::Scalar) -> Result<(), TestCaseError> {
        let zero = shape.support(V::ZERO);
        let (reach, best) = (e.dot(zero), shape.support_value(e));
        let slack = V::Scalar::EPSILON * V::Scalar::from_f64(400.0) * (e.norm() * (zero.norm() + shape.core().extent));
        prop_assert!(zero.is_finite(), "the support point for no direction is a point, not {:?}", zero);
        prop_assert!(reach <= best + slack + best.abs() * slack, "and it is in the set: {:?} > {:?}", reach, best);
        for bad in [V::Scalar::nan(), V::Scalar::infinity(), V::Scalar::neg_infinity()] {
            let mut hint = Hint::new();
            let _ =
                (shape.support(d * bad), shape.support_value(V::splat(bad)), shape.core_support(d * bad, &mut hint));
        }
        Ok(())
    }
}

#[test]
fn zero_gives_a_point_of_the_set_and_nothing_panics() {
    holds::<NothingPanics>();
}

struct BoundsContainTheSet;
impl Law for BoundsContainTheSet {
    fn check<V: Vector>(shape: &AnyShape<V>, d: V, _: V, tolerance: V::Scalar) -> Result<(), TestCaseError> {
        let (aabb, sphere, p) = (bounding_box(shape), bounding_sphere(shape), shape.support(d));
        prop_assert_eq!(
            p.min(aabb.max + V::ONE * tolerance).max(aabb.min - V::ONE * tolerance),
            p,
            "the box is too small"
        );
        prop_assert!((p - sphere.center).norm() <= sphere.radius + tolerance, "{:?} is too small for {:?}", sphere, p);
        for i in 0..V::DIM {
            let (low, high) = (shape.support(-V::axis(i)).get(i), shape.support(V::axis(i)).get(i));
            close("the low side", aabb.min.get(i), low, tolerance)?;
            close("the high side", aabb.max.get(i), high, tolerance)?;
        }
        prop_assert!(sphere.radius <= aabb.half_extents().norm() + tolerance, "{:?} is larger than {:?}", sphere, aabb);
        Ok(())
    }
}

#[test]
fn bounds_contain_the_set_tightly() {
    holds::<BoundsContainTheSet>();
}

#[test]
fn a_scaled_or_mirrored_ball_stays_a_ball() {
    let ball = Ball::<DVec3>::new(0.5).expect("r ≥ 0");
    let mirror = DMat3::from_diagonal(DVec3::new(-2.0, 2.0, 2.0));
    let turned = DMat3::from_quat(DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9).normalize());
    let image = Affine::new(ball, mirror * turned, DVec3::X).expect("finite");
    let radius = image.core().radius;
    assert!((radius - 1.0).abs() < 1e-15, "{radius}");
    assert_eq!(image.core_support(DVec3::ONE, &mut Hint::new()), DVec3::ZERO, "its core stays a point");
    let sheared = Affine::new(ball, DMat3::from_diagonal(DVec3::new(2.0, 2.0, 1.0)), DVec3::X).expect("finite");
    assert_eq!(sheared.core().radius, 0.0, "an ellipsoid is its own core");
}

/// Sizes and directions whose products are out of range, in single precision: only the direction of the direction matters.
#[test]
fn support_points_do_not_depend_on_the_length_of_the_direction() {
    use convex_support::glam::{Mat3A, Quat};
    use convex_support::{Cone, Cuboid, Cylinder, Ellipsoid, Polytope};

    for size in [1e-30_f32, 1e-18, 1.0, 1e18, 1e30] {
        for thin in [1.0, 1e-6] {
            let extents = Vec3A::new(1.0, 0.5, thin) * size;
            let ellipsoid = Ellipsoid::new(Vec3A::ZERO, extents, Quat::IDENTITY).unwrap();
            let corners = (0..40).map(|i| Vec3A::new((i as f32).sin(), (2.5 * i as f32).cos(), (1.7 * i as f32).sin()));
            let corners: Vec<Vec3A> = corners.map(|p| p * extents).collect();
            let shapes: [Box<dyn SupportMap<Vector = Vec3A>>; 8] = [
                Box::new(Cuboid::new(extents).unwrap()),
                Box::new(Cylinder::new(size, size * thin).unwrap()),
                Box::new(Cone::new(size, size * thin).unwrap()),
                Box::new(Cone::new(size * thin, size).unwrap()),
                Box::new(Posed::new(ellipsoid, Quat::from_xyzw(0.5, 0.5, -0.5, 0.5), Vec3A::ZERO).unwrap()),
                Box::new(
                    Affine::new(Ball::new(1.0).unwrap(), Mat3A::from_diagonal(extents.into()), Vec3A::ZERO).unwrap(),
                ),
                Box::new(Polytope::new(corners.iter().copied()).unwrap()),
                Box::new(Polytope::hull_of(corners).unwrap()),
            ];
            for (k, shape) in shapes.iter().enumerate() {
                for i in 0..50 {
                    let i = i as f32;
                    let d = Vec3A::new((1.3 * i).sin(), (2.1 * i).sin(), (3.7 * i).sin());
                    let expected = shape.support(d);
                    for exponent in [-90, -66, -50, 33, 60, 100] {
                        let found = shape.support(d * 2.0_f32.powi(exponent));
                        assert_eq!(found, expected, "shape {k} of size {size:e} × {thin:e} along {d} · 2^{exponent}");
                    }
                }
            }
        }
    }
}

/// Far from the world's origin the origin of a shape is rounded by much of the shape's size, and the core makes up for it.
#[test]
fn a_shape_placed_far_away_loses_nothing_of_itself() {
    use convex_support::Polytope;
    use convex_support::glam::{Mat3A, Quat};

    let corners = [[0.3, 0.1, 0.2], [0.9, 0.3, 0.1], [0.2, 0.8, 0.4], [0.5, 0.4, 0.7]].map(Vec3A::from);
    let far = Vec3A::new(3e6, -1e6, 2e6);
    let tetrahedron = Polytope::new(corners).unwrap();
    let posed = Posed::new(tetrahedron.clone(), Quat::IDENTITY, far).unwrap();
    let mapped = Affine::new(tetrahedron, Mat3A::IDENTITY, far).unwrap();
    for shape in [&posed as &dyn SupportMap<Vector = Vec3A>, &mapped] {
        for (corner, d) in corners.iter().zip([[-1.0, -2.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) {
            // Exact: the origin and the translation are alike but for a few bits.
            let seen = (shape.core().origin - far) + shape.core_support(d.into(), &mut Hint::default());
            assert!((seen - *corner).abs().max_element() < 4.0 * f32::EPSILON, "{seen}, not {corner}");
        }
    }
}
