//! Shapes that are none, options without bounds, and searches without steps: nothing is proved by them.

use std::cell::Cell;

use crate::common::Random;
use crate::common::behind_pointers::{distance, linear_cast, ray_cast, signed_distance};
use convex_support::glam::DVec3;
use convex_support::{Cuboid, Posed, Rounded, SupportMap};
use gjk_raycast::{
    CastMethod, DistanceOptions, LinearCastOptions, Motion, Ray, RayCastOptions, SignedDistanceOptions, contact,
};

/// A support map that lies now and then: its points are no numbers, infinite, or elsewhere.
struct Liar {
    shape: Cuboid<DVec3>,
    lie: fn(DVec3) -> DVec3,
    every: usize,
    asked: Cell<usize>,
}

impl SupportMap for Liar {
    type Vector = DVec3;

    fn support(&self, direction: DVec3) -> DVec3 {
        self.asked.set(self.asked.get() + 1);
        let point = self.shape.support(direction);
        if self.asked.get().is_multiple_of(self.every) { (self.lie)(point) } else { point }
    }
}

/// Distances told a lower bound above the upper one, which a `max` had made of NaN, and a cast put a fifth point into a
/// simplex.
#[test]
fn what_lies_now_and_then_proves_nothing() {
    let mut random = Random(5);
    let lies: [fn(DVec3) -> DVec3; 6] = [
        |_| DVec3::NAN,
        |_| DVec3::INFINITY,
        |p| -p,
        |p| p * 1.5 + DVec3::splat(0.1),
        |p| p * 1e300,
        |p| DVec3::new(p.x, f64::NAN, p.z),
    ];
    for round in 0..6000 {
        let mut liar = |lie: usize| {
            let shape = Cuboid::new(DVec3::from_array([0; 3].map(|_| random.number(0.2, 1.0)))).expect("positive");
            Liar { shape, lie: lies[lie], every: 1 + round % 9, asked: Cell::new(round % 7) }
        };
        let (a, b) = (liar(round % 6), liar(round / 6 % 6));
        let place = DVec3::from_array([0; 3].map(|_| random.number(-2.0, 2.0)));
        let a = Posed::translated(a, place).expect("finite");
        let d = distance(&a, &b, DistanceOptions::default());
        assert!(d.lower <= d.upper && d.lower >= 0.0, "{round}: {d:?}");
        let s = signed_distance(&a, &b, SignedDistanceOptions::default());
        assert!(s.lower <= s.upper, "{round}: {s:?}");
        for method in [CastMethod::Portal, CastMethod::Gjk] {
            let motion = Motion { velocity_a: -place, velocity_b: DVec3::ZERO };
            let options = LinearCastOptions::default().with_method(method);
            let cast = linear_cast(&a, &b, motion, options).expect("finite velocities");
            assert!(
                cast.outcome.hit().is_none_or(|hit| hit.time >= 0.0 && cast.lower <= cast.upper),
                "{round}: {cast:?}"
            );
            let ray = Ray { source: place, direction: -place };
            let cast = ray_cast(&b, ray, RayCastOptions::default().with_method(method)).expect("a good ray");
            assert!(
                cast.outcome.hit().is_none_or(|hit| hit.lambda >= 0.0 && cast.lower <= cast.upper),
                "{round}: {cast:?}"
            );
        }
    }
}

/// A tolerance of infinity took a plane for near that was not known yet, and told that there was no contact before
/// 0.66, which there is at 0.02.
#[test]
fn a_tolerance_without_bounds_proves_nothing_false() {
    let (a, b) = (
        Rounded::new(Cuboid::new(DVec3::new(0.5, 0.25, 0.25)).expect("positive"), 0.25).expect("positive"),
        Cuboid::new(DVec3::new(0.25, 0.5, 0.5)).expect("positive"),
    );
    let mut random = Random(6);
    for round in 0..400 {
        let place = DVec3::new(1.0 + random.number(0.01, 0.6), random.number(-0.5, 0.5), random.number(-0.5, 0.5));
        let a = Posed::translated(a, place).expect("finite");
        let motion =
            Motion { velocity_a: -place + DVec3::new(0.0, random.number(-0.3, 0.3), 0.0), velocity_b: DVec3::ZERO };
        let options = LinearCastOptions::default().with_target_distance([0.0, 0.2][round % 2]);
        let exact = linear_cast(&a, &b, motion, options).expect("finite velocities");
        for tolerance in [1e3, 1e200, f64::INFINITY, f64::NAN] {
            for axis in [DVec3::NEG_X, DVec3::X, DVec3::Y] {
                let rough = linear_cast(&a, &b, motion, options.with_tolerance(tolerance).with_axis(axis));
                let rough = rough.expect("finite velocities");
                assert!(
                    rough.lower <= exact.upper + 1e-9 && exact.lower <= rough.upper + 1e-9,
                    "{tolerance}, {axis}: {rough:?} and {exact:?}"
                );
            }
        }
    }
}

/// Nothing is known after no steps: there are no points of contact, where there had been some that were no numbers.
#[test]
fn no_steps_make_no_contact() {
    let a = Posed::translated(Cuboid::new(DVec3::ONE).expect("positive"), DVec3::new(1.5, 0.25, 0.5)).expect("finite");
    let b = Cuboid::new(DVec3::ONE).expect("positive");
    for within in [0.0, 1.0, f64::INFINITY] {
        let options = SignedDistanceOptions::default().with_max_iterations(0);
        let numbers = contact(&a, &b, within, options).is_none_or(|contact| {
            contact.points().iter().all(|p| p.point_a.is_finite() && p.signed_distance.is_finite())
        });
        assert!(numbers, "within {within}");
    }
}
