//! Both methods of casting give the same answers, within rounding, on bodies with and without a radius.

use std::fmt::Debug;

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ball, Capsule, Cuboid, Polytope, Posed, Rounded, SupportMap, support_value};
use gjk_raycast::{
    CastMethod, LinearCastOptions, Motion, Outcome, Ray, RayCastOptions, linear_cast, ray_cast, ray_cast_with,
};
use proptest::prelude::*;

fn vector(range: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-range..range).prop_map(DVec3::from_array)
}

fn rotation() -> impl Strategy<Value = DQuat> {
    prop::array::uniform4(-1.0..1.0_f64)
        .prop_filter("a quaternion", |q| q.iter().map(|x| x * x).sum::<f64>() > 0.01)
        .prop_map(|q| DQuat::from_array(q).normalize())
}

/// A shape of which nothing is known but its support mapping.
struct Own<'s>(&'s dyn Shape);

impl SupportMap for Own<'_> {
    type Vector = DVec3;

    fn support(&self, direction: DVec3) -> DVec3 {
        self.0.support(direction)
    }
}

/// A shape that proptest can print.
trait Shape: SupportMap<Vector = DVec3> + Debug {}
impl<S: SupportMap<Vector = DVec3> + Debug> Shape for S {}

fn boxed(shape: impl Shape + 'static) -> Box<dyn Shape> {
    Box::new(shape)
}

fn shape() -> impl Strategy<Value = Box<dyn Shape>> {
    const VALID: &str = "valid numbers";
    let radius = 0.01..1.0_f64;
    let core = prop_oneof![
        vector(1.0).prop_map(|h| boxed(Cuboid::new(h.abs()).expect(VALID))),
        radius.clone().prop_map(|r| boxed(Ball::new(r).expect(VALID))),
        (radius.clone(), radius.clone()).prop_map(|(h, r)| boxed(Capsule::new(h, r).expect(VALID))),
        prop::collection::vec(vector(1.0), 4..20).prop_map(|points| boxed(Polytope::new(points).expect(VALID))),
        (vector(1.0), radius)
            .prop_map(|(h, r)| { boxed(Rounded::new(Cuboid::new(h.abs()).expect(VALID), r).expect(VALID)) }),
    ];
    (core, rotation()).prop_map(|(core, q)| boxed(Posed::new(core, q, DVec3::ZERO).expect(VALID)))
}

proptest! {
    #![proptest_config(convex_support::laws::config(256))]

    #[test]
    fn rays(target in shape(), source in vector(3.0), aim in vector(1.2)) {
        let ray = Ray { source, direction: aim - source };
        let [quick, careful] = [CastMethod::Portal, CastMethod::Gjk].map(|method| {
            ray_cast(&target, ray, RayCastOptions::default().with_method(method)).expect("a finite ray")
        });
        match (quick.outcome, careful.outcome) {
            (Outcome::Hit(a), Outcome::Hit(b)) => {
                let steep = a.normal.zip(b.normal).map_or(1.0, |(a, b)| {
                    (a.dot(ray.direction).min(b.dot(ray.direction)) / ray.direction.length()).abs()
                });
                let error = (a.lambda - b.lambda).abs() * ray.direction.length();
                prop_assert!(error * steep.min(1.0) < 1e-13, "{a:?}, {b:?}");
                prop_assert!(quick.lower <= careful.upper && careful.lower <= quick.upper, "{quick:?}, {careful:?}");
            }
            (Outcome::Miss(_), Outcome::Miss(_)) => {}
            answers => prop_assert!(false, "{answers:?}"),
        }
    }

    /// Each support point is a plane before the body, and a point of it, whatever the search makes of it.
    #[test]
    fn an_observer_sees_the_bracket_narrow(target in shape(), source in vector(3.0), aim in vector(0.5)) {
        let (ray, own) = (Ray { source, direction: aim - source }, Own(&*target));
        for method in [CastMethod::Portal, CastMethod::Gjk] {
            let mut seen = Vec::new();
            let options = RayCastOptions::default().with_method(method);
            let cast = ray_cast_with(&own, ray, options, |i| seen.push((i.lower, i.upper))).expect("a finite ray");
            prop_assert!(seen.is_sorted_by(|a, b| a.0 <= b.0 && a.1 >= b.1), "{seen:?}");
            let (Some(&(lower, upper)), Outcome::Hit(hit)) = (seen.last(), cast.outcome) else { continue };
            // A thin triangle of points is crossed at a place that rounding moves.
            let known = lower <= cast.upper + 1e-11 && upper >= cast.lower - 1e-11;
            prop_assert!(known, "{lower}, {upper}: {cast:?}");
            if method == CastMethod::Gjk && hit.lambda > 0.0 {
                prop_assert!(upper - hit.lambda < 0.01, "{upper} at the end: {hit:?}");
            }
        }
    }

    #[test]
    fn motions(a in shape(), b in shape(), from in vector(4.0), aim in vector(1.5)) {
        let b = Posed::translated(b, from).expect("finite");
        let motion = Motion { velocity_a: DVec3::ZERO, velocity_b: aim - from };
        let [quick, careful] = [CastMethod::Portal, CastMethod::Gjk].map(|method| {
            linear_cast(&a, &b, motion, LinearCastOptions::default().with_method(method)).expect("a finite motion")
        });
        match (quick.outcome, careful.outcome) {
            (Outcome::Hit(p), Outcome::Hit(q)) => {
                let speed = motion.velocity_b.length();
                let steep = p.normal.map_or(1.0, |n| (n.dot(motion.velocity_b) / speed).abs());
                prop_assert!((p.time - q.time).abs() * speed * steep < 1e-13, "{p:?}, {q:?}");
                // The point of contact is one of both bodies.
                if let Some(n) = p.normal {
                    let reach = support_value(&a, -n) + n.dot(p.point);
                    prop_assert!(reach.abs() < 1e-12, "the point is {reach:e} off the surface");
                }
            }
            (Outcome::Miss(_), Outcome::Miss(_)) => {}
            answers => prop_assert!(false, "{answers:?}"),
        }
    }
}
