//! What a search shows on its way: the iterates that the observer of a question sees, in the units of the world.
//!
//! The question is asked once more, of the same shapes with the same options, this time with an observer. Fields that
//! begin with `_` choose what the format does not: `_sub_algorithm`, and `_search` for the search of a cast.

#[cfg(not(feature = "space"))]
use convex_support::glam::DVec2 as Vector;
#[cfg(feature = "space")]
use convex_support::glam::DVec3 as Vector;
use convex_support::{Point, SupportMap as _};
use gjk_raycast::{
    CastMethod, DistanceOptions, Iterate, LinearCastOptions, Motion, MotionCastOptions, MotionIterate, Outcome, Ray,
    RayCastOptions, RigidMotion, SignedDistanceOptions, Status, SubAlgorithm, distance, distance_with,
    iterative_ray_cast_with, linear_cast_with, motion_cast_with, ray_cast_with, signed_distance_with,
};
#[cfg(feature = "space")]
use lj_ellipsoid::{EnclosingMethod, EnclosingOptions, enclosing_dyn_with};
use serde_json::{Value, json};
use xtask::mesh::Meshes;
use xtask::wire::fields::{Dimension, Object, Written};
use xtask::wire::shape::{Shape, Solid, Space};

/// The iterates, and what this run ended with; null where nothing iterates, or a number cannot be read.
pub(crate) fn look(query: &Object, meshes: &Meshes) -> Value {
    #[cfg(feature = "space")]
    if query.get("query").and_then(Value::as_str) == Some("enclosing_ellipsoid") {
        return enclosing(query).unwrap_or_default();
    }
    Asked::<Vector>::new(query, meshes).and_then(|asked| asked.run()).unwrap_or_default()
}

/// The dimension of a query that has an answer.
pub(crate) fn dimension(query: &Object) -> usize {
    let dimension = Dimension::default();
    for key in ["a", "b", "target"] {
        if let Some(shape) = query.get(key).and_then(Value::as_object) {
            let _ = Shape::read(Written::new(shape, &dimension));
        }
    }
    let listed = |key: &str| query.get(key)?.as_array().map(Vec::len);
    let first = |key: &str| query.get(key)?.as_array()?.first()?.as_array().map(Vec::len);
    let center = |key: &str| query.get(key)?.get("center")?.as_array().map(Vec::len);
    dimension.known().or(listed("source")).or(listed("velocity_a")).or(first("points")).or(center("e1")).unwrap_or(3)
}

/// The shape in a field of a query.
pub(crate) fn shape<V: Space>(query: &Object, key: &str, meshes: &Meshes) -> Option<Solid<V>> {
    Shape::read(Written::new(query.get(key)?.as_object()?, &Dimension::default())).ok()?.build(key, meshes).ok()
}

/// The numbers in a field of an object.
pub(crate) fn vector<V: Space<Scalar = f64>>(object: Option<&Value>) -> V {
    let coordinate = |i| object.and_then(|v| v.get(i)).and_then(Value::as_f64).unwrap_or_default();
    V::from_fn(coordinate)
}

/// The coordinates of a vector.
pub(crate) fn coordinates<V: Space<Scalar = f64>>(v: V) -> Vec<f64> {
    (0..V::DIM).map(|i| v.get(i)).collect()
}

/// A question whose search can be watched.
struct Asked<'q, V: Space> {
    query: &'q Object,
    name: &'q str,
    a: Option<Solid<V>>,
    b: Option<Solid<V>>,
    target: Option<Solid<V>>,
}

impl<'q, V: Space<Scalar = f64>> Asked<'q, V> {
    fn new(query: &'q Object, meshes: &Meshes) -> Option<Self> {
        let [a, b, target] = ["a", "b", "target"].map(|key| shape(query, key, meshes));
        Some(Self { query, name: query.get("query")?.as_str()?, a, b, target })
    }

    fn run(&self) -> Option<Value> {
        match self.name {
            "distance" => self.distance(),
            "signed_distance" => self.signed_distance(),
            "ray_cast" => self.ray_cast(),
            "linear_cast" => self.linear_cast(),
            "motion_cast" => self.motion_cast(),
            _ => None,
        }
    }

    fn number(&self, key: &str) -> Option<f64> {
        self.query.get(key)?.as_f64()
    }

    fn text(&self, key: &str) -> &str {
        self.query.get(key).and_then(Value::as_str).unwrap_or_default()
    }

    fn sub_algorithm(&self) -> SubAlgorithm {
        match self.text("_sub_algorithm") {
            "nearest_face" => SubAlgorithm::NearestFace,
            "johnson" => SubAlgorithm::Johnson,
            "signed_volumes" => SubAlgorithm::SignedVolumes,
            _ => SubAlgorithm::Regions,
        }
    }

