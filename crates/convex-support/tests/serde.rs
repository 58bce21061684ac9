//! Shapes survive being written and read, to the last bit, and invalid ones are not read.

use std::fmt::Debug;

use convex_support::glam::{DMat3, DQuat, DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Difference, Ellipsoid, Faceted, Feature, Hull, InvalidShape,
    LineQuery, Matrix, MinkowskiSum, Point, Polytope, Posed, Rounded, Scalar, Segment, SupportMap, Triangle, Vector,
    Vector3, bounding_box, bounding_sphere, line_crossing, strategies,
};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, from_str, from_value, json, to_string};

/// Writes, reads and compares, and writes again, which tells zeros of either sign apart; returns what is written.
fn round_trip<S: Serialize + DeserializeOwned + PartialEq + Debug>(shape: S) -> String {
    let text = to_string(&shape).expect("every shape can be written");
    let read = from_str::<S>(&text).expect("what was written can be read");
    assert_eq!(read, shape, "{text}");
    assert_eq!(to_string(&read).expect("and written again"), text, "written again");
    text
}

/// All that a search asks of a shape, as text, in which every bit shows.
fn asked<S: SupportMap>(shape: &S, d: S::Vector, e: S::Vector) -> String {
    let slab = S::Vector::axis(0).norm() * Scalar::from_f64(0.01);
    let mut feature = Feature::new();
    shape.core_support_feature(d, slab, &mut feature);
    let (core, rounding) = (shape.core(), shape.rounding());
    let crossing = shape.certain_crossing(LineQuery::new(e, d));
    let curved = (shape.core_support_hessian(d, [d, e]), shape.core_closest_point(e));
    format!("{core:?} {rounding:?} {:?} {feature:?} {crossing:?} {curved:?}", shape.support(d))
}

/// The shapes of a strategy come back equal from being written and read, and give the same answers to the last bit.
fn come_back<S>(shapes: BoxedStrategy<S>)
where
    S: SupportMap + Serialize + DeserializeOwned + PartialEq + Debug,
{
    let direction = strategies::direction::<S::Vector>;
    // Each of some hundred types, always with the same shapes.
    let config = ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let outcome = runner.run(&(shapes, direction(), direction()), |(shape, d, e)| {
        let text = to_string(&shape).expect("every shape can be written");
        let read = from_str::<S>(&text).expect("what was written can be read");
        prop_assert_eq!(&read, &shape, "{}", &text);
        prop_assert_eq!(to_string(&read).expect("and written again"), text.clone(), "written again");
        prop_assert_eq!(asked(&read, d, e), asked(&shape, d, e), "{}", text);
        Ok(())
    });
    if let Err(error) = outcome {
        panic!("{}: {error}", std::any::type_name::<S>());
    }
}

/// Shapes of any space, and shapes made of them.
fn all_come_back<V>()
where
    V: Vector<Matrix: Serialize + DeserializeOwned, Scalar: Serialize + DeserializeOwned>
        + Serialize
        + DeserializeOwned,
{
    let one = V::Scalar::ONE;
    come_back(strategies::point::<V>(one));
    come_back(strategies::segment::<V>(one));
    come_back(strategies::triangle::<V>(one));
    come_back(strategies::ball::<V>(one));
    come_back(strategies::cuboid::<V>(one));
    come_back(strategies::capsule::<V>(one));
    come_back(strategies::ellipsoid::<V>(one));
    come_back(strategies::polytope::<V>(one, 12));
    come_back(strategies::points::<V>(one, 40).prop_map(|p| Polytope::hull_of(p).expect("points")).boxed());
    come_back(strategies::points::<V>(one, 40).prop_map(|p| Faceted::hull_of(p).expect("points")).boxed());
    posed_come_back(strategies::capsule::<V>(one));
    posed_come_back(strategies::ellipsoid::<V>(one));
    posed_come_back(posed(strategies::triangle::<V>(one)));
    let mapped = (strategies::ball::<V>(one), strategies::matrix::<V>(), strategies::vector::<V>(one));
    let mapped = mapped.prop_map(|(shape, matrix, by)| Affine::new(shape, matrix, by).expect("valid")).boxed();
    come_back(mapped.clone());
    let pair = (posed(strategies::cuboid::<V>(one)), mapped);
    come_back(pair.clone().prop_map(|(a, b)| MinkowskiSum::new(a, b)).boxed());
    come_back(pair.clone().prop_map(|(a, b)| Difference::new(a, b)).boxed());
    come_back(pair.prop_map(|(a, b)| Hull::new(a, Rounded::new(b, V::Scalar::from_f64(0.1)).expect("valid"))).boxed());
}

