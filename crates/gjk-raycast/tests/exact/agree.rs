//! The crate's answers held against the oracle.

use convex_support::{Polytope, Scalar, SupportMap, Vector};
use gjk_raycast::{
    DistanceOptions, IntersectOptions, LinearCastOptions, Motion, Outcome, Ray, RayCastOptions, Status, distance,
    intersects, linear_cast, ray_cast,
};

use super::{Point, difference, ray_entry, squared_distance};

/// What is wrong, in words.
pub(crate) type Verdict = Result<(), String>;

fn ensure(holds: bool, otherwise: impl FnOnce() -> String) -> Verdict {
    if holds { Ok(()) } else { Err(otherwise()) }
}

fn vector<V: Vector>(p: Point) -> V {
    #[allow(clippy::cast_precision_loss, reason = "small integers are exact")]
    V::from_fn(|i| V::Scalar::from_f64(p[i] as f64))
}

/// Behind `dyn`, so that everything is compiled once for all shapes.
fn polytope<V: Vector>(points: &[Point]) -> Box<dyn SupportMap<Vector = V> + Send + Sync> {
    Box::new(Polytope::new(points.iter().map(|&p| vector(p))).expect("finite points"))
}

/// The length scale that rounding errors are relative to.
fn size(clouds: &[&[Point]]) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "small integers are exact")]
    clouds.iter().flat_map(|c| c.iter().flatten()).map(|c| c.abs() as f64).fold(1.0, f64::max)
}

/// The error that is allowed, in units of rounding errors of the size of the scene.
const ULPS: f64 = 64.0;

/// The distance of two hulls, its certificate and witnesses, and whether they meet.
pub(crate) fn distance_agrees<V: Vector>(a: &[Point], b: &[Point]) -> Verdict {
    let squared = squared_distance(&difference(a, b));
    let truth = squared.as_f64().sqrt();
    let slack = ULPS * V::Scalar::EPSILON.as_f64() * size(&[a, b]);
    let (a, b) = (polytope::<V>(a), polytope::<V>(b));
    let answer = distance(&a, &b, DistanceOptions::default());
    let [found, lower, upper] = [answer.distance, answer.lower, answer.upper].map(Scalar::as_f64);
    let told = |what: &str| format!("{what}: {answer:?}, truth {truth}");
    ensure(answer.status == Status::Converged, || told("not converged"))?;
    ensure((found - truth).abs() <= slack, || told("distance"))?;
    // The bracket is a certificate: rounding is already in it. Only the truth itself was rounded here.
    let ulp = 1e-15 * truth;
    ensure(lower <= truth + ulp && truth <= upper + ulp, || told("the bracket misses the truth"))?;
    let meets = intersects(&a, &b, IntersectOptions::default());
    ensure(meets.overlap == answer.overlap, || told("distance and intersects contradict one another"))?;
    if truth > slack {
        ensure(!answer.overlap, || told("apart"))?;
        let gap = (answer.point_a - answer.point_b).norm().as_f64();
        ensure((gap - truth).abs() <= slack, || told("the closest points are not that far apart"))?;
    }
    ensure(squared.numerator != 0 || found <= slack, || told("in contact, but said to be apart"))
}

/// What a cast on an obstacle said: hit with λ and the cosine at which the surface is met, miss, or neither.
struct Answer {
    outcome: Outcome<(f64, f64), ()>,
    bracket: [f64; 2],
    status: Status,
    told: String,
}