    fn method(&self) -> CastMethod {
        if self.text("_search") == "algorithm_3" { CastMethod::Gjk } else { CastMethod::Portal }
    }

    fn pair(&self) -> Option<(&Solid<V>, &Solid<V>)> {
        self.a.as_ref().zip(self.b.as_ref())
    }

    fn distance(&self) -> Option<Value> {
        let (a, b) = self.pair()?;
        let mut options = DistanceOptions::new().with_sub_algorithm(self.sub_algorithm());
        options.tolerance = self.number("tol").unwrap_or(options.tolerance);
        let mut seen = Vec::new();
        let radii = a.core().radius + b.core().radius;
        let d = distance_with(a, b, options, |iterate| seen.push(of_difference(iterate, radii, 0.0)));
        Some(told(seen, d.distance, [d.lower, d.upper], d.status, d.iterations))
    }

    fn signed_distance(&self) -> Option<Value> {
        let (a, b) = self.pair()?;
        let mut options = SignedDistanceOptions::new();
        options.tolerance = self.number("tol").unwrap_or(options.tolerance);
        let mut seen = Vec::new();
        let radii = a.core().radius + b.core().radius;
        let least = f64::NEG_INFINITY;
        let d = signed_distance_with(a, b, options, |iterate| seen.push(of_difference(iterate, radii, least)));
        Some(told(seen, d.signed_distance, [d.lower, d.upper], d.status, d.iterations))
    }

    fn ray_cast(&self) -> Option<Value> {
        let target = self.target.as_ref()?;
        let ray = Ray { source: vector::<V>(self.query.get("source")), direction: vector(self.query.get("direction")) };
        let mut options = RayCastOptions::new().with_method(self.method()).with_sub_algorithm(self.sub_algorithm());
        options.min_lambda = self.number("min_lambda").unwrap_or(options.min_lambda);
        options.max_lambda = self.number("max_lambda").unwrap_or(options.max_lambda);
        options.tolerance = self.number("tol").unwrap_or(options.tolerance);
        let mut seen = Vec::new();
        let watch = |iterate: Iterate<'_, V>| seen.push(of_cast(ray, iterate));
        let cast = if self.text("method") == "iterative" {
            let to_point = |x: Point<V>| {
                let d = distance(target, &x, DistanceOptions::new());
                d.normal.map_or(d.point_a, |normal| x.at() + normal * d.distance)
            };
            iterative_ray_cast_with(|x| Point::new(x).ok().map(to_point), ray, options, watch)
        } else {
            ray_cast_with(target, ray, options, watch)
        };
        let cast = cast.ok()?;
        let lambda = hit(cast.outcome, |hit| hit.lambda);
        Some(told(seen, lambda, [cast.lower, cast.upper], cast.status, cast.iterations))
    }

    fn linear_cast(&self) -> Option<Value> {
        let (a, b) = self.pair()?;
        let [velocity_a, velocity_b] = ["velocity_a", "velocity_b"].map(|key| vector::<V>(self.query.get(key)));
        let mut options = LinearCastOptions::new().with_method(self.method()).with_sub_algorithm(self.sub_algorithm());
        options.max_time = self.number("max_time").unwrap_or(options.max_time);
        options.target_distance = self.number("target_distance").unwrap_or(options.target_distance);
        options.tolerance = self.number("tol").unwrap_or(options.tolerance);
        let ray = Ray { source: V::ZERO, direction: velocity_b - velocity_a };
        let mut seen = Vec::new();
        let watch = |iterate: Iterate<'_, V>| seen.push(of_cast(ray, iterate));
        let cast = linear_cast_with(a, b, Motion { velocity_a, velocity_b }, options, watch).ok()?;
        let time = hit(cast.outcome, |hit| hit.time);
        Some(told(seen, time, [cast.lower, cast.upper], cast.status, cast.iterations))
    }

    fn motion_cast(&self) -> Option<Value> {
        let (a, b) = self.pair()?;
        let motion = |key: &str| {
            let written = self.query.get(key);
            let field = |key: &str| written.and_then(|motion| motion.get(key));
            let angular = field("angular_velocity").map(|rate| match rate.as_f64() {
                Some(rate) => xtask::wire::fields::AngularVelocity::Rate(rate),
                None => xtask::wire::fields::AngularVelocity::Vector(
                    [0, 1, 2].map(|i| rate.get(i).and_then(Value::as_f64).unwrap_or_default()),
                ),
            });
            let angular_velocity = angular.map(V::angular_velocity).unwrap_or_default();
            RigidMotion { velocity: vector::<V>(field("velocity")), angular_velocity, center: vector(field("center")) }
        };
        let options = MotionCastOptions::new().with_max_time(self.number("max_time")?);
        let options = options.with_target_distance(self.number("target_distance").unwrap_or_default());
        let mut seen = Vec::new();
        let watch = |iterate: MotionIterate<V>| {
            let MotionIterate { time, gap, normal, lower, upper, .. } = iterate;
            seen.push(json!({
                "time": time, "gap": gap, "normal": coordinates(normal), "lower": lower, "upper": finite(upper)
            }));
        };
        let cast = motion_cast_with(a, motion("motion_a"), b, motion("motion_b"), options, watch).ok()?;
        let time = hit(cast.outcome, |hit| hit.time);
        Some(told(seen, time, [cast.lower, cast.upper], cast.status, cast.iterations))
    }
}

