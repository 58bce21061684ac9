//! A tolerance buys iterations with digits, and keeps its word.

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Cone, Cylinder, Ellipsoid, Posed, Rounded};
use gjk_raycast::{DistanceOptions, Status, distance};

#[test]
fn a_coarser_distance_is_within_its_tolerance_and_no_dearer() {
    let cylinder = Cylinder::<DVec3>::new(0.75, 0.5).expect("valid");
    let cone = Cone::<DVec3>::new(0.75, 0.625).expect("valid");
    let cone = Posed::new(cone, DQuat::from_rotation_z(1.1), DVec3::new(1.9, 0.7, -0.4)).expect("valid");
    let ellipsoid =
        Ellipsoid::new(DVec3::new(-2.0, 1.0, 0.3), DVec3::new(1.0, 0.5, 0.1), DQuat::IDENTITY).expect("valid");
    // Grown so far that a hundredth of its distance is left: a tolerance is of that, not of the distance of the cores.
    let apart = distance(&cylinder, &ellipsoid, DistanceOptions::default()).distance;
    let rounded = Rounded::new(&ellipsoid, 0.99 * apart).expect("valid");
    let exact = [
        distance(&cylinder, &cone, DistanceOptions::default()),
        distance(&cylinder, &ellipsoid, DistanceOptions::default()),
        distance(&cylinder, &rounded, DistanceOptions::default()),
    ];
    for tolerance in [1e-1, 1e-3, 1e-6, 1e-9] {
        let options = DistanceOptions::default().with_tolerance(tolerance);
        let coarse = [
            distance(&cylinder, &cone, options),
            distance(&cylinder, &ellipsoid, options),
            distance(&cylinder, &rounded, options),
        ];
        for (coarse, exact) in coarse.iter().zip(&exact) {
            assert_eq!(coarse.status, Status::Converged, "at {tolerance}");
            assert!(coarse.upper - coarse.lower <= 1.01 * tolerance * exact.distance, "the bracket at {tolerance}");
            assert!(coarse.lower <= exact.upper && exact.lower <= coarse.upper, "the brackets meet at {tolerance}");
            assert!(coarse.iterations <= exact.iterations, "coarser is no dearer at {tolerance}");
        }
    }
}
