//! The laws of support maps, one property each, over every shape and combinator in every space.

use convex_support::glam::{DMat3, DQuat, DVec2, DVec3, Quat, Vec2, Vec3, Vec3A};
use convex_support::strategies::{self, AnyShape};
use convex_support::{
    Affine, Ball, Core, CoreKind, Cuboid, Difference, Ellipsoid, Hint, Hull, Matrix, MinkowskiSum, Posed, Rotation,
    Rounded, Rounding, Scalar, SupportMap, Vector, laws, support_value,
};
use num_traits::Float;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

/// Shapes of every kind, and combinations of them, of any size.
fn shapes<V: Vector>(primitive: fn(V::Scalar) -> BoxedStrategy<AnyShape<V>>) -> impl Strategy<Value = AnyShape<V>> {
    strategies::size::<V::Scalar>().prop_flat_map(move |size| strategies::combined(primitive(size), size))
}

#[test]
fn the_laws_hold_in_the_plane() {
    laws::hold(shapes::<Vec2>(strategies::primitive));
    laws::hold(shapes::<DVec2>(strategies::primitive));
}

#[test]
fn the_laws_hold_in_space() {
    laws::hold(shapes::<Vec3>(strategies::primitive_3d));
    laws::hold(shapes::<Vec3A>(strategies::primitive_3d));
    laws::hold(shapes::<DVec3>(strategies::primitive_3d));
}

/// The law that a shape breaks along any of some directions.
fn broken(shape: &dyn SupportMap<Vector = DVec3>) -> Option<String> {
    let direction = |i: u32| DVec3::new((1.3 * f64::from(i)).sin(), (2.1 * f64::from(i)).cos(), 0.5);
    let law = |i: u32| laws::check(shape, direction(i), direction(i + 1)).err();
    (0..100).find_map(law).map(|broken| broken.to_string())
}

const OF_ROUNDING: &str = "the rounding covers what support points show";

/// A turned box that says of its rounding what the box in it says: that its coordinates are no larger.
#[test]
fn a_rounding_copied_from_a_part_breaks_a_law() {
    #[derive(Debug)]
    struct Turned(Posed<Cuboid<DVec3>>, bool);

    impl SupportMap for Turned {
        type Vector = DVec3;

        fn support(&self, direction: DVec3) -> DVec3 {
            self.0.support(direction)
        }

        fn core(&self) -> Core<DVec3> {
            self.0.core()
        }

        fn core_support(&self, direction: DVec3, hint: &mut Hint) -> DVec3 {
            self.0.core_support(direction, hint)
        }

        fn rounding(&self) -> Rounding<DVec3> {
            if self.1 { self.0.shape().rounding() } else { self.0.rounding() }
        }
    }

    let cuboid = Cuboid::new(DVec3::new(1.0, 2.0, 3.0)).expect("a box");
    let turned = Posed::new(cuboid, DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9), DVec3::X).expect("a pose");
    let law = broken(&Turned(turned, true)).expect("the rounding is copied");
    assert!(law.contains(OF_ROUNDING), "{law}");
    assert_eq!(broken(&Turned(turned, false)), None);
}

/// An ellipsoid in single precision within double, whose core says so and whose rounding is that of a shape in double.
#[test]
fn a_rounding_that_is_too_small_breaks_a_law() {
    #[derive(Debug)]
    struct Single(Ellipsoid<Vec3A>, f64);

    impl SupportMap for Single {
        type Vector = DVec3;

        fn support(&self, direction: DVec3) -> DVec3 {
            self.0.support(direction.as_vec3a()).as_dvec3()
        }

        fn core(&self) -> Core<DVec3> {
            Core { error: 1e-6, ..Core::exact(CoreKind::Curved, 4.0) }
        }

        fn rounding(&self) -> Rounding<DVec3> {
            Rounding::relative(DVec3::splat(3.0), self.1)
        }
    }

    let ellipsoid = Ellipsoid::new(Vec3A::ZERO, Vec3A::new(1.0, 2.0, 3.0), Quat::IDENTITY).expect("an ellipsoid");
    let in_single = 8.0 * f64::from(f32::EPSILON) / f64::EPSILON;
    let law = broken(&Single(ellipsoid, 4.0)).expect("the rounding is that of another precision");
    assert!(law.contains(OF_ROUNDING), "{law}");
    assert_eq!(broken(&Single(ellipsoid, in_single)), None);
}