fn posed<S: SupportMap + Clone + Debug + 'static>(shapes: BoxedStrategy<S>) -> BoxedStrategy<Posed<S>> {
    let pose = strategies::pose::<S::Vector>(Scalar::ONE);
    (shapes, pose).prop_map(|(shape, (rotation, by))| Posed::new(shape, rotation, by).expect("valid")).boxed()
}

/// Shapes posed in each way: by a rotation, by its matrix, by one that has drifted, and by a translation alone.
fn posed_come_back<S>(shapes: BoxedStrategy<S>)
where
    S: SupportMap + Clone + Debug + PartialEq + Serialize + DeserializeOwned + 'static,
    S::Vector: Serialize + DeserializeOwned,
    <S::Vector as Vector>::Matrix: Serialize + DeserializeOwned,
{
    let by_matrix = |drift: f64| {
        let drifted = move |pose: Posed<S>| {
            let half_of_the_digits = <S::Vector as Vector>::Scalar::EPSILON.as_f64().sqrt();
            let factor = <S::Vector as Vector>::Scalar::from_f64(1.0 + half_of_the_digits * drift);
            let matrix = Matrix::from_cols_fn(|j| pose.rotation().col(j) * factor);
            Posed::from_matrix(pose.shape().clone(), matrix, pose.translation()).expect("a rotation to half its digits")
        };
        posed(shapes.clone()).prop_map(drifted).boxed()
    };
    come_back(posed(shapes.clone()));
    come_back(by_matrix(0.0));
    come_back(by_matrix(0.125));
    let by = strategies::vector::<S::Vector>(Scalar::ONE);
    come_back((shapes.clone(), by).prop_map(|(shape, by)| Posed::translated(shape, by).expect("valid")).boxed());
}

fn solids_come_back<V>()
where
    V: Vector3<Matrix: Serialize + DeserializeOwned, Scalar: Serialize + DeserializeOwned>
        + Serialize
        + DeserializeOwned,
{
    come_back(strategies::cylinder::<V>(V::Scalar::ONE));
    posed_come_back(strategies::cone::<V>(V::Scalar::ONE));
    all_come_back::<V>();
}

#[test]
fn every_shape_comes_back_equal_and_answers_alike() {
    solids_come_back::<DVec3>();
    solids_come_back::<Vec3>();
    solids_come_back::<Vec3A>();
    all_come_back::<DVec2>();
    all_come_back::<Vec2>();
}

/// Data from before the errors of matrices were written is that of exact ones, and of polytopes without edges.
#[test]
fn data_without_the_errors_of_matrices_is_read() {
    let (p, q) = (DVec3::new(0.1, 0.2, 0.3), DQuat::from_xyzw(0.1, -0.7, 0.3, 0.2));
    let ball = Posed::new(Ball::<DVec3>::new(0.5).unwrap(), q, p).unwrap();
    let ellipsoid = Ellipsoid::new(p, DVec3::new(1.0, 2.0, 3.0), q).unwrap();
    let cloud = (0..40).map(|i| DQuat::from_rotation_y(f64::from(i)) * DVec3::new(1.0, 0.1 * f64::from(i), 0.2));
    let polytope = Polytope::hull_of(cloud).unwrap();
    let without = |data: &str, field: &str| {
        let mut data: Value = from_str(data).unwrap();
        assert!(data.as_object_mut().is_some_and(|fields| fields.remove(field).is_some()), "{field}");
        data
    };
    let read: Posed<Ball<DVec3>> = from_value(without(&round_trip(ball), "rotation_error")).unwrap();
    assert_eq!(read, Posed::from_matrix(*ball.shape(), ball.rotation(), p).unwrap());
    let read: Ellipsoid<DVec3> = from_value(without(&round_trip(ellipsoid), "axes_error")).unwrap();
    assert_eq!(read, Ellipsoid::from_axes(p, ellipsoid.semi_axes(), ellipsoid.axes()).unwrap());
    let read: Polytope<DVec3> = from_value(without(&round_trip(polytope.clone()), "has_edges")).unwrap();
    assert_eq!(read, Polytope::new(polytope.points().iter().copied()).unwrap());
    // An error in data is no less than that of the matrix read, or is not read.
    let with = |error: Value| {
        let mut data = serde_json::to_value(ball).unwrap();
        data["rotation_error"] = error;
        from_value::<Posed<Ball<DVec3>>>(data)
    };
    assert_eq!(with(json!(10.5)).unwrap(), ball);
    for error in [json!(-1.0), json!(1e3), json!(null)] {
        assert!(with(error.clone()).is_err(), "{error}");
    }
}

