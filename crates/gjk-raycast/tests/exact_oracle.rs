//! Distance, overlap, ray cast and linear cast of polytopes with integer vertices, against brute force in integers.
//!
//! Small integers make degeneracies common instead of rare: parallel and coplanar faces, collinear and repeated
//! vertices, rays in the plane of a face or through a vertex, bodies that just touch.

mod exact;

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::{Polytope, Scalar, ScalarOf, Vector};
use exact::Point;
use gjk_raycast::{
    DistanceOptions, IntersectOptions, LinearCastOptions, Motion, Outcome, Ray, RayCastOptions, Status, distance,
    intersects, linear_cast, ray_cast,
};
use proptest::prelude::*;

/// Between 1 and 6 points with coordinates of magnitude up to `size`; planar where `planar`.
fn cloud(planar: bool) -> impl Strategy<Value = Vec<Point>> {
    prop_oneof![Just(2_i128), Just(9), Just(250)].prop_flat_map(move |size| {
        let z = if planar { 0 } else { size };
        prop::collection::vec((-size..=size, -size..=size, -z..=z).prop_map(|(x, y, z)| [x, y, z]), 1..=6)
    })
}

fn vector<V: Vector>(p: Point) -> V {
    #[allow(clippy::cast_precision_loss, reason = "small integers are exact")]
    V::from_fn(|i| V::Scalar::from_f64(p[i] as f64))
}

fn polytope<V: Vector>(points: &[Point]) -> Polytope<V> {
    Polytope::new(points.iter().map(|&p| vector(p))).expect("finite points")
}

/// The length scale that rounding errors are relative to.
fn size(clouds: &[&[Point]]) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "small integers are exact")]
    clouds.iter().flat_map(|c| c.iter().flatten()).map(|c| c.abs() as f64).fold(1.0, f64::max)
}

/// The error that is allowed, in units of rounding errors of the size of the scene.
const ULPS: f64 = 64.0;

fn check_distance<V: Vector>(a: &[Point], b: &[Point]) -> Result<(), TestCaseError> {
    let squared = exact::squared_distance(&exact::difference(a, b));
    let truth = squared.as_f64().sqrt();
    let slack = ULPS * ScalarOf::<Polytope<V>>::EPSILON.as_f64() * size(&[a, b]);
    let (a, b) = (polytope::<V>(a), polytope::<V>(b));
    let answer = distance(&a, &b, DistanceOptions::default());
    let [found, lower, upper] = [answer.distance, answer.lower, answer.upper].map(Scalar::as_f64);
    prop_assert_eq!(answer.status, Status::Converged);
    prop_assert!((found - truth).abs() <= slack, "distance {}, truth {}", found, truth);
    // The bracket is a certificate: rounding is already in it. Only the truth itself was rounded here.
    let ulp = 1e-15 * truth;
    prop_assert!(lower <= truth + ulp && truth <= upper + ulp, "[{}, {}] misses {}", lower, upper, truth);
    let meets = intersects(&a, &b, IntersectOptions::default());
    prop_assert_eq!(meets.overlap, answer.overlap, "distance and intersects contradict one another");
    if truth > slack {
        prop_assert!(!answer.overlap, "apart by {}", truth);
        let gap = (answer.point_a - answer.point_b).norm().as_f64();
        prop_assert!((gap - truth).abs() <= slack, "closest points are {} apart, truth {}", gap, truth);
    } else if squared.numerator == 0 {
        prop_assert!(found <= slack, "in contact, but said to be {} apart", found);
    }
    Ok(())
}

fn check_ray<V: Vector>(points: &[Point], source: Point, direction: Point) -> Result<(), TestCaseError> {
    let truth = exact::ray_entry(points, source, direction);
    let target = polytope::<V>(points);
    let ray = Ray { source: vector::<V>(source), direction: vector(direction) };
    let slack = ULPS * V::Scalar::EPSILON.as_f64() * size(&[points, &[source]]) / ray.direction.length().as_f64();
    let answer = ray_cast(&target, ray, RayCastOptions::default()).map_err(|e| TestCaseError::fail(e.to_string()))?;
    prop_assert_eq!(answer.status, Status::Converged);
    match (answer.outcome, truth) {
        (Outcome::Hit(hit), Some(truth)) => {
            // A face met at a slope of 1 in 10⁶ moves the hit 10⁶ times as far as it is moved itself, so the point of
            // the ray is held against the body instead: it must lie on it, and nothing before it may.
            let (found, truth) = (hit.lambda.as_f64(), truth.as_f64());
            let [lower, upper] = [answer.lower, answer.upper].map(Scalar::as_f64);
            let steep =
                hit.normal.map_or(1.0, |n| (n.dot(ray.direction).as_f64() / ray.direction.length().as_f64()).abs());
            prop_assert!((found - truth).abs() * steep <= slack, "lambda {}, truth {}", found, truth);
            let ulp = 1e-15 * truth + slack / steep.max(1e-9);
            prop_assert!(lower <= truth + ulp && truth <= upper + ulp, "[{}, {}] misses {}", lower, upper, truth);
        }
        (Outcome::Miss(_), None) => {}
        // Integer rays touch vertices, edges and faces exactly; there, and only there, either answer may come.
        (Outcome::Hit(_), None) => {
            let grown = touches(points, source, direction, slack * ray.direction.length().as_f64());
            prop_assert!(grown, "a false hit: {:?}", answer);
        }
        (Outcome::Miss(_), Some(truth)) => {
            let inner = interior(points, source, direction);
            prop_assert!(!inner, "a missed hit at {}: {:?}", truth.as_f64(), answer);
        }
        (Outcome::Undecided, _) => prop_assert!(false, "undecided: {:?}", answer),
    }
    Ok(())
}

