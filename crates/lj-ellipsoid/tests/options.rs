//! Options out of their range, and at its ends.

use crate::common::Rng;
use lj_ellipsoid::{
    EnclosingError, EnclosingOptions, HalfSpace, InscribedError, InscribedOptions, MovingPoints, Status, enclosing,
    inscribed, inscribed_in_hull,
};

/// Numbers that are none, or out of their range, are errors that say so, whatever the input.
#[test]
fn numbers_out_of_range_are_errors_that_say_so() {
    let triangle = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]];
    let sides = [([1.0, 0.0], 1.0), ([-1.0, 1.0], 1.0), ([0.0, -1.0], 1.0)]
        .map(|(normal, offset)| HalfSpace { normal, offset });
    for epsilon in [f64::NAN, 0.0, -0.0, -1e-9, f64::NEG_INFINITY] {
        let why = enclosing(&triangle, EnclosingOptions::new().with_epsilon(epsilon)).unwrap_err();
        assert!(matches!(why, EnclosingError::InvalidEpsilon { .. }), "{why}");
        assert_eq!(why.to_string(), format!("epsilon must be positive, not {epsilon}"));
        let options = InscribedOptions::new().with_epsilon(epsilon);
        assert!(matches!(inscribed(&sides, options).unwrap_err(), InscribedError::InvalidEpsilon { .. }), "{epsilon}");
        let why = inscribed_in_hull(&triangle, options).unwrap_err();
        assert!(matches!(why, InscribedError::InvalidEpsilon { .. }), "{why}");
    }
    for tolerance in [f64::NAN, -1e-300, f64::NEG_INFINITY] {
        let why = enclosing(&triangle, EnclosingOptions::new().with_flat_tolerance(tolerance)).unwrap_err();
        assert!(matches!(why, EnclosingError::InvalidFlatTolerance { .. }), "{why}");
        let why = MovingPoints::new(&triangle, EnclosingOptions::new().with_flat_tolerance(tolerance)).unwrap_err();
        assert!(matches!(why, EnclosingError::InvalidFlatTolerance { .. }), "{why}");
    }
}

/// No iterations are a number of iterations: what is answered is the start, with its gap.
#[test]
fn no_iterations() {
    let none = EnclosingOptions::new().with_max_iterations(0);
    let start = enclosing(&Rng(9).normals::<3>(100), none).expect("full rank");
    assert_eq!((start.status, start.iterations), (Status::IterationLimit, 0));
    assert!(start.log_det_gap.is_finite(), "gap {}", start.log_det_gap);
}
