//! The laws as property tests.

use core::fmt::Debug;
use std::panic;

use convex_support::strategies::{coordinate, direction, vector};
use convex_support::{Posed, Scalar, SupportMap, Vector};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

use super::{Report, contact, linear_cast, motion_cast, pair, ray};
use crate::{LinearCastOptions, Motion, MotionCastOptions, Ray, RayCastOptions, RigidMotion, StartInContact};

/// Checks every law for pairs of the shapes of a strategy, whose size is one: apart, nearly in contact, and
/// overlapping; for rays at them, and for their motions.
///
/// The draws are those of [`config`](convex_support::laws::config): the same in every run.
///
/// # Panics
/// If a claim is false. The message names the law, the query, the options and the bodies.
pub fn hold<S: SupportMap + Debug>(cases: u32, shapes: impl Strategy<Value = S>, others: impl Strategy<Value = S>) {
    let config = ProptestConfig { failure_persistence: None, ..convex_support::laws::config(cases) };
    let space = (direction::<S::Vector>(), vector::<S::Vector>(Scalar::from_f64(3.0)), coordinate());
    let outcome = TestRunner::new(config).run(&(shapes, others, space), |(a, b, (axis, place, gap))| {
        let report = all(&a, &b, axis, place, gap);
        prop_assert!(report.broken.is_empty(), "{}", report);
        Ok(())
    });
    if let Err(error) = outcome {
        panic!("in {}: {error}", core::any::type_name::<S::Vector>());
    }
}

/// Every law, of a body placed somewhere and of the same body nearly in contact.
fn all<V: Vector>(
    a: &dyn SupportMap<Vector = V>,
    b: &dyn SupportMap<Vector = V>,
    axis: V,
    place: V,
    gap: V::Scalar,
) -> Report {
    let mut report = Report::default();
    let Ok(placed) = Posed::translated(b, place) else { return report };
    report.add(pair(a, &placed, &[axis]));
    let apart = crate::signed_distance(a, &placed, crate::SignedDistanceOptions::new());
    // To a thousandth of the drawn gap in one case, and to rounding in another.
    for part in [V::Scalar::from_f64(1e-3), V::Scalar::EPSILON] {
        let Ok(beside) = Posed::translated(&placed, apart.normal * (apart.signed_distance - gap * part)) else {
            continue;
        };
        report.add(pair(a, &beside, &[axis]));
        report.add(contact(a, &beside, V::Scalar::from_f64(0.25), &[axis]));
        let motion = Motion { velocity_a: place, velocity_b: axis };
        for start in [StartInContact::Report, StartInContact::IfDeeper] {
            let options = LinearCastOptions::new().with_start_in_contact(start);
            report.add(linear_cast(a, &beside, motion, options, &[axis]));
        }
    }
    let aim = apart.point_a;
    report.add(ray(a, Ray { source: place, direction: aim - place }, RayCastOptions::new(), &[axis]));
    let turning = RigidMotion { velocity: -place, angular_velocity: V::AngularVelocity::default(), center: aim };
    let options = MotionCastOptions::new().with_max_time(V::Scalar::ONE);
    report.add(motion_cast(a, RigidMotion::default(), &placed, turning, options, &[axis]));
    report
}
