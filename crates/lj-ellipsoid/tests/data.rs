//! Options and answers as data: what is written is read back, to the last bit, and what is invalid is not read.
#![cfg(feature = "serde")]

use std::fmt::Debug;

use lj_ellipsoid::{
    Ellipsoid, EllipsoidDyn, EnclosingError, EnclosingMethod, EnclosingOptions, FlatPolicy, HalfSpace,
    InscribedOptions, enclosing, enclosing_dyn, inscribed, inscribed_dyn, inscribed_in_hull,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, from_str, from_value, json, to_string};

/// Writes, reads and compares, and writes again, which tells zeros of either sign apart.
#[track_caller]
fn round_trip<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: &T) -> String {
    let text = to_string(value).expect("it can be written");
    let read: T = from_str(&text).unwrap_or_else(|why| panic!("what was written can be read, but {why}: {text}"));
    assert_eq!(read, *value, "{text}");
    assert_eq!(to_string(&read).expect("and written again"), text, "written again");
    text
}

/// Points that no two coordinates of are alike.
fn points<const N: usize>() -> Vec<[f64; N]> {
    (1..41u32).map(|i| std::array::from_fn(|k| (f64::from(i) * (0.7 + k as f64)).sin() / (1.0 + k as f64))).collect()
}

#[test]
fn answers_are_read_back() {
    for method in [
        EnclosingMethod::Newton,
        EnclosingMethod::Khachiyan,
        EnclosingMethod::EllipsoidAlgorithm,
        EnclosingMethod::DualReducedNewton,
    ] {
        // Those that were stopped before they had proved anything too.
        for iterations in [0, 1, 100_000] {
            let options =
                EnclosingOptions::new().with_method(method).with_max_iterations(iterations).with_epsilon(1e-3);
            round_trip(&options);
            round_trip(&enclosing(&points::<3>(), options).expect("they span the space"));
            round_trip(&enclosing_dyn(&points::<5>(), options).expect("they span the space"));
        }
    }
    for steps in [0, 1, 200] {
        let options = InscribedOptions::new().with_max_iterations(steps);
        round_trip(&options);
        round_trip(&inscribed_in_hull(&points::<2>(), options).expect("they span the plane"));
        let halfspaces = points::<3>().into_iter().map(|normal| HalfSpace { normal, offset: 1.0 }).collect::<Vec<_>>();
        round_trip(&halfspaces);
        round_trip(&inscribed(&halfspaces, options).expect("normals all around"));
        round_trip(&inscribed_dyn(&points::<4>(), &[1.0; 40], options).expect("normals all around"));
    }
    // A segment in space, and a point: semi-axes of 0.
    let flat = EnclosingOptions::new().with_flat(FlatPolicy::AffineHull);
    round_trip(&enclosing(&[[0.1, 0.2, 0.3], [0.4, 0.3, 0.1]], flat).expect("a segment"));
    round_trip(&enclosing(&[[0.1, 0.2, 0.3]], flat).expect("a point"));
}

#[test]
fn options_are_checked() {
    let read: EnclosingOptions = from_str(r#"{"epsilon":1e-3}"#).expect("the others have their defaults");
    assert_eq!(read, EnclosingOptions::new().with_epsilon(1e-3));
    let why = |text| from_str::<EnclosingOptions>(text).expect_err("not an option").to_string();
    assert!(why(r#"{"epsilon":0.0}"#).starts_with("epsilon must be positive, not 0"), "{}", why(r#"{"epsilon":0.0}"#));
    assert!(why(r#"{"flat_tolerance":-1.0}"#).starts_with("the flat tolerance must not be negative"), "negative");
    assert!(why(r#"{"epsilom":1.0}"#).starts_with("unknown field `epsilom`"), "a field that means nothing");
    assert!(from_str::<InscribedOptions>(r#"{"epsilon":-1.0}"#).is_err(), "negative");
    assert!(from_str::<HalfSpace<3>>(r#"{"normal":[1,2],"offset":0}"#).is_err(), "a normal of the plane");
}

#[test]
fn ellipsoids_are_checked() {
    let sound = enclosing(&points::<2>(), EnclosingOptions::new()).expect("they span the plane").ellipsoid;
    let data: Value = from_str(&round_trip(&sound)).expect("an object");
    for (field, value, why) in [
        ("center", json!([0.0]), "must be of one dimension"),
        ("axes", json!([[1.0, 0.0]]), "must be of one dimension"),
        ("axes", json!([[1.0, 0.0], [1.0, 0.0]]), "must be orthonormal"),
        ("semi_axes", json!([0.5, 1.0]), "the longest comes first"),
        ("semi_axes", json!([0.5, -1.0]), "must not be negative"),
        ("volume", json!(1.0), "unknown field"),
    ] {
        let mut wrong = data.clone();
        wrong[field] = value;
        let told = from_value::<Ellipsoid<2>>(wrong.clone()).expect_err(field).to_string();
        assert!(told.contains(why), "{field}: {told}");
        assert!(from_value::<EllipsoidDyn>(wrong).is_err(), "{field}");
    }
    let told = from_value::<Ellipsoid<3>>(data.clone()).expect_err("in the plane").to_string();
    assert_eq!(told, "an ellipsoid of dimension 2, not 3");
    assert_eq!(from_value::<EllipsoidDyn>(data).expect("of any dimension").center(), sound.center());
}

#[test]
fn errors_are_written() {
    let error = EnclosingError::Flat { rank: 1, dimension: 2 };
    assert_eq!(to_string(&error).expect("written"), r#"{"Flat":{"rank":1,"dimension":2}}"#);
}
