//! What cannot be a shape is refused for what is wrong with it; and numbers of any magnitude that can be one are taken.

use convex_support::glam::{DMat2, DMat3, DQuat, DVec2, DVec3, Quat, Vec3};
use convex_support::{
    Ball, Cone, Cuboid, Cylinder, Ellipsoid, InvalidShape, Point, Polytope, Posed, Segment, SupportMap, Triangle,
    support_value,
};

#[test]
fn a_rotation_of_nan_is_not_finite_and_one_of_zeros_is_zero() {
    let ball = Ball::<DVec3>::new(1.0).unwrap();
    let turned = |q| Posed::new(ball, q, DVec3::ZERO).map(|_| ());
    let not_finite = |index| Err(InvalidShape::NonFinite { parameter: "rotation", index });
    assert_eq!(turned(DQuat::from_xyzw(0.0, f64::NAN, 0.0, 1.0)), not_finite(1));
    assert_eq!(turned(DQuat::from_xyzw(0.0, 0.0, 0.0, f64::INFINITY)), not_finite(3));
    assert_eq!(turned(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)), Err(InvalidShape::ZeroRotation));
    let disc = Ball::<DVec2>::new(1.0).unwrap();
    assert_eq!(Posed::new(disc, f64::NAN, DVec2::ZERO).map(|_| ()), not_finite(0));
    let stone = Ellipsoid::new(Vec3::ZERO, Vec3::ONE, Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)).map(|_| ());
    assert_eq!(stone, not_finite(0));
}

#[test]
fn a_mirror_is_told_from_a_matrix_that_is_not_orthonormal() {
    let ball = Ball::<DVec3>::new(1.0).unwrap();
    let posed = |m| Posed::from_matrix(ball, m, DVec3::ZERO).map(|_| ());
    assert_eq!(posed(DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0))), Err(InvalidShape::Mirrors));
    assert_eq!(posed(DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0))), Err(InvalidShape::NotOrthonormal));
    assert!(InvalidShape::Mirrors.to_string().contains("mirrors"), "{}", InvalidShape::Mirrors);
}

/// Semi-axes from 1e-140 to 1e140 of a matrix that is turned, at even and odd powers of two.
#[test]
fn matrices_of_any_magnitude_are_ellipsoids() {
    let (semi_axes, q) = (DVec3::new(3.0, 2.0, 1.0), DQuat::from_xyzw(0.1, 0.5, -0.3, 0.7));
    let unit = Ellipsoid::new(DVec3::ZERO, semi_axes, q).unwrap();
    for power in [-900, -899, -531, -1, 0, 2, 531, 899, 900] {
        let scale = 2f64.powi(power);
        let matrix = unit.matrix() * scale;
        let found = Ellipsoid::from_matrix(DVec3::ZERO, matrix).unwrap_or_else(|e| panic!("2^{power}: {e}"));
        let length = scale.sqrt();
        for d in [DVec3::X, DVec3::new(0.3, -0.4, 1.0), DVec3::Z] {
            let (reach, expected) = (support_value(&found, d) * length, support_value(&unit, d));
            assert!((reach / expected - 1.0).abs() < 1e-13, "2^{power} along {d}: {reach} for {expected}");
        }
    }
    let tiny = Ellipsoid::from_matrix(DVec2::ZERO, DMat2::from_diagonal(DVec2::new(1e160, 4e160))).unwrap();
    let found = [support_value(&tiny, DVec2::X), support_value(&tiny, DVec2::Y)];
    assert!((found[0] / 1e-80 - 1.0).abs() < 1e-15 && (found[1] / 0.5e-80 - 1.0).abs() < 1e-15, "{found:?}");
}

/// The corner of a box of 1e308 is still a number away; that of one of 1.2e308 is not, and neither are sizes like it.
#[test]
fn shapes_larger_than_the_largest_number_are_refused() {
    let too_large = |parameter| Some(InvalidShape::TooLarge { parameter });
    let large = Cuboid::new(DVec3::splat(1e308)).unwrap();
    assert!(large.core().extent.is_finite(), "{:?}", large.core());
    assert_eq!(large.support(DVec3::ONE), DVec3::splat(1e308));
    assert_eq!(Cuboid::new(DVec3::splat(1.2e308)).err(), too_large("half_extents"));
    assert_eq!(Cylinder::<DVec3>::new(1.5e308, 1.5e308).err(), too_large("half_height"));
    assert_eq!(Cone::<DVec3>::new(1.5e308, 1.5e308).err(), too_large("half_height"));
    let (low, high) = (DVec3::splat(-1.5e308), DVec3::splat(1.5e308));
    assert_eq!(Segment::new([low, high]).err(), too_large("points"));
    assert_eq!(Triangle::new([low, high, DVec3::ZERO]).err(), too_large("points"));
    assert_eq!(Polytope::new([low, high]).err(), too_large("points"));
    let point = Point::new(high).unwrap();
    assert_eq!(Posed::translated(point, high).err(), too_large("translation"));
}
