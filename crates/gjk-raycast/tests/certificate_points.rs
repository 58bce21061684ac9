//! Certificates prove what answers claim, as far as the shapes' own support maps tell; `cargo xtask prove` tells it
//! without them.

use crate::common::behind_pointers::{distance, intersects, linear_cast, ray_cast};
use convex_support::glam::{DMat3, DVec2, DVec3, Vec3};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Difference, Ellipsoid, Hint, InvalidShape, Point, Posed, Rounded,
    Scalar, Segment, SupportMap, Vector, support_value,
};
use gjk_raycast::{
    Certificate, DistanceOptions, IntersectOptions, LinearCastOptions, Motion, Ray, RayCastOptions,
    distance_certificate, intersection_certificate, linear_cast_certificate, ray_cast_certificate,
};

type Solid = Box<dyn SupportMap<Vector = DVec3>>;

/// The mean of the points that a certificate tells, in the world.
fn mean<S: SupportMap + ?Sized>(set: &S, certificate: &Certificate<S::Vector>) -> S::Vector {
    let weights: f64 = certificate.points.iter().map(|p| p.weight).sum();
    assert!((weights - 1.0).abs() < 1e-12, "the weights are those of a mean: {certificate:?}");
    assert!(certificate.points.len() <= S::Vector::DIM + 1, "{certificate:?}");
    certificate.points.iter().fold(set.core().origin, |sum, p| {
        assert!(p.weight >= 0.0, "{certificate:?}");
        let weight: <S::Vector as Vector>::Scalar = Scalar::from_f64(p.weight);
        sum + set.core_support(p.direction, &mut Hint::new()) * weight
    })
}

fn solids() -> Result<Vec<Solid>, InvalidShape> {
    Ok(vec![
        Box::new(Point::new(DVec3::new(0.1, 0.2, 0.3))?),
        Box::new(Segment::new([DVec3::new(-1.0, 0.5, 0.0), DVec3::new(1.0, 0.5, 0.25)])?),
        Box::new(Ball::new(0.75)?),
        Box::new(Cuboid::new(DVec3::new(1.0, 0.5, 0.25))?),
        Box::new(Capsule::new(1.0, 0.25)?),
        Box::new(Cylinder::new(1.0, 0.5)?),
        Box::new(Cone::new(1.0, 0.5)?),
        Box::new(Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 0.5, 0.01), Default::default())?),
        Box::new(Rounded::new(Cuboid::new(DVec3::new(0.5, 0.5, 0.25))?, 0.25)?),
        Box::new(Affine::new(Cylinder::new(1.0, 0.5)?, DMat3::from_diagonal(DVec3::new(1.0, 0.5, 2.0)), DVec3::X)?),
    ])
}

#[test]
fn the_points_of_a_distance_are_as_near_as_it_says_and_the_plane_as_far() -> Result<(), InvalidShape> {
    for a in solids()? {
        for b in solids()? {
            for gap in [DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 2.5, 0.1), DVec3::new(0.01, 0.02, 3.0)] {
                let b = Posed::translated(&b, gap)?;
                let answer = distance(&a, &b, DistanceOptions::default());
                let certificate = distance_certificate(&a, &b, &answer);
                let difference = Difference::new(&a, &b);
                let near = mean(&difference, &certificate).length() - difference.core().radius;
                assert!((near - answer.distance).abs() < 1e-13, "{near} for {answer:?} by {certificate:?}");
                let n = certificate.plane.expect("they are apart");
                let far = -support_value(&difference, -n) / n.length();
                assert!((far - answer.distance).abs() < 1e-13, "{far} for {answer:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn the_points_of_a_hit_are_where_the_ray_enters() -> Result<(), InvalidShape> {
    for target in solids()?.into_iter().skip(2) {
        for source in [DVec3::new(5.0, 0.1, 0.2), DVec3::new(0.1, 5.0, 0.05), DVec3::new(-3.0, 4.0, 5.0)] {
            // Aimed at a point within, off all symmetries.
            let ray = Ray { source, direction: target.core().origin + DVec3::new(0.011, 0.012, 0.001) - source };
            let cast = ray_cast(&target, ray, RayCastOptions::default()).expect("finite");
            let hit = cast.outcome.hit().expect("it is aimed well");
            let certificate = ray_cast_certificate(&target, ray, &cast);
            let left = (mean(&target, &certificate) - hit.point).length() - target.core().radius;
            assert!(left < 1e-12, "{left} for {hit:?} by {certificate:?}");
            assert_eq!(certificate.plane, hit.normal, "the plane is that of the normal");
        }
    }
    Ok(())
}

#[test]
fn two_moving_shapes_are_a_ray_against_their_difference() -> Result<(), InvalidShape> {
    let (a, b) = (Cuboid::new(DVec2::ONE)?, Posed::translated(Ball::new(0.5)?, DVec2::new(4.0, 0.25))?);
    let motion = Motion { velocity_a: DVec2::X, velocity_b: DVec2::NEG_X };
    let cast = linear_cast(&a, &b, motion, LinearCastOptions::default()).expect("finite");
    let certificate = linear_cast_certificate(&a, &b, motion, &cast);
    let difference = Difference::new(&a, &b);
    let at = DVec2::new(-2.0, 0.0) * cast.outcome.hit().expect("they meet").time;
    assert!(((mean(&difference, &certificate) - at).length() - 0.5).abs() < 1e-15, "{certificate:?}");
    assert_eq!(certificate.plane, Some(DVec2::NEG_X), "from b to a");
    Ok(())
}

#[test]
fn overlap_is_told_by_points_around_and_a_miss_by_a_plane_alone() -> Result<(), Box<dyn std::error::Error>> {
    let (a, b) = (Cuboid::new(Vec3::ONE)?, Posed::translated(Cuboid::new(Vec3::ONE)?, Vec3::new(1.5, 0.5, 0.25))?);
    let certificate = intersection_certificate(&a, &b, &intersects(&a, &b, IntersectOptions::default()));
    assert_eq!((certificate.points.len(), certificate.plane), (4, None), "{certificate:?}");
    assert!(mean(&Difference::new(&a, &b), &certificate).length() < 1e-6, "{certificate:?}");

    let ray = Ray { source: Vec3::new(-3.0, 1.5, 0.0), direction: Vec3::X };
    let cast = ray_cast(&a, ray, RayCastOptions::default())?;
    let certificate = ray_cast_certificate(&a, ray, &cast);
    let n = certificate.plane.ok_or("it misses")?;
    assert!(certificate.points.is_empty() && n.dot(ray.direction) >= 0.0, "the ray does not approach: {certificate:?}");
    assert!(n.dot(ray.source) > support_value(&a, n), "and starts before it");
    Ok(())
}

#[test]
fn what_is_no_support_map_has_no_points_or_any() {
    struct Liar;
    impl SupportMap for Liar {
        type Vector = DVec3;
        fn support(&self, _: DVec3) -> DVec3 {
            DVec3::NAN
        }
    }
    let answer = distance(&Liar, &Liar, DistanceOptions::default());
    let _ = distance_certificate(&Liar, &Liar, &answer);
    let overlap = intersects(&Liar, &Liar, IntersectOptions::default());
    let _ = intersection_certificate(&Liar, &Liar, &overlap);
}