#[test]
fn shapes_survive_a_round_trip() {
    let (p, q) = (DVec3::new(0.1, 0.2, 0.3), DQuat::from_xyzw(0.1, -0.7, 0.3, 0.2));
    assert_eq!(round_trip(Ball::<DVec3>::new(0.5).unwrap()), r#"{"radius":0.5}"#);
    assert_eq!(round_trip(Cuboid::new(Vec2::new(0.5, 0.25)).unwrap()), r#"{"half_extents":[0.5,0.25]}"#);
    let cone = Cone::<DVec3>::new(0.3, 0.7).unwrap();
    round_trip(Point::new(p).unwrap());
    round_trip(Segment::new([p, -p]).unwrap());
    round_trip(Triangle::new([p, -p, DVec3::ONE]).unwrap());
    round_trip(Polytope::new([p, -p, DVec3::ONE]).unwrap());
    round_trip(Capsule::<DVec3>::new(0.3, 0.7).unwrap());
    round_trip(Cylinder::<DVec3>::new(0.3, 0.7).unwrap());
    round_trip(Ellipsoid::new(p, DVec3::new(1.0, 2.0, 1e-9), q).unwrap());
    round_trip(Posed::new(cone, q, p).unwrap());
    round_trip(Affine::new(cone, DMat3::from_cols(p, DVec3::X, p), p).unwrap());
    round_trip(Rounded::new(cone, 0.1).unwrap());
    round_trip(MinkowskiSum::new(cone, Difference::new(cone, Hull::new(cone, Point::new(p).unwrap()))));
}

#[test]
fn invalid_shapes_are_not_read() {
    let error = from_str::<Ball<DVec3>>(r#"{"radius":-1.0}"#).expect_err("a negative radius");
    assert_eq!(error.to_string(), "radius must not be negative, but is -1 at index 0");
    let mirrored = r#"{"shape":{"radius":1.0},"rotation":[-1,0,0,0,1,0,0,0,1],"translation":[0,0,0]}"#;
    let error = from_str::<Posed<Ball<DVec3>>>(mirrored).expect_err("a mirror is no pose");
    assert!(error.to_string().contains("mirrors"), "{error}");
    assert!(from_str::<Polytope<DVec3>>(r#"{"points":[]}"#).is_err(), "no points");
    assert!(from_str::<Ball<DVec3>>(r#"{"radius":1.0,"radios":2.0}"#).is_err(), "a field that means nothing");
}

#[test]
fn bounds_and_crossings_survive_a_round_trip() {
    let shape = Posed::translated(Cone::<DVec3>::new(0.3, 0.7).unwrap(), DVec3::new(0.1, 0.2, 0.3)).unwrap();
    round_trip(bounding_box(&shape));
    round_trip(bounding_sphere(&shape));
    let ball = Ball::<DVec3>::new(0.3).unwrap();
    for y in [0.1, 0.5] {
        round_trip(line_crossing(&ball, DVec3::new(-1.0, y, 0.2), DVec3::new(0.7, 0.01, -0.03)));
    }
}

#[test]
fn errors_are_written() {
    let error = InvalidShape::NonFinite { parameter: "radius", index: 0 };
    assert_eq!(to_string(&error).unwrap(), r#"{"NonFinite":{"parameter":"radius","index":0}}"#);
}
