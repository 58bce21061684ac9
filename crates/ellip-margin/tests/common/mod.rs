//! Random ellipsoids of wild aspects, and differences of high order.

use convex_support::Ellipsoid;
use convex_support::glam::{DQuat, DVec2, DVec3};
use proptest::prelude::*;

/// A unit quaternion.
pub(crate) fn rotation() -> impl Strategy<Value = DQuat> {
    [-1.0..1.0f64, -1.0..1.0, -1.0..1.0, -1.0..1.0]
        .prop_filter("too short", |q| q.iter().map(|x| x * x).sum::<f64>() > 0.01)
        .prop_map(|q| DQuat::from_array(q).normalize())
}

/// A vector in a cube of the given half size.
pub(crate) fn within(half: f64) -> impl Strategy<Value = DVec3> {
    [-half..half, -half..half, -half..half].prop_map(DVec3::from_array)
}

/// An ellipsoid with semi-axes from 1 down to 10^-`decades`, its centre in a cube of the given half size.
pub(crate) fn ellipsoid3(decades: f64, half: f64) -> impl Strategy<Value = Ellipsoid<DVec3>> {
    (within(half), [0.0..decades, 0.0..decades, 0.0..decades], rotation()).prop_map(|(center, a, rotation)| {
        Ellipsoid::new(center, DVec3::from_array(a.map(|e| 10f64.powf(-e))), rotation).expect("valid by construction")
    })
}

/// An ellipse likewise.
pub(crate) fn ellipsoid2(decades: f64, half: f64) -> impl Strategy<Value = Ellipsoid<DVec2>> {
    ([-half..half, -half..half], [0.0..decades, 0.0..decades], -4.0..4.0f64).prop_map(|(center, a, angle)| {
        Ellipsoid::new(DVec2::from_array(center), DVec2::from_array(a.map(|e| 10f64.powf(-e))), angle)
            .expect("valid by construction")
    })
}

/// f′(0) by central differences of step h, h/2, h/4 with the errors of order h² and h⁴ extrapolated away: to about h⁶.
pub(crate) fn derivative(h: f64, f: impl Fn(f64) -> f64) -> f64 {
    let d = |h: f64| (f(h) - f(-h)) / (2.0 * h);
    let (d1, d2, d3) = (d(h), d(h / 2.0), d(h / 4.0));
    let (e1, e2) = ((4.0 * d2 - d1) / 3.0, (4.0 * d3 - d2) / 3.0);
    (16.0 * e2 - e1) / 15.0
}

/// |a − b| ≤ relative·max(|a|, |b|) + absolute
pub(crate) fn close(a: f64, b: f64, relative: f64, absolute: f64) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs()) + absolute
}
