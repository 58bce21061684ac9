//! The Euclidean distance and its certificate.

use crate::common::{ellipsoid2, ellipsoid3};
use convex_support::glam::{DMat3, DQuat, DVec2, DVec3};
use convex_support::{Ellipsoid, SupportMap, Vector, support_value};
use ellip_margin::{MarginOptions, Status, distance, distance_bracket, free_margin, scaling};
use proptest::prelude::*;

/// The bracket, checked from nothing but support maps: a slab between the bodies, and a point of each.
fn check<V: Vector<Scalar = f64>>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, width: f64) {
    let o = MarginOptions::default();
    let d = distance(e1, e2, o);
    let rough = distance_bracket(e1, e2, o);
    if free_margin(e1, e2, o).margin <= 0.0 {
        assert_eq!((d.distance, d.bracket.lower, d.bracket.upper), (0.0, 0.0, 0.0), "overlapping");
        return;
    }
    assert_eq!(d.status, Status::Converged, "{e1:?} {e2:?}: {d:?}");
    for bracket in [d.bracket, rough] {
        assert!(bracket.lower <= d.distance && d.distance <= bracket.upper, "{bracket:?} holds {}", d.distance);
        let n = bracket.normal;
        let slab = -(support_value(&e1, n) + support_value(&e2, -n));
        let size = e1.core().extent + e2.core().extent + e1.center().norm() + e2.center().norm();
        assert!(bracket.lower <= slab + 1e-14 * size, "a slab of width {slab}, not {}", bracket.lower);
        for (e, p) in [(e1, bracket.point1), (e2, bracket.point2)] {
            let u = e.axes().transpose_mul_of(p - e.center());
            let norm = V::from_fn(|i| u.get(i) / e.semi_axes().get(i)).norm();
            assert!(norm <= 1.0 + 1e-9, "{p:?} is a point of the body: {norm}");
        }
        let apart = (bracket.point2 - bracket.point1).norm();
        assert!((apart - bracket.upper).abs() <= 1e-12 * bracket.upper + 1e-14 * size, "{apart} {}", bracket.upper);
    }
    assert!(d.bracket.upper - d.bracket.lower <= width * d.distance, "{:?}", d.bracket);
    let s = scaling(e1, e2, o);
    assert!(s.scale > 1.0 && s.separation <= d.distance * (1.0 + 1e-10), "{s:?} for {}", d.distance);
}

trait TransposeMulOf: convex_support::Matrix {
    fn transpose_mul_of(&self, v: Self::Vector) -> Self::Vector {
        self.transpose_mul(v)
    }
}
impl<M: convex_support::Matrix> TransposeMulOf for M {}

proptest! {
    #![proptest_config(convex_support::laws::config(500))]

    #[test]
    fn certified_in_space(e1 in ellipsoid3(2.0, 2.0), e2 in ellipsoid3(2.0, 2.0)) {
        check(&e1, &e2, 1e-11);
    }

    #[test]
    fn certified_in_the_plane(e1 in ellipsoid2(2.0, 2.0), e2 in ellipsoid2(2.0, 2.0)) {
        check(&e1, &e2, 1e-11);
    }

    /// However thin the bodies are, the distance is found to its last digits, in a few steps.
    #[test]
    fn converges_at_any_aspect(e1 in ellipsoid3(7.0, 2.0), e2 in ellipsoid3(7.0, 2.0), f1 in ellipsoid2(7.0, 2.0), f2 in ellipsoid2(7.0, 2.0)) {
        fn converges<V: Vector<Scalar = f64>>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> Result<(), TestCaseError> {
            let d = distance(e1, e2, MarginOptions::default());
            if d.distance > 1e-6 {
                prop_assert_eq!(d.status, Status::Converged, "{:?} {:?}: {:?}", e1, e2, d);
                prop_assert!(d.bracket.upper - d.bracket.lower <= 1e-8 * d.distance, "{:?}", d);
                prop_assert!(d.iterations <= 56, "{:?}", d);
            }
            Ok(())
        }
        converges(&e1, &e2)?;
        converges(&f1, &f2)?;
    }

    /// Whatever ends the iteration, the bracket holds.
    #[test]
    fn bracket_at_any_aspect(e1 in ellipsoid3(7.0, 2.0), e2 in ellipsoid3(7.0, 2.0), steps in 0usize..20) {
        let full = distance(&e1, &e2, MarginOptions::default());
        let short = distance(&e1, &e2, MarginOptions::default().with_max_iterations(steps));
        prop_assert!(short.bracket.lower <= full.bracket.upper && full.bracket.lower <= short.bracket.upper);
        prop_assert!(full.bracket.lower <= full.bracket.upper, "{:?} after {} steps", full, steps);
    }
}

