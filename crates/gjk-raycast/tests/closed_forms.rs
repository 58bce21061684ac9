//! Casts against shapes that know for certain where a line enters them: they are asked first.

use crate::common::{directions, v};
use convex_support::glam::DVec3;
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, LineQuery, Posed, Rounded, SupportMap, support_value,
};
use gjk_raycast::{
    CastMethod, LinearCastOptions, Motion, Outcome, Ray, RayCast, RayCastOptions, Status, linear_cast, ray_cast,
    ray_cast_with,
};

type Body = Box<dyn SupportMap<Vector = DVec3>>;

fn bodies() -> Result<Vec<Body>, convex_support::InvalidShape> {
    let (size, at) = (DVec3::new(1.0, 0.6, 0.3), DVec3::new(0.3, -0.2, 0.1));
    let turn = convex_support::glam::DQuat::from_rotation_arc(DVec3::X, DVec3::new(2.0, -1.0, 2.0).normalize());
    let shear = convex_support::glam::DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.4, 1.2, 0.0, -0.3, 0.0, 0.8]);
    Ok(vec![
        Box::new(Ball::new(0.7)?),
        Box::new(Cuboid::new(size)?),
        Box::new(Capsule::new(0.8, 0.4)?),
        Box::new(Cylinder::new(0.8, 0.4)?),
        Box::new(Cone::new(0.8, 0.5)?),
        Box::new(Ellipsoid::new(at, size, turn)?),
        Box::new(Posed::new(Cylinder::new(0.5, 0.5)?, turn, at)?),
        Box::new(Affine::new(Cone::new(0.5, 0.5)?, shear, at)?),
        Box::new(Posed::new(Rounded::new(Cuboid::new(size)?, 0.2)?, turn, at)?),
    ])
}

fn cast(body: &Body, ray: Ray<DVec3>, method: CastMethod) -> RayCast<DVec3> {
    ray_cast(&**body, ray, RayCastOptions::default().with_method(method)).expect("a finite ray with a direction")
}

#[test]
fn a_ray_takes_one_support_point_and_is_answered_as_by_the_search() -> Result<(), convex_support::InvalidShape> {
    let (mut hits, mut misses) = (0, 0);
    for body in bodies()? {
        for from in directions(40) {
            for to in directions(7) {
                let (source, target) = (v::<DVec3>(from) * 4.0, v::<DVec3>(to) * 0.6);
                let ray = Ray { source, direction: target - source };
                let (known, found) = (cast(&body, ray, CastMethod::Portal), cast(&body, ray, CastMethod::Gjk));
                assert_eq!(known.status, Status::Converged);
                match (known.outcome, found.outcome) {
                    (Outcome::Hit(p), Outcome::Hit(q)) => {
                        hits += 1;
                        assert!(known.lower <= p.lambda && p.lambda <= known.upper, "{known:?}");
                        assert!(known.lower <= found.upper && found.lower <= known.upper, "{known:?} {found:?}");
                        assert!(known.upper - known.lower < 2e-12, "{known:?}");
                        assert!((p.lambda - q.lambda).abs() < 1e-12, "{known:?} {found:?}");
                        assert!(known.iterations == 1, "{known:?}");
                    }
                    (Outcome::Miss(miss), Outcome::Miss(_)) => {
                        misses += 1;
                        assert!(known.iterations <= 1, "{known:?}");
                        let n = miss.axis;
                        assert!(n.dot(source) > support_value(&body, n), "{known:?}");
                        assert!(n.dot(ray.direction) > -1e-15 * ray.direction.length(), "{known:?}");
                    }
                    (Outcome::Hit(_) | Outcome::Miss(_), Outcome::Undecided) => {}
                    _ => panic!("{known:?} {found:?}"),
                }
            }
        }
    }
    assert!(hits > 500 && misses > 100, "{hits} hits, {misses} misses");
    Ok(())
}

