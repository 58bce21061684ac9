//! Options that say nothing sensible: NaN, infinities where there are none, ends before the beginning, guesses that
//! are no directions.

use convex_support::glam::DVec3;
use convex_support::{Ball, Capsule, Cuboid, Posed};
use gjk_raycast::{
    DistanceOptions, HalfSpace, IntersectOptions, LinearCastOptions, Motion, MotionCastOptions, Outcome, Ray,
    RayCastError, RayCastOptions, RigidMotion, Scene, SignedDistanceOptions, Status, contact, distance, intersects,
    iterative_ray_cast, linear_cast, motion_cast, ray_cast, ray_exit, signed_distance,
};

type Rounded = Posed<Capsule<DVec3>>;
type Block = Posed<Cuboid<DVec3>>;

const NAN: f64 = f64::NAN;
const ALONG: Ray<DVec3> = Ray { source: DVec3::ZERO, direction: DVec3::X };
const BESIDE: Ray<DVec3> = Ray { source: DVec3::new(0.0, 9.0, 0.0), direction: DVec3::X };

fn rounded(x: f64) -> Rounded {
    Posed::translated(Capsule::new(1.0, 0.5).expect("valid"), DVec3::X * x).expect("finite")
}

fn block(x: f64) -> Block {
    Posed::translated(Cuboid::new(DVec3::new(1.0, 2.0, 3.0)).expect("valid"), DVec3::X * x).expect("finite")
}

fn floor() -> HalfSpace<DVec3> {
    HalfSpace::new(DVec3::NEG_X, -8.0).expect("valid")
}

fn scene(bodies: impl IntoIterator<Item = Block>) -> Scene<Block> {
    Scene::new(bodies).expect("finite")
}

fn refused<T>(parameter: &'static str) -> Result<T, RayCastError> {
    Err(RayCastError::NonFinite { parameter, index: 0 })
}

/// A comparison with NaN is as false as its opposite. So a cast took an end of NaN for none: `linear_cast` answered
/// hits after a `max_time` that the caller had computed wrongly. Every cast refuses it now, whatever it would have
/// found, and wherever it is asked.
#[test]
fn casts_refuse_options_of_nan() {
    let with = RayCastOptions::new;
    let rays = [("min_lambda", with().with_min_lambda(NAN)), ("max_lambda", with().with_max_lambda(NAN))];
    for (parameter, options) in rays {
        for ray in [ALONG, BESIDE] {
            let ball = Ball::new(1.0).expect("valid");
            assert_eq!(ray_cast(&block(5.0), ray, options), refused(parameter));
            assert_eq!(ray_cast(&rounded(5.0), ray, options), refused(parameter), "a closed form");
            assert_eq!(ray_exit(&block(5.0), ray, options), refused(parameter));
            assert_eq!(iterative_ray_cast(|x| Some(x.clamp_length_max(1.0)), ray, options), refused(parameter));
            assert_eq!(ray_cast(&ball, ray, options), refused(parameter), "a source inside");
            assert_eq!(floor().ray_cast(ray, options), refused(parameter));
            for bodies in [vec![], vec![block(5.0)]] {
                assert_eq!(scene(bodies).all().ray_cast(ray, options), refused(parameter));
            }
            assert_eq!(scene([block(5.0)]).all().ray_cast_all(ray, options, &mut Vec::new()), refused(parameter));
            assert_eq!(scene([block(5.0)]).all().any_hit(ray, options), refused(parameter));
        }
    }
    let with = LinearCastOptions::new;
    let straight = [
        ("max_time", with().with_max_time(NAN)),
        ("target_distance", with().with_target_distance(NAN)),
        ("target_distance", with().with_target_distance(f64::INFINITY)),
    ];
    for (parameter, options) in straight {
        for velocity_a in [DVec3::X, DVec3::Y, DVec3::ZERO] {
            let motion = Motion { velocity_a, velocity_b: DVec3::ZERO };
            assert_eq!(linear_cast(&rounded(0.0), &block(5.0), motion, options), refused(parameter));
            assert_eq!(linear_cast(&rounded(0.0), &rounded(5.0), motion, options), refused(parameter));
            assert_eq!(floor().linear_cast(&rounded(0.0), motion, options), refused(parameter));
            for bodies in [vec![], vec![block(5.0)]] {
                assert_eq!(scene(bodies).all().linear_cast(&rounded(0.0), motion, options), refused(parameter));
            }
        }
    }
    let with = || MotionCastOptions::new().with_max_time(1.0);
    let turning = [
        ("max_time", with().with_max_time(NAN)),
        ("tolerance", with().with_tolerance(NAN)),
        ("target_distance", with().with_target_distance(NAN)),
        ("target_distance", with().with_target_distance(f64::INFINITY)),
    ];
    for (parameter, options) in turning {
        for motion in [RigidMotion::rotation(DVec3::Z, DVec3::ZERO), RigidMotion::translation(DVec3::X)] {
            let rest = RigidMotion::default();
            assert_eq!(motion_cast(&rounded(0.0), motion, &block(5.0), rest, options), refused(parameter));
            assert_eq!(floor().motion_cast(&rounded(0.0), motion, options), refused(parameter));
            assert_eq!(scene([]).all().motion_cast(&rounded(0.0), motion, options), refused(parameter));
        }
    }
}

