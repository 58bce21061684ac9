//! The Euclidean distance and its certificate.

use crate::common::{ellipsoid2, ellipsoid3};
use convex_support::glam::{DQuat, DVec2, DVec3};
use convex_support::{Ellipsoid, SupportMap, Vector};
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
        let slab = -(e1.support_value(n) + e2.support_value(-n));
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
    #![proptest_config(ProptestConfig::with_cases(500))]

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