#[test]
fn a_ball_that_moves_against_them_takes_one_support_point() -> Result<(), convex_support::InvalidShape> {
    for body in bodies()? {
        // Rounded by the ball's radius, not all of them have a closed form.
        let has_one = body.certain_crossing(LineQuery::new(DVec3::X * 9.0, DVec3::NEG_X).sweeping(0.25)).is_some();
        for from in directions(40) {
            let ball = Posed::translated(Ball::new(0.25)?, v::<DVec3>(from) * 5.0)?;
            let motion = Motion { velocity_a: DVec3::ZERO, velocity_b: v::<DVec3>(from) };
            let options = LinearCastOptions::default();
            for (known, found) in [
                (
                    linear_cast(&ball, &*body, motion, options),
                    linear_cast(&ball, &*body, motion, options.with_method(CastMethod::Gjk)),
                ),
                (
                    linear_cast(&*body, &ball, Motion { velocity_a: motion.velocity_b, ..Motion::default() }, options),
                    linear_cast(&ball, &*body, motion, options.with_method(CastMethod::Gjk)),
                ),
            ] {
                let (known, found) = (known.expect("finite"), found.expect("finite"));
                let (Some(p), Some(q)) = (known.outcome.hit(), found.outcome.hit()) else { panic!("{known:?}") };
                assert!((p.time - q.time).abs() < 1e-12, "{known:?} {found:?}");
                assert!(!has_one || known.iterations == 1, "{known:?}");
            }
        }
    }
    Ok(())
}

/// Seen from eight sizes away a ray is based at its source, from farther at its point near the body; the answers agree.
#[test]
fn a_ray_from_farther_is_the_same_ray() -> Result<(), Box<dyn std::error::Error>> {
    for body in bodies()? {
        for from in directions(40) {
            for to in directions(7) {
                let (away, target) = (v::<DVec3>(from), v::<DVec3>(to) * 0.6);
                let casts = [4.0, 64.0, 1e4].map(|far| {
                    let source = target + away * far;
                    (far, cast(&body, Ray { source, direction: -away }, CastMethod::Portal))
                });
                for (far, cast) in casts {
                    assert_eq!(cast.outcome.is_miss(), casts[0].1.outcome.is_miss(), "{far}: {cast:?}");
                    let (Some(near), Some(hit)) = (casts[0].1.outcome.hit(), cast.outcome.hit()) else { continue };
                    let facing = near.normal.map_or(1.0, |n| n.dot(away));
                    let error = 1e-14 * (1.0 + far / 16.0) / facing;
                    assert!(((hit.lambda - far) - (near.lambda - 4.0)).abs() < error, "{far}: {cast:?} {near:?}");
                    assert!(cast.upper - cast.lower < 1e-13 / facing + 2e-15 * far, "{cast:?}");
                }
            }
        }
    }
    Ok(())
}

/// A ray that ends before the body misses by the plane where it would enter; an observer sees that plane alone.
#[test]
fn the_end_of_a_ray_and_what_an_observer_sees() -> Result<(), Box<dyn std::error::Error>> {
    let ray = Ray { source: DVec3::new(-3.0, 0.3, 0.2), direction: DVec3::X };
    for body in bodies()? {
        let mut seen = Vec::new();
        let whole = ray_cast_with(&*body, ray, RayCastOptions::default(), |iterate| seen.push(iterate.v))?;
        let Some(hit) = whole.outcome.hit() else { continue };
        assert_eq!(whole, ray_cast(&*body, ray, RayCastOptions::default())?);
        assert_eq!((seen.len(), seen.first().copied()), (1, hit.normal), "{whole:?}");
        let cast = |end: f64| ray_cast(&*body, ray, RayCastOptions::default().with_max_lambda(end));
        assert_eq!(cast(hit.lambda)?.outcome.hit(), Some(hit));
        let Outcome::Miss(miss) = cast(hit.lambda - 1e-6)?.outcome else { panic!("it ends before") };
        assert_eq!(Some(miss.axis), hit.normal);
    }
    Ok(())
}

#[test]
fn a_limit_of_iterations_is_neither_a_hit_nor_a_miss() -> Result<(), convex_support::InvalidShape> {
    let mut undecided = 0;
    for aspect in [1e1, 1e3, 1e5] {
        let needle = Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 1.0 / aspect, 1.0 / aspect), Default::default())?;
        for from in directions(20) {
            for max_iterations in 0..8 {
                let source = v::<DVec3>(from) * 3.0;
                let options =
                    RayCastOptions::default().with_method(CastMethod::Gjk).with_max_iterations(max_iterations);
                let cast = ray_cast(&needle, Ray { source, direction: -source }, options).expect("a finite ray");
                assert_eq!(cast.is_certain(), cast.status == Status::Converged, "{cast:?}");
                assert!(cast.status != Status::IterationLimit || cast.outcome == Outcome::Undecided, "{cast:?}");
                undecided += usize::from(cast.outcome == Outcome::Undecided);
            }
        }
    }
    assert!(undecided > 50, "{undecided}");
    Ok(())
}
