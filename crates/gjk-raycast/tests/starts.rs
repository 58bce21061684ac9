//! How casts begin and end: touching, receding, sliding, inside, at rest, at the very end, and what is no cast at all.

use crate::common::behind_pointers::{distance, intersects, linear_cast, ray_cast};
use crate::common::{at, cuboid, directions, quaternion, s, ulps, v};
use convex_support::glam::{DVec2, DVec3, Vec2, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cylinder, Ellipsoid, Point, Polytope, Posed, Rounded, Scalar, ScalarOf, SupportMap, Vector,
    Vector3, support_value,
};
use gjk_raycast::{
    CastMethod, DistanceOptions, IntersectOptions, LinearCastOptions, Motion, Outcome, Ray, RayCast, RayCastError,
    RayCastOptions, Scene, SceneError, Status, SubAlgorithm, iterative_ray_cast, ray_casts,
};

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

const VALID: &str = "positive sizes";

/// Bodies that reach from −1 to 1 along x, and have no other point at either end; with those, hits are known.
fn bodies<V: Vector3>() -> Vec<(&'static str, Shape<V>)> {
    let n = s::<V>;
    let upright = quaternion::<V>([0.0, 0.0, -0.5_f64.sqrt(), 0.5_f64.sqrt()]);
    let unturned = quaternion::<V>([0.0, 0.0, 0.0, 1.0]);
    let octahedron =
        [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    vec![
        ("ball", Box::new(Ball::<V>::new(n(1.0)).expect(VALID))),
        ("cuboid", Box::new(cuboid::<V>([1.0, 0.5, 0.25]))),
        ("cylinder", Box::new(Cylinder::<V>::new(n(0.5), n(1.0)).expect(VALID))),
        // Lying down, its apex at x = 1.
        (
            "cone",
            Box::new(Posed::new(Cone::<V>::new(n(1.0), n(0.5)).expect(VALID), upright, V::ZERO).expect("a rotation")),
        ),
        ("capsule", Box::new(Capsule::<V>::new(n(0.25), n(1.0)).expect(VALID))),
        ("ellipsoid", Box::new(Ellipsoid::new(V::ZERO, v::<V>([1.0, 0.5, 0.25]), unturned).expect(VALID))),
        ("rounded", Box::new(Rounded::new(cuboid::<V>([0.75, 0.5, 0.25]), n(0.25)).expect(VALID))),
        ("octahedron", Box::new(Polytope::new(octahedron.map(v::<V>)).expect("finite"))),
    ]
}

fn cast<V: Vector>(target: &Shape<V>, source: [f64; 3], direction: [f64; 3], end: V::Scalar) -> RayCast<V> {
    let ray = Ray { source: v(source), direction: v(direction) };
    ray_cast(target, ray, RayCastOptions::new().with_max_lambda(end)).expect("a finite ray with a direction")
}

fn contains<V: Vector>(body: &Shape<V>, point: [f64; 3]) -> bool {
    let point = Point::new(v::<V>(point)).expect("finite");
    intersects(body, &point, IntersectOptions::default()).overlap
}

fn both(single: impl FnOnce(), double: impl FnOnce()) {
    single();
    double();
}

fn infinity<V: Vector>() -> V::Scalar {
    s::<V>(f64::INFINITY)
}

/// In the body, or on its boundary to rounding: a hit at 0 without a normal, whatever the direction.
#[test]
fn inside_and_touching_is_a_hit_at_zero() {
    fn run<V: Vector3>() {
        for (name, body) in bodies::<V>() {
            let surface = [[0.0; 3], [0.3, 0.02, -0.01], [1.0, 0.0, 0.0], [1.0 - ulps::<V>(1.0), 0.0, 0.0]];
            for source in surface {
                for d in directions(30).chain([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]) {
                    let answer = cast(&body, source, d, infinity::<V>());
                    let hit = answer.outcome.hit().unwrap_or_else(|| panic!("{name} {source:?} {d:?}: {answer:?}"));
                    assert_eq!((hit.lambda.as_f64(), hit.normal), (0.0, None), "{name} {source:?} {d:?}");
                    // Where known points are on two sides of the source, or the ray goes in, that is certain to a few
                    // ulps across the surface; at an apex or a corner, across any plane that supports it there. A ray
                    // that goes away from the boundary may begin outside.
                    let across = match name {
                        "cone" => 1e5,
                        "octahedron" => 1e3,
                        _ => 100.0,
                    };
                    let later = std::array::from_fn(|i| source[i] + d[i] / 64.0);
                    let goes_away = source[0] > 0.5 && !contains(&body, later);
                    let upper = if goes_away { f64::INFINITY } else { ulps::<V>(across) / d[0].abs() };
                    assert_eq!(answer.lower.as_f64(), 0.0, "{name} {source:?} {d:?}: {answer:?}");
                    assert!(answer.upper.as_f64() <= upper, "{name} {source:?} {d:?}: {answer:?}");
                }
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// Outside by a thousandth, and away from the body or past it: a miss, at every distance.
#[test]
fn receding_and_sliding_rays_miss() {
    fn run<V: Vector3>() {
        for (name, body) in bodies::<V>() {
            for x in [1.001, 1.5, 1e3, 1e6] {
                for d in directions(40) {
                    let away = [d[0].abs(), d[1], d[2]];
                    for (what, direction) in [("receding", away), ("sliding", [0.0, d[1], d[2] + 1e-3])] {
                        let answer = cast(&body, [x, 0.0, 0.0], direction, infinity::<V>());
                        assert!(answer.outcome.is_miss(), "{what}: {name} {x} {direction:?}: {answer:?}");
                    }
                }
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// A graze within rounding may be either, but is one of both, and at the place of the graze.
#[test]
fn a_graze_is_decided() {
    fn run<V: Vector3>() {
        for (name, body) in bodies::<V>() {
            for i in -4..=4 {
                let x = 1.0 + ulps::<V>(f64::from(i));
                for d in [[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.6, 0.8]] {
                    let answer = cast(&body, [x, -3.0 * d[1], -3.0 * d[2]], d, infinity::<V>());
                    assert_ne!(answer.outcome, Outcome::Undecided, "{name} {i} {d:?}: {answer:?}");
                    if let Some(hit) = answer.outcome.hit() {
                        assert!((0.0..=4.0).contains(&hit.lambda.as_f64()), "{name} {i} {d:?}: {answer:?}");
                    }
                }
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// The end of the ray at the hit belongs to the ray: two ulps less is no hit, and what reaches is one.
#[test]
fn the_end_at_the_hit() {
    fn run<V: Vector3>() {
        for (name, body) in bodies::<V>() {
            for source in [[3.0, 0.0, 0.0], [5.0, 0.25, -0.125]] {
                let direction = [-1.0, 0.0, 0.0];
                let free = cast(&body, source, direction, infinity::<V>()).outcome.hit();
                let Some(hit) = free else { continue };
                let lambda = hit.lambda.as_f64();
                for (ulp, reaches) in [(-64.0, false), (-2.0, false), (0.0, true), (2.0, true)] {
                    let answer = cast(&body, source, direction, s::<V>(lambda * (1.0 + ulps::<V>(ulp))));
                    assert_eq!(answer.outcome.hit().is_some(), reaches, "{name} {source:?} {ulp} ulp: {answer:?}");
                    // Two ulps may be within the rounding of a curved body's gap, so that a miss is not certain.
                    let is_certain = answer.outcome.is_miss() || reaches || ulp > -64.0;
                    assert!(is_certain, "{name} {source:?} {ulp} ulp: {answer:?}");
                }
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// The same of moving bodies: the one starts beside the other, and closes, recedes, slides, or rests.
#[test]
fn motions_begin_as_rays_do() {
    fn run<V: Vector3>() {
        for (name, body) in bodies::<V>() {
            let cast = |x: f64, velocity: [f64; 3], end: f64| {
                let other = at(cuboid::<V>([1.0, 2.0, 2.0]), [x, 0.0, 0.0]);
                let motion = Motion { velocity_a: V::ZERO, velocity_b: v(velocity) };
                let options = LinearCastOptions::new().with_max_time(s::<V>(end));
                linear_cast(&body, &other, motion, options).expect("finite velocities")
            };
            let forever = f64::INFINITY;
            for x in [0.5, 1.5, 2.0, 2.0 - ulps::<V>(1.0)] {
                for velocity in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]] {
                    for end in [0.0, forever] {
                        let answer = cast(x, velocity, end);
                        let hit = answer.outcome.hit().unwrap_or_else(|| panic!("{name} {x} {velocity:?}: {answer:?}"));
                        assert_eq!(hit.time.as_f64(), 0.0, "{name} {x} {velocity:?}");
                        // Where they only touch there is a normal.
                        let touches = x > 1.9;
                        let is_right = hit.normal.is_none_or(|n| touches && n.get(0).as_f64() < 0.0);
                        assert!(is_right, "{name} {x} {velocity:?}: {answer:?}");
                    }
                }
            }
            for gap in [1e-3, 1.0] {
                assert!(cast(2.0 + gap, [1.0, 0.0, 0.0], forever).outcome.is_miss(), "{name} recedes from {gap}");
                assert!(cast(2.0 + gap, [0.0, 1.0, 0.0], forever).outcome.is_miss(), "{name} slides at {gap}");
                assert!(cast(2.0 + gap, [0.0; 3], forever).outcome.is_miss(), "{name} rests at {gap}");
                assert!(cast(2.0 + gap, [-1.0, 0.0, 0.0], 0.5 * gap).outcome.is_miss(), "{name} stops short at {gap}");
                let closing = cast(2.0 + gap, [-1.0, 0.0, 0.0], forever).outcome.hit().expect("it closes");
                assert!((closing.time.as_f64() - gap).abs() < ulps::<V>(32.0), "{name} {gap}: {closing:?}");
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// What is no ray is an error that names the coordinate.
#[test]
fn bad_rays_are_errors() {
    fn run<V: Vector3>() {
        let body = cuboid::<V>([1.0; 3]);
        let cast = |source: [f64; 3], direction: [f64; 3]| {
            ray_cast(&body, Ray { source: v::<V>(source), direction: v(direction) }, RayCastOptions::default())
        };
        assert_eq!(cast([0.0; 3], [0.0; 3]), Err(RayCastError::ZeroDirection));
        assert_eq!(cast([5.0, 0.0, 0.0], [0.0, -0.0, 0.0]), Err(RayCastError::ZeroDirection));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let source = cast([0.0, bad, 0.0], [1.0, 0.0, 0.0]);
            assert_eq!(source, Err(RayCastError::NonFinite { parameter: "source", index: 1 }));
            let direction = cast([0.0; 3], [1.0, 0.0, bad]);
            assert_eq!(direction, Err(RayCastError::NonFinite { parameter: "direction", index: 2 }));
            let motion = Motion { velocity_a: v::<V>([bad, 0.0, 0.0]), velocity_b: V::ZERO };
            let moving = linear_cast(&body, &body, motion, LinearCastOptions::default());
            assert_eq!(moving, Err(RayCastError::NonFinite { parameter: "velocity_a", index: 0 }));
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// A user's support map that answers NaN or infinity: always, or from some call on.
struct Broken<V: Vector> {
    bad: V,
    /// The half-space of directions in which it is broken; all of them if zero.
    from: V,
}

impl<V: Vector> SupportMap for Broken<V> {
    type Vector = V;

    fn support(&self, direction: V) -> V {
        let zero = ScalarOf::<Self>::ZERO;
        if self.from == V::ZERO || direction.dot(self.from) > zero {
            self.bad
        } else {
            direction.unit().unwrap_or(V::ZERO)
        }
    }
}

/// Every query ends, with a status, in space and in the plane, whichever way its steps are taken.
#[test]
fn a_broken_support_map_ends_with_a_status() {
    fn ask<V: Vector>(broken: &Broken<V>, sub_algorithm: SubAlgorithm, method: CastMethod) {
        let told = format!("{:?} {:?} {sub_algorithm:?} {method:?}", broken.bad, broken.from);
        let cube = at(cuboid::<V>([1.0; 3]), [0.5, 3.0, 0.25]);
        let apart = distance(broken, &cube, DistanceOptions::new().with_sub_algorithm(sub_algorithm));
        assert!(apart.iterations <= 200 && !apart.distance.as_f64().is_nan(), "{told}: {apart:?}");
        let meets = intersects(&cube, broken, IntersectOptions::new().with_sub_algorithm(sub_algorithm));
        assert!(meets.iterations <= 200, "{told}: {meets:?}");
        let ray = Ray { source: v::<V>([0.2, 5.0, 0.1]), direction: v([0.0, -1.0, 0.0]) };
        let options = RayCastOptions::new().with_sub_algorithm(sub_algorithm).with_method(method);
        let cast = ray_cast(broken, ray, options).expect("a finite ray");
        assert!(cast.iterations <= 200, "{told}: {cast:?}");
        let motion = Motion { velocity_a: v::<V>([0.0, 1.0, 0.0]), velocity_b: V::ZERO };
        let options = LinearCastOptions::new().with_sub_algorithm(sub_algorithm).with_method(method);
        let sweep = linear_cast(broken, &cube, motion, options).expect("finite");
        assert!(sweep.iterations <= 400, "{told}: {sweep:?}");
        if broken.from == V::ZERO {
            assert_ne!(apart.status, Status::Converged, "{told}: {apart:?}");
            assert_eq!(meets.decided(), None, "{told}: {meets:?}");
            assert_eq!(cast.outcome, Outcome::Undecided, "{told}: {cast:?}");
            assert_eq!(sweep.outcome, Outcome::Undecided, "{told}: {sweep:?}");
        }
    }
    fn run<V: Vector>() {
        use SubAlgorithm::{Johnson, NearestFace, Regions, SignedVolumes};
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for bad in [[bad, 0.0, 0.0], [0.0, bad, 0.0], [bad; 3]] {
                for from in directions(20).chain([[0.0; 3]]) {
                    for sub_algorithm in [Regions, NearestFace, Johnson, SignedVolumes] {
                        for method in [CastMethod::Portal, CastMethod::Gjk] {
                            ask(&Broken { bad: v::<V>(bad), from: v(from) }, sub_algorithm, method);
                        }
                    }
                }
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
    both(run::<Vec2>, run::<DVec2>);
}

/// So do many rays against one such body, and Algorithm 1 with closest points that are none; a scene refuses the body.
#[test]
fn a_broken_body_spoils_no_batch() {
    fn run<V: Vector + 'static>() {
        let rays: Vec<_> = (0..20)
            .map(|i| Ray { source: v::<V>([0.1 * f64::from(i) - 1.0, 5.0, 0.1]), direction: v([0.0, -1.0, 0.0]) })
            .collect();
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let broken = Broken { bad: v::<V>([0.0, bad, 0.0]), from: V::ZERO };
            for cast in ray_casts(&broken, &rays, RayCastOptions::default()) {
                assert_eq!(cast.expect("a finite ray").outcome, Outcome::Undecided, "{bad}");
            }
            let bodies = [Box::new(at(cuboid::<V>([2.0, 1.0, 1.0]), [0.0; 3])) as Shape<V>, Box::new(broken)];
            // A scene names the body that it cannot find a box for.
            assert_eq!(Scene::new(bodies).err(), Some(SceneError::NotFinite { body: 1 }), "{bad}");
            for &ray in &rays {
                let closest = iterative_ray_cast(|_| Some(v::<V>([bad; 3])), ray, RayCastOptions::default());
                assert_eq!(closest.expect("a finite ray").outcome, Outcome::Undecided, "{bad}");
                let sometimes = |x: V| Some(if x.get(1).as_f64() < 4.0 { v::<V>([bad; 3]) } else { V::ZERO });
                let closest = iterative_ray_cast(sometimes, ray, RayCastOptions::default());
                assert!(closest.expect("a finite ray").iterations <= 200, "{bad}");
            }
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
    both(run::<Vec2>, run::<DVec2>);
}

/// A point is the smallest body. A ray through it grazes it, and is decided; one that passes it by misses.
#[test]
fn a_point_is_missed_where_it_is_not() {
    fn run<V: Vector3>() {
        let point: Shape<V> = Box::new(Point::new(v::<V>([2.0, 1.0, -1.0])).expect("finite"));
        for d in directions(50) {
            let source = [2.0 - 3.0 * d[0], 1.0 - 3.0 * d[1], -1.0 - 3.0 * d[2]];
            let through = cast(&point, source, d, infinity::<V>());
            assert_ne!(through.outcome, Outcome::Undecided, "{d:?}: {through:?}");
            if let Some(hit) = through.outcome.hit() {
                assert!((hit.lambda.as_f64() - 3.0).abs() < ulps::<V>(16.0), "{d:?}: {hit:?}");
            }
            assert!(cast(&point, source, d.map(|c| -c), infinity::<V>()).outcome.is_miss(), "away: {d:?}");
            let beside = [source[0] + 1e-3 * d[1], source[1] - 1e-3 * d[0], source[2] + 1e-3];
            assert!(cast(&point, beside, d, infinity::<V>()).outcome.is_miss() || d[2].abs() > 0.99, "past: {d:?}");
        }
    }
    both(run::<Vec3A>, run::<DVec3>);
}

/// A hit ahead has a normal, and one that supports the shape there: also of a point, of a needle met by its end, of a
/// plate met by its rim, and of the vertex that reaches as far as the ball about the shape, where no plane is crossed
/// on the way.
#[test]
fn a_hit_ahead_has_a_normal() {
    fn run<V: Vector>() {
        let clouds: [&[[f64; 3]]; 4] = [
            &[[2.0, 2.0, 2.0]],
            &[[0.0, 0.0, 0.0], [2.0, 1.0, -1.0]],
            &[[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [1.0, -2.0, 0.0]],
            &[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]],
        ];
        let mut hits = 0;
        for cloud in clouds {
            let points = || cloud.iter().map(|&p| v::<V>(p));
            let body = Polytope::new(points()).expect("finite");
            for through in points() {
                for i in 0..125 {
                    let direction = v::<V>([i / 25, i / 5 % 5, i % 5].map(|c| f64::from(c) - 2.0));
                    if direction == V::ZERO {
                        continue;
                    }
                    let ray = Ray { source: through - direction * s::<V>(2.0), direction };
                    for method in [CastMethod::Portal, CastMethod::Gjk] {
                        let cast = ray_cast(&body, ray, RayCastOptions::new().with_method(method)).expect("finite");
                        let Some(hit) = cast.outcome.hit().filter(|hit| hit.lambda.as_f64() > 0.0) else { continue };
                        let n = hit.normal.unwrap_or_else(|| panic!("{cloud:?} {ray:?}: {cast:?}"));
                        assert!(n.dot(direction).as_f64() < ulps::<V>(16.0), "{cloud:?} {ray:?}: {cast:?}");
                        let beyond = support_value(&body, n) - n.dot(hit.point);
                        assert!(beyond.as_f64() < ulps::<V>(64.0), "{cloud:?} {ray:?}: {cast:?}");
                        hits += 1;
                    }
                }
            }
        }
        assert!(hits > 1000, "{hits}");
    }
    both(run::<Vec3A>, run::<DVec3>);
    both(run::<Vec2>, run::<DVec2>);
}

/// Rounded boxes that are apart by less than single precision tells, and rest: no later time is known at which they
/// have met.
#[test]
fn what_rests_beside_another_has_no_time_of_contact() {
    let rounded = |sizes: [f64; 2], radius: f64| {
        Rounded::new(cuboid::<Vec2>([sizes[0], sizes[1], 0.0]), s::<Vec2>(radius)).expect(VALID)
    };
    let a = rounded([0.200_000_003, 0.990_502_5], 0.200_000_003);
    let b = at(rounded([0.200_000_003, 0.200_000_003], 0.137_976_66), [0.737_976_85, 0.0, 0.0]);
    let cast = linear_cast(&a, &b, Motion::default(), LinearCastOptions::new()).expect("finite");
    assert!(cast.upper == 0.0 || cast.upper == f32::INFINITY, "{cast:?}");
}

/// What rests deep in another, its middle on the other's to the last bit, has met it, and that is certain.
#[test]
fn what_rests_deep_in_another_meets_it_at_once() {
    let (cube, cylinder) = (cuboid::<DVec3>([1.0; 3]), Cylinder::<DVec3>::new(1.0, 1.0).expect(VALID));
    let at_rest = |a: &dyn SupportMap<Vector = DVec3>, b: &dyn SupportMap<Vector = DVec3>| {
        linear_cast(&a, &b, Motion::default(), LinearCastOptions::new()).expect("finite")
    };
    for cast in [at_rest(&cube, &cube), at_rest(&cube, &cylinder), at_rest(&cylinder, &cylinder)] {
        assert_eq!((cast.lower, cast.upper), (0.0, 0.0), "{cast:?}");
    }
}
