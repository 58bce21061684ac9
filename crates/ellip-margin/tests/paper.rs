//! The paper's own routes.
#![cfg(feature = "paper")]

use crate::common::{close, ellipsoid3};
use convex_support::Ellipsoid;
use convex_support::glam::{DQuat, DVec2, DVec3};
use ellip_margin::paper::InverseIterationTracker;
use ellip_margin::{InvalidQuery, MarginOptions, MarginTracker, Status, free_margin};
use proptest::prelude::*;

proptest! {
    #![proptest_config(convex_support::laws::config(100))]

    /// The paper's method gives the right margin too: where it fails it says so and falls back.
    #[test]
    fn inverse_iteration(link in ellipsoid3(0.5, 0.01), obstacle in ellipsoid3(0.5, 0.5), step in 0.0..0.5f64) {
        let mut track = InverseIterationTracker::new(1e-9, 200).expect("positive");
        for k in 0..30 {
            let t = f64::from(k) * step;
            let e1 = link.posed(DQuat::from_rotation_z(t), DVec3::new(3.0 * t.cos(), 3.0 * t.sin(), 0.3)).expect("finite");
            let (tracked, exact) = (track.step(&e1, &obstacle), free_margin(&e1, &obstacle, MarginOptions::default()));
            prop_assert!(close(1.0 + tracked.margin, 1.0 + exact.margin, 1e-6, 0.0), "{} and {}", tracked.margin, exact.margin);
        }
        prop_assert!(track.fallbacks() >= 1 && track.steps() == 30, "the first step has nothing to start from");
    }
}

/// One degree a step is within reach of inverse iteration: it never falls back after the first pose.
#[test]
fn small_steps_do_not_fall_back() {
    let obstacle = Ellipsoid::new(DVec2::new(3.0, 0.0), DVec2::new(1.0, 0.4), 0.3).expect("valid");
    let mut paper = InverseIterationTracker::new(1e-6, 40).expect("positive");
    let mut ours = MarginTracker::default();
    for k in 0..360 {
        let link = Ellipsoid::new(DVec2::ZERO, DVec2::new(1.5, 0.5), f64::from(k).to_radians()).expect("valid");
        let (a, b) = (paper.step(&link, &obstacle), ours.step(&link, &obstacle));
        assert!(close(a.margin, b.margin, 1e-4, 0.0), "{} and {} at {k} degrees", a.margin, b.margin);
    }
    assert_eq!(paper.fallbacks(), 1, "the first pose only");
    assert!(ours.iterations() < 3 * 360 && ours.iterations() < paper.iterations(), "{ours:?} {paper:?}");
}

/// C has the condition 1e32 here and no digit right, nor has a residual in terms of it: of 300 margins, 15 were wrong,
/// signs included, and called converged. What comes out now is right, by inverse iteration or by falling back.
#[test]
fn needles_of_an_aspect_of_1e8_fall_back() {
    let obstacle =
        Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 1e-8, 1e-4), DQuat::from_rotation_x(0.4)).expect("valid");
    let (mut steps, mut positive) = (0, 0);
    for start in 0..10 {
        let mut track = InverseIterationTracker::new(1e-6, 14).expect("positive");
        for k in 0..30 {
            let t = f64::from(start) * 0.7 + f64::from(k) * 0.02;
            let turn = DQuat::from_scaled_axis(DVec3::new(0.3, 1.0, 0.5) * t);
            let center = DVec3::new(0.6 * t.cos(), 0.2 * t.sin(), 0.1 * (3.0 * t).sin());
            let link = Ellipsoid::new(center, DVec3::new(1.0, 1e-8, 1e-8), turn).expect("valid");
            let (tracked, exact) =
                (track.step(&link, &obstacle), free_margin(&link, &obstacle, MarginOptions::default()));
            assert_eq!(tracked.status, Status::Converged, "{tracked:?}");
            assert!(close(1.0 + tracked.margin, 1.0 + exact.margin, 1e-6, 0.0), "{tracked:?} for {exact:?}");
            assert_eq!(tracked.margin > 0.0, exact.margin > 0.0, "the sign: {tracked:?} for {exact:?}");
            (steps, positive) = (steps + 1, positive + usize::from(exact.margin > 0.0));
        }
    }
    assert!(steps == 300 && positive > 30, "{positive} of {steps} are disjoint");
}

#[test]
fn tolerances_are_positive_numbers() {
    for tolerance in [0.0, -1e-6, f64::INFINITY] {
        let error = InverseIterationTracker::new(tolerance, 14).err();
        assert_eq!(error, Some(InvalidQuery::Tolerance(tolerance)), "{tolerance}");
    }
    assert!(InverseIterationTracker::new(f64::NAN, 14).is_err(), "NaN");
}
