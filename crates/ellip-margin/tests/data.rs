//! Answers and options as data: what is written is read back, to the last bit.
#![cfg(feature = "serde")]

use convex_support::Ellipsoid;
use convex_support::glam::{DVec3, Vec3};
use ellip_margin::{Margin, MarginOptions, MarginTracker, Method, free_margin};

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