/// Whether the ray passes within `slack` of the hull, by the distance of the hull from the segment that is the ray as
/// far as it matters.
fn touches(points: &[Point], source: Point, direction: Point, slack: f64) -> bool {
    let far = core::array::from_fn(|i| source[i] + 2 * direction[i]);
    let long: Vec<Point> = vec![source, far];
    exact::squared_distance(&exact::difference(points, &long)).as_f64().sqrt() <= slack
}

/// Whether the ray runs through the interior of the hull, so that rounding cannot turn its hit into a miss: parallel
/// rays, shifted a little any way, hit it too.
fn interior(points: &[Point], source: Point, direction: Point) -> bool {
    let finer = |p: Point| p.map(|c| 4 * c);
    let fine: Vec<Point> = points.iter().map(|&p| finer(p)).collect();
    let shifts = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
    points.iter().all(|p| p.iter().all(|c| c.abs() < 100))
        && shifts.iter().all(|s| {
            let s0 = finer(source);
            exact::ray_entry(&fine, core::array::from_fn(|i| s0[i] + s[i]), finer(direction)).is_some()
        })
}

fn direction(planar: bool) -> impl Strategy<Value = Point> {
    let z = if planar { 0 } else { 9_i128 };
    (-9_i128..=9, -9_i128..=9, -z..=z).prop_map(|(x, y, z)| [x, y, z]).prop_filter("not zero", |d| *d != [0; 3])
}

/// The edge along the ray is a single point across it, spanned by rounding; what rounding spans must not count as
/// passed. Found by the properties below.
#[test]
fn a_ray_along_an_edge_misses() {
    let points = [[3, -8, 0], [-4, -1, 0], [-7, -9, 0]];
    check_ray::<DVec2>(&points, [27, -27, 0], [-9, 9, 0]).expect("in double precision");
    check_ray::<Vec2>(&points, [27, -27, 0], [-9, 9, 0]).expect("in single precision");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn distance_in_space(a in cloud(false), b in cloud(false)) {
        check_distance::<DVec3>(&a, &b)?;
        check_distance::<Vec3A>(&a, &b)?;
        check_distance::<Vec3>(&a, &b)?;
    }

    #[test]
    fn distance_in_the_plane(a in cloud(true), b in cloud(true)) {
        check_distance::<DVec2>(&a, &b)?;
        check_distance::<Vec2>(&a, &b)?;
    }

    #[test]
    fn ray_in_space(points in cloud(false), aim in 0_usize..6, back in 0_i128..4, d in direction(false)) {
        // Half the rays start behind a vertex and run through it.
        let through = points[aim % points.len()];
        let source = core::array::from_fn(|i| if aim < 3 { through[i] - back * d[i] } else { 3 * d[(i + 1) % 3] });
        check_ray::<DVec3>(&points, source, d)?;
        check_ray::<Vec3A>(&points, source, d)?;
    }

    #[test]
    fn ray_in_the_plane(points in cloud(true), aim in 0_usize..6, back in 0_i128..4, d in direction(true)) {
        let through = points[aim % points.len()];
        let source = core::array::from_fn(|i| if i == 2 { 0 } else if aim < 3 { through[i] - back * d[i] } else { 3 * d[1 - i] });
        check_ray::<DVec2>(&points, source, d)?;
        check_ray::<Vec2>(&points, source, d)?;
    }

    #[test]
    fn linear_cast_is_the_ray_cast_on_the_difference(a in cloud(false), b in cloud(false), d in direction(false)) {
        let obstacle = exact::difference(&a, &b);
        let truth = exact::ray_entry(&obstacle, [0; 3], d);
        let (pa, pb) = (polytope::<DVec3>(&a), polytope::<DVec3>(&b));
        let motion = Motion { velocity_a: DVec3::ZERO, velocity_b: vector(d) };
        let answer = linear_cast(&pa, &pb, motion, LinearCastOptions::default())
            .map_err(|e| TestCaseError::fail(e.to_string()))?;
        prop_assert_eq!(answer.status, Status::Converged);
        let slack = ULPS * f64::EPSILON * size(&[&a, &b]) / motion.velocity_b.length();
        match (answer.outcome, truth) {
            (Outcome::Hit(hit), Some(truth)) => {
                let steep = hit.normal.map_or(1.0, |n| (n.dot(motion.velocity_b) / motion.velocity_b.length()).abs());
                let error = (hit.time - truth.as_f64()).abs();
                prop_assert!(error * steep <= slack, "time {}, truth {}", hit.time, truth.as_f64());
            }
            (Outcome::Miss(_), None) => {}
            (Outcome::Hit(_), None) => prop_assert!(touches(&obstacle, [0; 3], d, 1e-9), "a false hit: {:?}", answer),
            (Outcome::Miss(_), Some(_)) => prop_assert!(!interior(&obstacle, [0; 3], d), "a missed hit: {:?}", answer),
            (Outcome::Undecided, _) => prop_assert!(false, "undecided: {:?}", answer),
        }
    }
}
