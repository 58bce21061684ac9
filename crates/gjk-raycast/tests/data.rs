//! Answers and options as data: what is written is read back, to the last bit.
#![cfg(feature = "serde")]

use std::fmt::Debug;

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::{Ball, Cuboid, Posed, Scalar, Vector};
use gjk_raycast::{
    Body, CastMethod, Contact, DistanceOptions, HalfSpace, IntersectOptions, LinearCastOptions, Motion,
    MotionCastOptions, Pose, Ray, RayCastError, RayCastOptions, RayExit, RigidMotion, Scene, SceneError,
    SignedDistanceOptions, StartInContact, contact, distance, distance_certificate, intersects, linear_cast,
    motion_cast, ray_cast, ray_exit, signed_distance,
};
use serde_json::{from_str, to_string};

/// What the vectors and the numbers of a space must be for its options and answers to be data: data themselves.
trait Data: serde::Serialize + serde::de::DeserializeOwned {}
impl<T: serde::Serialize + serde::de::DeserializeOwned> Data for T {}

/// Writes, reads and compares, and writes again, which tells zeros of either sign apart.
#[track_caller]
fn round_trip<T: Data + PartialEq + Debug>(value: T) -> String {
    let text = to_string(&value).expect("it can be written");
    let read: T = from_str(&text).unwrap_or_else(|why| panic!("what was written can be read, but {why}: {text}"));
    assert_eq!(read, value, "{text}");
    assert_eq!(to_string(&read).expect("and written again"), text, "written again");
    text
}

fn vector<V: Vector>(x: f64, y: f64) -> V {
    V::from_fn(|i| Scalar::from_f64([x, y, 0.0][i]))
}

/// Every query between two boxes, of which the second is far away or in contact.
fn answers_of<V: Vector + Data>(x: f64)
where
    V::Scalar: Data,
    V::Rotation: Data,
    V::AngularVelocity: Data,
{
    let scalar = V::Scalar::from_f64;
    let a = Cuboid::new(vector::<V>(0.7, 0.3) + V::splat(scalar(0.1))).expect("valid");
    let b = Posed::translated(Cuboid::new(V::splat(scalar(0.9))).expect("valid"), vector::<V>(x, 0.1)).expect("valid");

    let answer = distance(&a, &b, DistanceOptions::default());
    round_trip(answer);
    round_trip(answer.gradient());
    round_trip(answer.closest_features(&a, &b).map(|features| features.smoothness()));
    round_trip(distance_certificate(&a, &b, &answer));
    round_trip(intersects(&a, &b, IntersectOptions::default()));
    let signed = signed_distance(&a, &b, SignedDistanceOptions::default());
    round_trip(signed);
    round_trip(contact(&a, &b, scalar(0.01), SignedDistanceOptions::default()));

    let ray = Ray { source: V::ZERO, direction: vector::<V>(1.0 / 3.0, 0.01) };
    round_trip(ray);
    let cast = ray_cast(&b, ray, RayCastOptions::default()).expect("finite");
    round_trip(cast);
    round_trip(cast.outcome.hit().and_then(|hit| hit.gradient(ray)));
    round_trip(ray_exit(&b, ray, RayCastOptions::default()).expect("finite"));
    for velocity_a in [vector::<V>(1.0, 0.0), vector::<V>(-1.0, 0.0)] {
        let motion = Motion { velocity_a, velocity_b: V::ZERO };
        round_trip(motion);
        let cast = linear_cast(&a, &b, motion, LinearCastOptions::default()).expect("finite");
        round_trip(cast);
        round_trip(cast.outcome.hit().and_then(|hit| {
            let [motion_a, motion_b] = motion.translations();
            hit.gradient(&motion_a, &motion_b)
        }));
        let from = Pose { rotation: V::Rotation::default(), translation: V::ZERO };
        round_trip(from);
        let going = RigidMotion::between(from, Pose { translation: velocity_a * scalar(10.0), ..from }, scalar(7.0));
        round_trip(going);
        let cast =
            motion_cast(&a, going, &b, RigidMotion::default(), MotionCastOptions::default().with_max_time(scalar(9.0)));
        round_trip(cast.expect("finite"));
    }

    let scene = Scene::new([b]).expect("finite");
    round_trip(scene.all().nearest(&a, DistanceOptions::default()));
    for direction in [ray.direction, -ray.direction] {
        round_trip(scene.all().ray_cast(Ray { direction, ..ray }, RayCastOptions::default()).expect("finite"));
        round_trip(scene.all().any_hit(Ray { direction, ..ray }, RayCastOptions::default()).expect("finite"));
    }
}

#[test]
fn answers_are_read_back() {
    for x in [7.3, 1.70001, 1.3] {
        answers_of::<DVec3>(x);
        answers_of::<DVec2>(x);
        answers_of::<Vec3>(x);
        answers_of::<Vec3A>(x);
        answers_of::<Vec2>(x);
    }
}