#[test]
fn spheres() {
    let ball =
        |x: f64, r: f64| Ellipsoid::new(DVec3::new(x, 0.0, 0.0), DVec3::splat(r), DQuat::IDENTITY).expect("valid");
    let d = distance(&ball(0.0, 1.0), &ball(5.0, 2.0), MarginOptions::default());
    assert!((d.distance - 2.0).abs() < 1e-15 && d.bracket.point1.abs_diff_eq(DVec3::X, 1e-15), "{d:?}");
    assert_eq!(distance(&ball(0.0, 1.0), &ball(2.5, 2.0), MarginOptions::default()).distance, 0.0, "overlapping");
}

/// A point and an ellipse: the foot of the perpendicular from (0, 3) to x²/4 + y² = 1 is (0, 1).
#[test]
fn projection_of_a_point() {
    let point = Ellipsoid::new(DVec2::new(0.0, 3.0), DVec2::splat(1e-12), 0.0).expect("valid");
    let ellipse = Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 1.0), 0.0).expect("valid");
    let d = distance(&point, &ellipse, MarginOptions::default());
    assert!((d.distance - 2.0).abs() < 1e-11 && d.bracket.point2.abs_diff_eq(DVec2::Y, 1e-6), "{d:?}");
}

/// Whatever a margin may spend, and where its numbers leave the range, what is told about the distance holds: that
/// bodies overlap is not taken from a margin that was cut short, which is too small.
#[test]
fn an_overlap_is_not_taken_from_a_margin_cut_short() {
    // A needle beside a plate, apart by a quarter of the needle's length; two steps of the margin say −0.02.
    let axes = |rows: [[f64; 3]; 3]| DMat3::from_cols_array_2d(&rows);
    let needle = axes([
        [-0.9198735519017964, -0.23653608906932355, -0.3128631123660357],
        [0.38049460647459854, -0.73172434506242, -0.5655115713110683],
        [-0.09516566058885975, -0.6392418645636111, 0.7630945784330563],
    ]);
    let plate = axes([
        [-0.4850724400298341, -0.16046658718991413, 0.8596250358843232],
        [0.8743677650577816, -0.07368002328046042, 0.47963763988791625],
        [-0.013628622504215204, 0.9842874217244737, 0.1760469598818033],
    ]);
    let semi_axes = DVec3::new(0.0032805569956361187, 0.008920946187466272, 0.12429488691574167);
    let e1 = Ellipsoid::from_axes(DVec3::ZERO, semi_axes, needle).expect("valid");
    let center = DVec3::new(0.0002509507572426451, 0.04357948361000439, 0.09696189523737284);
    let semi_axes = DVec3::new(0.10530396076622422, 0.12429488691574167, 0.0026101425359636036);
    let e2 = Ellipsoid::from_axes(center, semi_axes, plate).expect("valid");
    let all = distance(&e1, &e2, MarginOptions::default()).distance;
    for steps in 0..20u8 {
        let options = MarginOptions::default().with_max_iterations(steps.into());
        let rough = MarginOptions::default().with_tolerance(0.1f64.powi(i32::from(steps))).expect("positive");
        for o in [options, rough] {
            for (bracket, what) in
                [(distance_bracket(&e1, &e2, o), "bracket"), (distance(&e1, &e2, o).bracket, "distance")]
            {
                assert!(bracket.lower <= all && all <= bracket.upper, "{what}, {o:?}: {bracket:?} and {all}");
            }
        }
    }
    // So far apart that no number tells their margin, and so small beside it that their squares are none.
    for (first, second, away) in
        [(1e91, 1e-170, 1e114), (1e30, 1e30, 1e230), (1e-80, 1e-82, 1e187), (1e189, 1e85, 1e228)]
    {
        let e1 = Ellipsoid::new(DVec2::ZERO, DVec2::new(1e-6, 1.0) * first, 0.6).expect("valid");
        let e2 = Ellipsoid::new(DVec2::new(-away, away), DVec2::new(1.0, 1e-5) * second, 0.9).expect("valid");
        let o = MarginOptions::default();
        let due = away * 2f64.sqrt();
        for bracket in [distance_bracket(&e1, &e2, o), distance(&e1, &e2, o).bracket] {
            assert!(
                bracket.lower <= due && due <= bracket.upper,
                "{first:e} {second:e} {away:e}: {bracket:?} and {due:e}"
            );
        }
    }
}