fn combinators_are_their_formulas_in<V: Vector>(primitive: fn(V::Scalar) -> BoxedStrategy<AnyShape<V>>) {
    let shapes = strategies::size::<V::Scalar>()
        .prop_flat_map(move |size| (strategies::combined(primitive(size), size), Just(size)));
    let strategy = (shapes, strategies::direction::<V>(), strategies::direction::<V>());
    let mut runner = TestRunner::new(ProptestConfig { failure_persistence: None, ..laws::config(256) });
    let outcome = runner.run(&strategy, |((a, size), d, e)| {
        // No combination of the strategies reaches farther than some twenty sizes.
        let r = size;
        let allowed = V::Scalar::EPSILON * V::Scalar::from_f64(400.0) * size * d.norm();
        let alike = |what: &str, value: V::Scalar, formula: V::Scalar| {
            prop_assert!((value - formula).abs() <= allowed, "{}: {:?}, not {:?}", what, value, formula);
            Ok(())
        };
        let b = Affine::new(&a, V::Matrix::from_diagonal(V::axis(0) * V::Scalar::from_f64(2.0)), V::ZERO);
        let b = b.expect("finite");
        let (ha, hb) = (support_value(&a, d), support_value(&b, d));
        alike("sum", support_value(&MinkowskiSum::new(&a, &b), d), ha + hb)?;
        alike("difference", support_value(&Difference::new(&a, &b), d), ha + support_value(&b, -d))?;
        alike("hull", support_value(&Hull::new(&a, &b), d), ha.max(hb))?;
        alike("rounded", support_value(&Rounded::new(&a, r).expect("r ≥ 0"), d), ha + r * d.norm())?;
        let ball = Ball::<V>::new(r).expect("r ≥ 0");
        alike("swept by a ball", support_value(&MinkowskiSum::new(&a, ball), d), ha + r * d.norm())?;

        let columns: V::Matrix = Matrix::from_cols_fn(|j| if j == 0 { e / e.norm() } else { V::axis(j) });
        let shift = V::ONE * r;
        let formula = |columns: V::Matrix| support_value(&a, columns.transpose_mul(d)) + d.dot(shift);
        let affine = Affine::new(&a, columns, shift).expect("finite");
        alike("affine", support_value(&affine, d), formula(columns))?;
        let q = V::Rotation::from_xyzw([0.1, 0.2, 0.3, 0.9].map(V::Scalar::from_f64));
        let posed = Posed::new(&a, q, shift).expect("finite");
        alike("posed", support_value(&posed, d), formula(q.matrix()))
    });
    if let Err(error) = outcome {
        panic!("in {}: {error}", std::any::type_name::<V>());
    }
}

#[test]
fn combinators_are_their_formulas() {
    combinators_are_their_formulas_in::<Vec2>(strategies::primitive);
    combinators_are_their_formulas_in::<DVec2>(strategies::primitive);
    combinators_are_their_formulas_in::<Vec3>(strategies::primitive_3d);
    combinators_are_their_formulas_in::<Vec3A>(strategies::primitive_3d);
    combinators_are_their_formulas_in::<DVec3>(strategies::primitive_3d);
}

/// A support map that answers with a point of another set along some directions.
#[derive(Debug)]
struct Liar;

impl SupportMap for Liar {
    type Vector = DVec2;

    fn support(&self, d: DVec2) -> DVec2 {
        if d.x > 2.0 * d.y.abs() { DVec2::X * 0.5 } else { d.try_normalize().unwrap_or(DVec2::Y) }
    }
}

#[test]
fn a_broken_law_is_named() {
    let broken =
        laws::check(&Liar, DVec2::new(1.0, 0.6), DVec2::X).expect_err("the ball reaches farther than 0.5 along x");
    assert!(broken.to_string().contains("no support point reaches farther"), "{broken}");
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
        assert_eq!(support_value(&scaled, d), support_value(&unit, d) * factor, "{unit:?} along {d:?}");
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

/// Sizes and directions whose products are out of range, in single precision: only the direction of the direction
/// matters.
#[test]
fn support_points_do_not_depend_on_the_length_of_the_direction() {
    use convex_support::glam::Mat3A;
    use convex_support::{Cone, Cylinder, Polytope};

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

/// Far from the world's origin the origin of a shape is rounded by much of the shape's size, and the core makes up for
/// it.
#[test]
fn a_shape_placed_far_away_loses_nothing_of_itself() {
    use convex_support::Polytope;
    use convex_support::glam::Mat3A;

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