/// A number that JSON can hold, or null.
fn finite(value: f64) -> Value {
    value.into()
}

/// The scalar of a hit; infinity for a miss, and NaN where nothing is decided.
fn hit<H, V>(outcome: Outcome<H, V>, scalar: impl FnOnce(H) -> f64) -> f64 {
    match outcome {
        Outcome::Hit(hit) => scalar(hit),
        Outcome::Miss(_) => f64::INFINITY,
        Outcome::Undecided => f64::NAN,
    }
}

fn told(seen: Vec<Value>, value: f64, [lower, upper]: [f64; 2], status: Status, iterations: usize) -> Value {
    let status = match status {
        Status::Converged => "converged",
        Status::IterationLimit => "iteration limit",
        Status::Stalled => "stalled",
    };
    json!({
        "iterates": seen, "value": finite(value), "lower": finite(lower), "upper": finite(upper),
        "status": status, "iterations": iterations,
    })
}

/// An iterate of a search for zero among the points of the difference, in the units of the world. Its bounds are those
/// of the cores, and bodies are nearer by their radii.
fn of_difference<V: Space<Scalar = f64>>(iterate: Iterate<'_, V>, radii: f64, least: f64) -> Value {
    let [lower, upper] = [iterate.lower, iterate.upper].map(|of_cores| (of_cores - radii).max(least));
    drawn(Iterate { lower, upper, ..iterate }, |p| p)
}

/// An iterate of a cast, whose points are `x − p` for the points `p` of the target; x is where the ray is at the lower
/// bound.
fn of_cast<V: Space<Scalar = f64>>(ray: Ray<V>, iterate: Iterate<'_, V>) -> Value {
    let x = ray.at(if iterate.lower.is_finite() { iterate.lower } else { 0.0 });
    let mut drawn = drawn(iterate, |p| x - p);
    drawn["x"] = coordinates(x).into();
    drawn
}

fn drawn<V: Space<Scalar = f64>>(iterate: Iterate<'_, V>, place: impl Fn(V) -> V) -> Value {
    let Iterate { simplex, v, w, scale, lower, upper, .. } = iterate;
    let at = |p: V| coordinates(place(p * scale));
    json!({
        "simplex": simplex.iter().map(|&p| at(p)).collect::<Vec<_>>(),
        "direction": coordinates(v), "v": at(v), "w": at(w), "lower": finite(lower), "upper": finite(upper),
    })
}

#[cfg(feature = "space")]
/// The weights of the points, pass by pass, and those of the answer.
fn enclosing(query: &Object) -> Option<Value> {
    let points: Vec<Vec<f64>> = query.get("points")?.as_array()?.iter().map(numbers).collect::<Option<_>>()?;
    let method = match query.get("method").and_then(Value::as_str) {
        Some("khachiyan") => EnclosingMethod::Khachiyan,
        Some("ellipsoid") => EnclosingMethod::EllipsoidAlgorithm,
        Some("dual_newton") => EnclosingMethod::DualReducedNewton,
        _ => EnclosingMethod::Newton,
    };
    let mut options = EnclosingOptions::default().with_method(method);
    let epsilon = ["epsilon", "tol"].iter().find_map(|key| query.get(*key)?.as_f64());
    options.epsilon = epsilon.unwrap_or(options.epsilon);
    let mut seen = Vec::new();
    let answer = enclosing_dyn_with(&points, options, |iterate| {
        let weights: Vec<(usize, f64)> = iterate.indices.iter().copied().zip(iterate.weights.iter().copied()).collect();
        seen.push(json!({ "lower": 0.0, "upper": finite(iterate.log_det_gap), "weights": weights }));
    })
    .ok()?;
    let weights: Vec<(usize, f64)> = answer.weights.iter().map(|weight| (weight.index, weight.weight)).collect();
    Some(json!({
        "iterates": seen, "weights": weights, "contacts": answer.contacts, "iterations": answer.iterations,
        "scans": answer.scans, "lower": 0.0, "upper": answer.log_det_gap,
    }))
}

#[cfg(feature = "space")]
fn numbers(list: &Value) -> Option<Vec<f64>> {
    list.as_array()?.iter().map(Value::as_f64).collect()
}
