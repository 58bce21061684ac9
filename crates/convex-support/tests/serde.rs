//! Shapes survive being written and read, to the last bit, and invalid ones are not read.

use convex_support::glam::{DMat3, DQuat, DVec3, Vec2};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Difference, Ellipsoid, Hull, InvalidShape, MinkowskiSum, Point,
    Polytope, Posed, Rounded, Segment, Triangle, bounding_box, bounding_sphere, line_crossing,
};
use serde_json::{from_str, to_string};

/// Writes, reads and compares what is written again; returns it. A pose is read as its matrix, which is then exact.
fn round_trip<S>(shape: S) -> String
where
    S: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
{
    let text = to_string(&shape).expect("every shape can be written");
    let read = from_str::<S>(&text).expect("what was written can be read");
    assert_eq!(to_string(&read).expect("and written again"), text, "written again");
    assert_eq!(from_str::<S>(&text).expect("and read again"), read, "{text}");
    text
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
