//! Batches answer what single casts answer.

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Posed, SupportMap};
use gjk_raycast::{
    DistanceOptions, Outcome, Ray, RayCastError, RayCastOptions, distance, map_distances_into, ray_cast, ray_casts,
};

type Body = Box<dyn SupportMap<Vector = DVec3> + Sync>;

/// A few numbers in −1..1 from an index: the same on every machine.
fn spread(index: usize, salt: usize) -> f64 {
    let golden = 0.618_033_988_749_894_9 * (salt + 1) as f64;
    2.0 * ((index as f64 + 0.5) * golden).fract() - 1.0
}

fn vector(index: usize, salt: usize) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|i| spread(index, 3 * salt + i)))
}

fn shape(kind: usize) -> Body {
    match kind % 7 {
        0 => Box::new(Ball::new(0.5).unwrap()),
        1 => Box::new(Cuboid::new(DVec3::new(0.5, 0.25, 0.75)).unwrap()),
        2 => Box::new(Capsule::new(0.5, 0.25).unwrap()),
        3 => Box::new(Cylinder::new(0.5, 0.25).unwrap()),
        4 => Box::new(Cone::new(0.5, 0.5).unwrap()),
        5 => Box::new(Ellipsoid::new(DVec3::ZERO, DVec3::new(0.75, 0.5, 0.25), DQuat::IDENTITY).unwrap()),
        _ => Box::new(Polytope::new((0..30).map(|i| vector(i, 9) * 0.6)).unwrap()),
    }
}

#[cfg(feature = "rayon")]
fn rays(count: usize, size: f64) -> Vec<Ray<DVec3>> {
    (0..count).map(|i| Ray { source: vector(i, 3) * 1.5 * size, direction: vector(i, 4) }).collect()
}

#[test]
fn many_rays_are_answered_as_one_by_one() {
    let (mut hits, mut misses, mut stalled) = (0, 0, 0);
    for kind in 0..7 {
        let target = shape(kind);
        // A picture: neighbouring rays, some of which graze.
        let rays: Vec<_> = (0..900)
            .map(|i| {
                let (x, y) = (f64::from(i % 30) / 15.0 - 1.0, f64::from(i / 30) / 15.0 - 1.0);
                Ray { source: DVec3::new(0.3, 0.2, 5.0), direction: DVec3::new(x - 0.3, y - 0.2, -5.0) }
            })
            .collect();
        let options = RayCastOptions::default();
        let casts: Vec<_> = ray_casts(&target, &rays, options).map(Result::unwrap).collect();
        assert_eq!(casts.len(), rays.len(), "an answer for each ray");
        for (cast, &ray) in casts.iter().zip(&rays) {
            let alone = ray_cast(&target, ray, options).unwrap();
            match (cast.outcome, alone.outcome) {
                (Outcome::Hit(p), Outcome::Hit(q)) if cast.status != alone.status => {
                    // One of them said that it could not go on; its bounds hold.
                    stalled += 1;
                    let ulps = 16.0 * f64::EPSILON;
                    assert!(cast.lower <= alone.upper + ulps && alone.lower <= cast.upper + ulps, "{p:?} or {q:?}");
                }
                (Outcome::Hit(p), Outcome::Hit(q)) => {
                    hits += 1;
                    // λ = 1 is 5 away from the source, and the shapes are about 1 in size.
                    let (angle, ulps) = (q.normal.unwrap().dot(ray.direction.normalize()).abs(), 64.0 * f64::EPSILON);
                    assert!((p.lambda - q.lambda).abs() <= ulps / angle, "kind {kind}: {ray:?}: {p:?} or {q:?}");
                }
                (Outcome::Miss(_), Outcome::Miss(_)) => misses += 1,
                (p, q) => panic!("kind {kind}: {ray:?}: {p:?} or {q:?}"),
            }
        }
    }
    assert!(stalled < 10, "{stalled} of {hits} hits stalled");
    assert!(hits > 500 && misses > 500, "{hits} hits and {misses} misses are no fair sample");
}

#[test]
fn a_bad_ray_spoils_only_its_own_answer() {
    let ball = Ball::<DVec3>::new(1.0).unwrap();
    let good = Ray { source: DVec3::new(-3.0, 0.0, 0.0), direction: DVec3::X };
    let bad = Ray { source: DVec3::ZERO, direction: DVec3::ZERO };
    let rays = [good, bad, Ray { source: DVec3::NAN, ..good }, good];
    let answers: Vec<_> = ray_casts(&ball, &rays, RayCastOptions::default()).collect();
    assert_eq!(answers[1], Err(RayCastError::ZeroDirection), "a zero direction");
    assert!(matches!(answers[2], Err(RayCastError::NonFinite { parameter: "source", index: 0 })), "{:?}", answers[2]);
    for answer in [answers[0], answers[3]] {
        assert_eq!(answer.unwrap().outcome.hit().unwrap().lambda, 2.0, "the good ones");
    }
}

#[cfg(feature = "rayon")]
#[test]
fn threads_change_no_bit() {
    use gjk_raycast::par_ray_casts;
    let options = RayCastOptions::default();
    let rays = rays(2000, 1.0);
    for kind in 0..7 {
        let target = shape(kind);
        let alone: Vec<_> = ray_casts(&target, &rays, options).collect();
        assert_eq!(par_ray_casts(&target, &rays, options), alone, "kind {kind}");
    }
}

#[test]
fn a_column_of_distances_is_that_of_each_pair() {
    let options = DistanceOptions::default();
    for kind in 0..7 {
        let (a, b) = (shape(kind), shape(kind + 1));
        let posed: Vec<_> = (0..100).map(|i| Posed::translated(&*b, vector(i, 5) * 3.0).unwrap()).collect();
        let each: Vec<_> = posed.iter().map(|b| distance(&*a, b, options)).collect();
        assert!(each.iter().any(|d| d.overlap) && each.iter().any(|d| !d.overlap), "some meet, some do not");
        let column = |part: std::ops::Range<usize>| {
            let mut column = vec![[0.0; 3]; part.len()];
            map_distances_into(&[&*a], &posed[part], options, &mut column, |d| [d.lower, d.distance, d.upper]);
            column
        };
        let whole: Vec<_> = each.iter().map(|d| [d.lower, d.distance, d.upper]).collect();
        assert_eq!(column(0..100), whole, "shape {kind}");
        assert_eq!([column(0..37), column(37..100)].concat(), whole, "shape {kind} in two parts");
    }
    map_distances_into::<Ball<DVec3>, Ball<DVec3>, f64>(&[], &[], options, &mut [], |d| d.distance);
}

#[test]
#[should_panic(expected = "2 shapes b for 3 answers")]
fn a_column_must_have_a_row_for_each_pair() {
    let ball = Ball::<DVec3>::new(1.0).unwrap();
    map_distances_into(&[ball], &[ball, ball], DistanceOptions::default(), &mut [0.0; 3], |d| d.distance);
}
