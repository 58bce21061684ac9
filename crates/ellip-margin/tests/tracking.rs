//! Trackers: any step gives what a cold start gives.

use crate::common::{close, ellipsoid3};
use convex_support::Ellipsoid;
use convex_support::glam::{DQuat, DVec3, Mat3, Vec3};
use ellip_margin::{MarginOptions, MarginTracker, free_margin};
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;

proptest! {
    #![proptest_config(convex_support::laws::config(100))]

    /// Bodies that have nothing to do with the ones before: the greatest jump there is.
    #[test]
    fn teleports(pairs in prop::collection::vec((ellipsoid3(5.0, 2.0), ellipsoid3(5.0, 2.0)), 1..20)) {
        let mut track = MarginTracker::default();
        for (e1, e2) in &pairs {
            let (warm, cold) = (track.step(e1, e2), free_margin(e1, e2, MarginOptions::default()));
            prop_assert!(close(1.0 + warm.margin, 1.0 + cold.margin, 1e-14, 0.0), "{} and {}", warm.margin, cold.margin);
            prop_assert!(close(warm.nu, cold.nu, 1e-12, 0.0), "{} and {}", warm.nu, cold.nu);
        }
        prop_assert_eq!(track.steps(), pairs.len() as u64);
    }

    /// A smooth path with quarter turns and jumps in it, through contact and through the centre of E₂.
    #[test]
    fn paths(link in ellipsoid3(1.0, 0.01), obstacle in ellipsoid3(1.0, 0.5), from in crate::common::within(3.0), to in crate::common::within(3.0)) {
        let mut track = MarginTracker::default();
        for step in 0..100 {
            let t = f64::from(step) / 99.0;
            let jump = if step % 17 == 0 { 90f64.to_radians() } else { 0.0 };
            let e1 = link.posed(DQuat::from_rotation_y(t + jump), from.lerp(to, t)).expect("finite");
            let (warm, cold) = (track.step(&e1, &obstacle), free_margin(&e1, &obstacle, MarginOptions::default()));
            let off = (warm.margin - cold.margin).abs();
            prop_assert!(off <= 1e-14 * (1.0 + cold.margin.abs()), "{} and {}", warm.margin, cold.margin);
            prop_assert!(close(warm.nu, cold.nu, 1e-11, 1e-15), "{} and {}", warm.nu, cold.nu);
        }
        prop_assert!(track.iterations() <= 500, "{} iterations", track.iterations());
    }
}

/// What the margin of one pose promises for another is kept, and is not too little to be of use.
#[test]
fn a_margin_bounds_what_it_is_after_a_motion() {
    let (mut used, mut rng) = (0.0_f64, proptest::test_runner::TestRunner::deterministic());
    let bodies = (ellipsoid3(1.0, 0.01), ellipsoid3(3.0, 0.5), crate::common::within(1.0), crate::common::within(1.0));
    for k in 0..2000 {
        let (link, obstacle, way, turn) = bodies.new_tree(&mut rng).expect("a value").current();
        let size = 0.5_f64.powi(k % 20);
        let to = link.posed(DQuat::from_scaled_axis(turn * size), way * size).expect("finite");
        let [before, after] = [&link, &to].map(|link| free_margin(link, &obstacle, MarginOptions::default()));
        let (known, after) = (before.after_motion(&link, &to), after.margin);
        assert!(-1.0 <= known && known <= after, "{known} of {before:?}, and it is {after}");
        used = used.max((known + 1.0) / (before.margin + 1.0));
    }
    assert!(used > 0.999, "a small step leaves nearly all of the margin: {used}");
    let (wide, ball) = (DVec3::new(2.0, 1.0, 1.0), Ellipsoid::new(DVec3::ZERO, DVec3::ONE, DQuat::IDENTITY));
    let (ball, other) = (ball.expect("a ball"), Ellipsoid::new(DVec3::X * 9.0, wide, DQuat::IDENTITY).expect("valid"));
    let margin = free_margin(&ball, &other, MarginOptions::default());
    assert_eq!(margin.after_motion(&ball, &other), -1.0, "another body is no motion");
}

/// A tracker that has seen a ν of 1e11 forecasts it again. Newton's first step back from there is wrong by that times
/// the rounding of the axes, and the next one goes back once more: that had been taken for the sign that no digits were
/// left, and the answer was −0.0078.
#[test]
fn a_forecast_far_above_the_root() {
    let axes1 = Mat3::from_cols(
        Vec3::new(0.6174033, 0.7061779, 0.34659192),
        Vec3::new(-0.5547862, 0.7032462, -0.44458637),
        Vec3::new(-0.5576965, 0.082204685, 0.8259643),
    );
    let axes2 = Mat3::from_cols(
        Vec3::new(0.7204018, -0.41688633, -0.55428064),
        Vec3::new(-0.5993453, -0.77636284, -0.19505352),
        Vec3::new(-0.34900776, 0.4727224, -0.80915207),
    );
    let needle = Ellipsoid::from_axes(Vec3::ZERO, Vec3::new(1.0, 0.011725279, 0.011725279), axes1).expect("valid");
    let center = Vec3::new(-0.29862517, 0.045260817, 0.23249935);
    let other = Ellipsoid::from_axes(center, Vec3::new(0.3559671, 0.39052156, 1.0), axes2).expect("valid");
    let cold = free_margin(&needle, &other, MarginOptions::default());
    assert!(cold.margin.abs() < 1e-6, "nearly touching: {cold:?}");
    for exponent in 0..20 {
        // Balls of which ν is the square of the ratio of their radii.
        let small = Ellipsoid::new(DVec3::ZERO, DVec3::splat(0.1f64.powi(exponent)), DQuat::IDENTITY).expect("valid");
        let ball = Ellipsoid::new(DVec3::X * 2.0, DVec3::ONE, DQuat::IDENTITY).expect("valid");
        let mut track = MarginTracker::default();
        for _ in 0..2 {
            assert!(close(track.step(&small, &ball).nu, 100f64.powi(exponent), 1e-12, 0.0), "10^{exponent}");
        }
        let warm = track.step(&needle, &other);
        assert_eq!((warm.margin, warm.status), (cold.margin, cold.status), "from 100^{exponent}: {warm:?}");
    }
}
