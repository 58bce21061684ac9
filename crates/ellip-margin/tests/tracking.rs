//! Trackers: any step gives what a cold start gives.

use crate::common::{close, ellipsoid3};
use convex_support::glam::DQuat;
use ellip_margin::{MarginOptions, MarginTracker, free_margin};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

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