/// What ends before it begins, or begins at infinity, has no first point, even where the bodies overlap all along.
#[test]
fn a_cast_without_time_is_a_miss() {
    for options in [
        RayCastOptions::new().with_max_lambda(-1.0),
        RayCastOptions::new().with_min_lambda(5.0).with_max_lambda(4.5),
        RayCastOptions::new().with_max_lambda(f64::NEG_INFINITY),
        RayCastOptions::new().with_min_lambda(f64::INFINITY),
    ] {
        for target in [block(0.0), block(5.0)] {
            assert!(ray_cast(&target, ALONG, options).is_ok_and(|cast| cast.outcome.is_miss()), "{options:?}");
            assert!(ray_exit(&target, ALONG, options).is_ok_and(|cast| cast.outcome.is_miss()), "{options:?}");
            let first = scene([target]).all().ray_cast(ALONG, options).expect("numbers");
            assert!(first.first.is_none() && first.undecided.is_none(), "{options:?}");
        }
        let inside = iterative_ray_cast(|x| Some(x.clamp_length_max(100.0)), ALONG, options).expect("numbers");
        assert!(inside.outcome.is_miss(), "{options:?}: {inside:?}");
        assert!(floor().ray_cast(ALONG, options).is_ok_and(|cast| cast.outcome.is_miss()), "{options:?}");
    }
    let options = LinearCastOptions::new().with_max_time(-1.0);
    for at in [0.0, 5.0] {
        let motion = Motion { velocity_a: DVec3::X, velocity_b: DVec3::ZERO };
        assert!(linear_cast(&rounded(0.0), &block(at), motion, options).is_ok_and(|cast| cast.outcome.is_miss()));
        assert!(linear_cast(&rounded(0.0), &rounded(at), motion, options).is_ok_and(|cast| cast.outcome.is_miss()));
        assert!(floor().linear_cast(&rounded(8.0), motion, options).is_ok_and(|cast| cast.outcome.is_miss()));
    }
}

