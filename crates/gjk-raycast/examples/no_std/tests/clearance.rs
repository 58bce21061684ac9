//! On a machine with a standard library: the rates are those of differences.

use gjk_raycast::convex_support::glam::Vec3;
use no_std_example::{clearance, seen_at};

#[test]
fn the_rates_are_those_of_differences() {
    const STEP: f32 = 1e-2;
    for (shoulder, elbow) in [(0.1, 0.2), (0.1, 0.9), (-0.4, 1.3), (1.4, -0.5)] {
        let here = clearance(shoulder, elbow).expect("finite");
        assert!(here.distance > 0.0 && here.at_least <= here.distance, "{here:?}");
        assert!(here.distance - here.at_least < 1e-5, "{here:?}");
        let at = |by: [f32; 2]| clearance(shoulder + by[0], elbow + by[1]).expect("finite").distance;
        for (joint, rate) in here.rates.into_iter().enumerate() {
            let by = |step| core::array::from_fn(|i| if i == joint { step } else { 0.0 });
            let difference = (at(by(STEP)) - at(by(-STEP))) / (2.0 * STEP);
            assert!((rate - difference).abs() < 1e-3, "joint {joint}: {rate} or {difference}");
        }
    }
}

#[test]
fn an_angle_that_is_none_is_an_error() {
    assert!(clearance(f32::NAN, 0.0).is_err(), "NaN");
}

#[test]
fn nothing_is_allocated() {
    let counted = allocation_counter::measure(|| {
        for step in 0..64 {
            let gap = clearance(0.1 * step as f32, 0.3).expect("finite");
            assert!(gap.at_least <= gap.distance, "{gap:?}");
        }
        let seen = seen_at(Vec3::new(0.0, 0.4, 0.0), Vec3::X).expect("finite").expect("it is in the way");
        assert!((seen - 0.35).abs() < 1e-6, "{seen}");
    });
    assert_eq!(counted.count_total, 0, "allocations");
}