/// Holds a cast against the obstacle that is the hull of these points. `extent` is the length scale of rounding errors.
fn cast_agrees(points: &[Point], source: Point, direction: Point, slack: f64, answer: &Answer) -> Verdict {
    let truth = ray_entry(points, source, direction);
    let told = |what: &str| format!("{what}: {}, truth {:?}", answer.told, truth.map(super::Fraction::as_f64));
    // Only a hit that may be a miss has not, and one whose bracket is wider than rounding need not have.
    let [lower, upper] = answer.bracket;
    let is_hit = matches!(answer.outcome, Outcome::Hit(_));
    let (is_open, is_wide) = (is_hit && upper == f64::INFINITY, is_hit && upper - lower > slack);
    let ending = if is_open { Status::Stalled } else { Status::Converged };
    ensure(answer.status == ending || is_wide && answer.status == Status::Stalled, || told("not converged"))?;
    match (answer.outcome, truth) {
        (Outcome::Hit((found, steep)), Some(truth)) => {
            // A face met at a slope of 1 in 10⁶ moves the hit 10⁶ times as far as it is moved itself, so the point of
            // the ray is held against the body instead: it must lie on it, and nothing before it may.
            let truth = truth.as_f64();
            ensure((found - truth).abs() * steep <= slack, || told("lambda"))?;
            let ulp = 1e-15 * truth + slack / steep.max(1e-9);
            ensure(lower <= truth + ulp && truth <= upper + ulp, || told("the bracket misses the truth"))
        }
        (Outcome::Miss(_), None) => Ok(()),
        // Integer rays touch vertices, edges and faces exactly; there, and only there, either answer may come.
        (Outcome::Hit(_), None) => {
            #[allow(clippy::cast_precision_loss, reason = "small integers are exact")]
            let length = direction.iter().map(|&c| (c * c) as f64).sum::<f64>().sqrt();
            ensure(touches(points, source, direction, slack * length), || told("a false hit"))
        }
        (Outcome::Miss(_), Some(_)) => ensure(!interior(points, source, direction), || told("a missed hit")),
        (Outcome::Undecided, _) => Err(told("undecided")),
    }
}

/// Where a ray enters a hull.
pub(crate) fn ray_agrees<V: Vector>(points: &[Point], source: Point, direction: Point) -> Verdict {
    let target = polytope::<V>(points);
    let ray = Ray { source: vector::<V>(source), direction: vector(direction) };
    let length = ray.direction.length().as_f64();
    let slack = ULPS * V::Scalar::EPSILON.as_f64() * size(&[points, &[source]]) / length;
    let cast = ray_cast(&target, ray, RayCastOptions::default()).map_err(|e| e.to_string())?;
    let steep = |n: Option<V>| n.map_or(1.0, |n| (n.dot(ray.direction).as_f64() / length).abs());
    let outcome = match cast.outcome {
        Outcome::Hit(hit) => Outcome::Hit((hit.lambda.as_f64(), steep(hit.normal))),
        Outcome::Miss(_) => Outcome::Miss(gjk_raycast::Miss { axis: () }),
        Outcome::Undecided => Outcome::Undecided,
    };
    let bracket = [cast.lower, cast.upper].map(Scalar::as_f64);
    let answer = Answer { outcome, bracket, status: cast.status, told: format!("{cast:?}") };
    cast_agrees(points, source, direction, slack, &answer)
}

/// When two hulls meet, the second of which moves, and where: the ray cast on their difference.
pub(crate) fn linear_cast_agrees<V: Vector>(a: &[Point], b: &[Point], velocity_b: Point) -> Verdict {
    let obstacle = difference(a, b);
    let (body_a, body_b) = (polytope::<V>(a), polytope::<V>(b));
    let motion = Motion { velocity_a: V::ZERO, velocity_b: vector(velocity_b) };
    let cast = linear_cast(&body_a, &body_b, motion, LinearCastOptions::default()).map_err(|e| e.to_string())?;
    let length = motion.velocity_b.length().as_f64();
    let slack = ULPS * V::Scalar::EPSILON.as_f64() * size(&[a, b]) / length;
    let steep = |n: Option<V>| n.map_or(1.0, |n| (n.dot(motion.velocity_b).as_f64() / length).abs());
    let outcome = match cast.outcome {
        Outcome::Hit(hit) => Outcome::Hit((hit.time.as_f64(), steep(hit.normal))),
        Outcome::Miss(_) => Outcome::Miss(gjk_raycast::Miss { axis: () }),
        Outcome::Undecided => Outcome::Undecided,
    };
    let bracket = [cast.lower, cast.upper].map(Scalar::as_f64);
    let answer = Answer { outcome, bracket, status: cast.status, told: format!("{cast:?}") };
    cast_agrees(&obstacle, [0; 3], velocity_b, slack, &answer)
}

/// Whether the ray passes within `slack` of the hull, by the distance of the hull from the segment that is the ray as
/// far as it matters.
fn touches(points: &[Point], source: Point, direction: Point, slack: f64) -> bool {
    let far = core::array::from_fn(|i| source[i] + 2 * direction[i]);
    let long: Vec<Point> = vec![source, far];
    squared_distance(&difference(points, &long)).as_f64().sqrt() <= slack
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
            ray_entry(&fine, core::array::from_fn(|i| s0[i] + s[i]), finer(direction)).is_some()
        })
}