/// Queries that refuse nothing take a limit of NaN for none, a tolerance of NaN or below zero for zero, and a guess
/// that is no direction for a bad guess: the answer is that of no options, or its bracket holds the truth.
#[test]
fn distances_do_not_depend_on_options_that_say_nothing() {
    for (a, b, truth) in [(rounded(0.0), block(5.0), 3.5), (rounded(0.0), block(1.0), 0.0)] {
        let plain = distance(&a, &b, DistanceOptions::new());
        for options in [
            DistanceOptions::new().with_limit(NAN),
            DistanceOptions::new().with_tolerance(NAN),
            DistanceOptions::new().with_tolerance(-1.0),
        ] {
            assert_eq!(distance(&a, &b, options), plain, "{options:?}");
        }
        let signed = signed_distance(&a, &b, SignedDistanceOptions::new());
        for options in
            [SignedDistanceOptions::new().with_limit(NAN), SignedDistanceOptions::new().with_depth_limit(NAN)]
        {
            assert_eq!(signed_distance(&a, &b, options), signed, "{options:?}");
        }
        for tolerance in [NAN, -1.0] {
            let answer = signed_distance(&a, &b, SignedDistanceOptions::new().with_tolerance(tolerance));
            let (lower, upper) = (answer.lower.max(signed.lower), answer.upper.min(signed.upper));
            assert!(lower <= upper && answer.status != Status::IterationLimit, "{answer:?} beside {signed:?}");
        }
        assert_eq!(contact(&a, &b, NAN, SignedDistanceOptions::new()), None, "NaN is nearer than nothing");
        for axis in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::splat(1e-320), DVec3::splat(1e300)] {
            let found = distance(&a, &b, DistanceOptions::new().with_axis(axis));
            assert!(found.lower <= truth && truth <= found.upper, "{axis}: {found:?}");
            assert!((found.distance - truth).abs() <= 1e-14, "{axis}: {found:?}");
            let overlap = intersects(&a, &b, IntersectOptions::new().with_axis(axis));
            assert_eq!(overlap.decided(), Some(truth == 0.0), "{axis}: {overlap:?}");
            let deep = signed_distance(&a, &b, SignedDistanceOptions::new().with_axis(axis));
            assert!((deep.signed_distance - signed.signed_distance).abs() <= 1e-8, "{axis}: {deep:?}");
        }
    }
}

/// A guess that is no direction is no guess in a cast either, and a tolerance below zero or of NaN is zero.
#[test]
fn casts_do_not_depend_on_axes_and_tolerances_that_are_none() {
    let motion = Motion { velocity_a: DVec3::X, velocity_b: DVec3::ZERO };
    for tolerance in [-1.0, NAN] {
        for target in [block(5.0), block(0.0)] {
            let cast = |options| ray_cast(&target, ALONG, options).expect("numbers");
            let plain = cast(RayCastOptions::new());
            assert_eq!(cast(RayCastOptions::new().with_tolerance(tolerance)), plain, "{tolerance}");
            let cast = |options| linear_cast(&rounded(0.0), &target, motion, options).expect("numbers");
            let plain = cast(LinearCastOptions::new());
            assert_eq!(cast(LinearCastOptions::new().with_tolerance(tolerance)), plain, "{tolerance}");
        }
    }
    for axis in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::splat(1e-320), DVec3::splat(1e300)] {
        let ray = ray_cast(&block(5.0), ALONG, RayCastOptions::new().with_axis(axis)).expect("numbers");
        assert!(matches!(ray.outcome, Outcome::Hit(hit) if hit.lambda == 4.0), "{axis}: {ray:?}");
        let options = LinearCastOptions::new().with_axis(axis);
        let straight = linear_cast(&block(0.0), &block(5.0), motion, options).expect("numbers");
        assert!(matches!(straight.outcome, Outcome::Hit(hit) if hit.time == 3.0), "{axis}: {straight:?}");
        let options = MotionCastOptions::new().with_max_time(9.0).with_axis(axis);
        let moving = RigidMotion { velocity: DVec3::X, angular_velocity: DVec3::X, center: DVec3::ZERO };
        let turning =
            motion_cast(&block(0.0), moving, &rounded(5.0), RigidMotion::default(), options).expect("numbers");
        assert!(matches!(turning.outcome, Outcome::Hit(hit) if (hit.time - 3.5).abs() < 1e-13), "{axis}: {turning:?}");
    }
}