#[test]
fn second_derivatives_are_read_back() {
    let a = Ball::<DVec3>::new(1.0).expect("valid");
    let b = Posed::translated(Ball::new(0.3).expect("valid"), DVec3::new(0.4, 3.0, 0.1)).expect("valid");
    let features = signed_distance(&a, &b, SignedDistanceOptions::default()).closest_features(&a, &b);
    round_trip(features.hessian(DVec3::ZERO, DVec3::ZERO).expect("balls are smooth"));
    round_trip(features.velocities(RigidMotion::translation(DVec3::X), RigidMotion::default()).expect("smooth"));
}

#[test]
fn options_are_read_back() {
    let axis = DVec3::new(0.1, -0.0, 1e-300);
    round_trip(DistanceOptions::<DVec3>::default());
    round_trip(DistanceOptions::default().with_limit(0.1).with_axis(axis));
    round_trip(IntersectOptions::default().with_axis(Vec3::splat(0.1)));
    round_trip(RayCastOptions::<DVec3>::default());
    round_trip(RayCastOptions::default().with_axis(axis).with_max_lambda(f64::MAX).with_method(CastMethod::Gjk));
    round_trip(LinearCastOptions::<Vec2>::default().with_start_in_contact(StartInContact::IfDeeper));
    round_trip(MotionCastOptions::<DVec2>::default().with_target_distance(-0.0));
    round_trip(SignedDistanceOptions::<Vec3A>::default().with_depth_limit(0.1));
}

#[test]
fn what_is_left_out_of_options_has_its_default() {
    let options: RayCastOptions<DVec3> = from_str(r#"{"max_lambda":2.5}"#).expect("one option");
    assert_eq!(options, RayCastOptions::default().with_max_lambda(2.5));
    let why = from_str::<RayCastOptions<DVec3>>(r#"{"max_lamda":2.5}"#).expect_err("no such option");
    assert!(why.to_string().starts_with("unknown field `max_lamda`"), "{why}");
}

#[test]
fn numbers_that_may_be_infinite_are_null_then() {
    assert!(round_trip(RayCastOptions::<DVec3>::default()).contains(r#""max_lambda":null"#), "a ray without an end");
    let target = Ball::<DVec2>::new(1.0).expect("valid");
    let beside = Ray { source: DVec2::new(0.0, 3.0), direction: DVec2::X };
    let miss = round_trip(ray_cast(&target, beside, RayCastOptions::default()).expect("finite"));
    assert!(miss.contains(r#""upper":null"#), "{miss}");
    let miss = ray_exit(&target, beside, RayCastOptions::default()).expect("finite");
    assert_eq!((miss.lower, miss.upper), (f64::NEG_INFINITY, f64::NEG_INFINITY));
    round_trip(miss);
    // What null would not tell is not written.
    for upper in [f64::NAN, f64::INFINITY] {
        assert!(to_string(&RayExit { upper, ..miss }).is_err(), "{upper}");
    }
    assert!(to_string(&DistanceOptions::<DVec3>::default().with_limit(f64::NAN)).is_err(), "no limit, and no infinity");
    let empty: Scene<Ball<DVec2>> = Scene::new([]).expect("nothing is wrong with nothing");
    round_trip(empty.all().nearest(&target, DistanceOptions::default()));
    round_trip(empty.all().ray_cast(beside, RayCastOptions::default()).expect("finite"));
}

#[test]
fn bodies_are_checked_on_the_way_in() {
    let floor = HalfSpace::new(DVec3::new(0.1, 0.2, 0.3), -0.7).expect("valid");
    assert_eq!(round_trip(floor), r#"{"normal":[0.1,0.2,0.3],"offset":-0.7}"#);
    round_trip(Body::<Ball<DVec3>>::HalfSpace(floor));
    round_trip(Body::Convex(Ball::<Vec3>::new(0.1).expect("valid")));
    let why = from_str::<HalfSpace<DVec3>>(r#"{"normal":[0,0,0],"offset":1}"#).expect_err("no direction");
    assert!(why.to_string().starts_with("normal must have a direction"), "{why}");
}

#[test]
fn a_contact_has_one_to_four_points() {
    let a = Cuboid::new(DVec3::ONE).expect("valid");
    let b = Posed::translated(a, DVec3::Y * 1.9).expect("valid");
    let found = contact(&a, &b, 0.0, SignedDistanceOptions::default()).expect("they overlap");
    assert_eq!(found.points().len(), 4, "a face on a face");
    let mut data: serde_json::Value = from_str(&round_trip(found)).expect("an object");
    let points = data["points"].as_array_mut().expect("a list");
    points.push(points[0].clone());
    assert!(serde_json::from_value::<Contact<DVec3>>(data.clone()).is_err(), "five");
    data["points"] = serde_json::json!([]);
    assert!(serde_json::from_value::<Contact<DVec3>>(data).is_err(), "none");
}

#[test]
fn errors_are_written() {
    let error = RayCastError::NonFinite { parameter: "source", index: 2 };
    assert_eq!(to_string(&error).expect("written"), r#"{"NonFinite":{"parameter":"source","index":2}}"#);
    assert_eq!(to_string(&SceneError::NotFinite { body: 7 }).expect("written"), r#"{"NotFinite":{"body":7}}"#);
}
