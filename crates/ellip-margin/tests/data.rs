//! Answers and options as data: what is written is read back, to the last bit.
#![cfg(feature = "serde")]

use convex_support::Ellipsoid;
use convex_support::glam::{DVec3, Vec3};
use ellip_margin::{
    EllipsoidPair, InvalidQuery, Margin, MarginOptions, MarginTracker, Method, clearance, distance, distance_bracket,
    free_margin, scaling,
};

#[test]
fn written_and_read_back() {
    let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(0.4, 0.1, 0.2), Default::default()).expect("valid");
    let obstacle = Ellipsoid::new(DVec3::new(0.3, 0.5, 0.1), DVec3::splat(0.2), Default::default()).expect("valid");
    let options = MarginOptions::default().with_method(Method::SingularBasis);
    let margin = free_margin(&link, &obstacle, options);
    let mut tracker = MarginTracker::new(options);
    let _ = tracker.step(&link, &obstacle);

    let text = serde_json::to_string(&(margin, options, tracker)).expect("numbers and names");
    let read: (Margin<DVec3>, MarginOptions, MarginTracker) = serde_json::from_str(&text).expect("as written");
    assert_eq!(read, (margin, options, tracker), "{text}");
    let options = text.replace("1e-15", "0.0");
    assert_ne!(options, text, "the tolerance is there");
    assert!(serde_json::from_str::<(Margin<DVec3>, MarginOptions, MarginTracker)>(&options).is_err(), "none is 0");

    assert!(serde_json::from_str::<Margin<Vec3>>("{}").is_err(), "a margin has fields");
}

/// Writes, reads and compares.
#[track_caller]
fn round_trip<T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug>(value: T) {
    let text = serde_json::to_string(&value).expect("it can be written");
    let read: T = serde_json::from_str(&text).unwrap_or_else(|why| panic!("it can be read, but {why}: {text}"));
    assert_eq!(read, value, "{text}");
}

#[test]
fn answers_and_derivatives_are_read_back() {
    let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(0.4, 0.1, 0.2), Default::default()).expect("valid");
    let obstacle = Ellipsoid::new(DVec3::new(0.3, 0.5, 0.1), DVec3::splat(0.2), Default::default()).expect("valid");
    let options = MarginOptions::default();
    round_trip(distance(&link, &obstacle, options));
    round_trip(distance_bracket(&link, &obstacle, options));
    round_trip(scaling(&link, &obstacle, options));
    round_trip(clearance(&[link], &[obstacle], options).expect("one of each"));
    let pair = EllipsoidPair::new(&link, &obstacle, options);
    round_trip(pair.margin().gradient());
    round_trip(pair.margin().hessian());
    round_trip(pair.margin().shape_gradient());
}

#[test]
fn options_that_are_left_out_have_their_defaults() {
    let read: MarginOptions = serde_json::from_str(r#"{"max_iterations":3}"#).expect("one option");
    assert_eq!(read, MarginOptions::default().with_max_iterations(3));
    assert!(serde_json::from_str::<MarginOptions>(r#"{"iterations":3}"#).is_err(), "an option that is none");
}

#[test]
fn errors_are_written() {
    let error = InvalidQuery::LengthsDiffer { first: 1, second: 2 };
    assert_eq!(serde_json::to_string(&error).expect("written"), r#"{"LengthsDiffer":{"first":1,"second":2}}"#);
}
