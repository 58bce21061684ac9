// Included twice by `parry.rs`, once for each of the two crates called `parry` there.

use cpu_time::ThreadTime;
use parry::math::{Pose, Real, Rotation, Vector};
use parry::query::{self, NonlinearRigidMotion, Ray, RayCast, ShapeCastOptions};
use parry::shape::{
    Ball, Capsule, Cone, ConvexPolyhedron, Cuboid, Cylinder, RoundCuboid, Segment, Shape, Triangle,
};
use serde_json::Value;
use xtask::wire::fields::Object;

use xtask::judge::questions::Question;
use xtask::judge::verdict::Claim;
use xtask::judge::witnesses::{MICROSECONDS, Reply, Witness, rounding};

/// All its answers. Its tolerance is that of its GJK, relative, and below what is nobody's mistake.
pub(crate) fn witness(questions: &[Question], mut progress: impl FnMut(usize)) -> Witness {
    let precision = if size_of::<Real>() == 4 { "f32" } else { "f64" };
    let reply = |(k, question): (usize, &Question)| {
        progress(k);
        prepared(&question.object).map_or(Reply::NotAsked, |prepared| timed(&*prepared))
    };
    Witness {
        name: format!("parry {precision}"),
        tolerance: 0.0,
        of_motion: 0.0,
        rounding: rounding(precision),
        settings: "0.31.1; query::{cast_shapes, cast_shapes_nonlinear, distance, contact, intersection_test} and RayCast, \
                   with the tolerances that they come with"
            .to_owned(),
        replies: questions.iter().enumerate().map(reply).collect(),
    }
}

/// A query with its shapes built; none where parry found no answer.
type Prepared = Box<dyn Fn() -> Option<Claim>>;

fn timed(query: &dyn Fn() -> Option<Claim>) -> Reply {
    let run = |count: u64| {
        let start = ThreadTime::now();
        for _ in 0..count {
            std::hint::black_box(query());
        }
        start.elapsed().as_nanos() as f64 / count as f64
    };
    match query() {
        Some(claim) if claim.scalar.is_none_or(f64::is_finite) => {
            let once = run(1).max(1.0);
            let count = ((MICROSECONDS * 1000) as f64 / once).ceil() as u64;
            Reply::Answer { claim, ns: (0..3).map(|_| run(count)).fold(once, f64::min) }
        }
        _ => Reply::NoAnswer,
    }
}

/// The query as parry's; none where it has no such shape or question.
fn prepared(object: &Object) -> Option<Prepared> {
    match object.get("query")?.as_str()? {
        "ray_cast" => ray_cast(object),
        "linear_cast" => linear_cast(object),
        "motion_cast" => motion_cast(object),
        "distance" => {
            let [(at_a, a), (at_b, b)] = both(object)?;
            Some(Box::new(move || {
                let distance = query::distance(&at_a, &*a, &at_b, &*b).ok()?.distance;
                Some(Claim { flag: None, scalar: Some(f64::from(distance)) })
            }))
        }
        "intersect" => {
            let [(at_a, a), (at_b, b)] = both(object)?;
            Some(Box::new(move || {
                let answer = query::intersection_test(&at_a, &*a, &at_b, &*b).ok()?;
                Some(Claim { flag: Some(answer.intersecting), scalar: None })
            }))
        }
        "signed_distance" => {
            let [(at_a, a), (at_b, b)] = both(object)?;
            // What is farther apart has no contact; no scene here is as large.
            let prediction = number(1e6);
            Some(Box::new(move || {
                let depth = query::contact(&at_a, &*a, &at_b, &*b, prediction).ok()??.dist;
                Some(Claim { flag: Some(depth <= 0.0), scalar: Some(f64::from(depth)) })
            }))
        }
        _ => None,
    }
}

fn cast(time: Option<f64>) -> Claim {
    Claim { flag: Some(time.is_some()), scalar: time }
}

fn ray_cast(object: &Object) -> Option<Prepared> {
    let (at, target) = shape(object.get("target")?)?;
    let ray = Ray::new(vector(object.get("source")?)?, vector(object.get("direction")?)?);
    let most = limit(object, "max_lambda");
    Some(Box::new(move || Some(cast(RayCast::cast_ray(&*target, &at, &ray, most, true).map(f64::from)))))
}

fn linear_cast(object: &Object) -> Option<Prepared> {
    let [(at_a, a), (at_b, b)] = both(object)?;
    let velocity = |name: &str| object.get(name).map_or(Some(Vector::ZERO), vector);
    let (of_a, of_b) = (velocity("velocity_a")?, velocity("velocity_b")?);
    let options = ShapeCastOptions::with_max_time_of_impact(limit(object, "max_time"));
    Some(Box::new(move || {
        let hit = query::cast_shapes(&at_a, of_a, &*a, &at_b, of_b, &*b, options).ok()?;
        Some(cast(hit.map(|hit| f64::from(hit.time_of_impact))))
    }))
}

/// A motion turns the body about a point that moves; parry's turns it about a point of the body.
fn motion_cast(object: &Object) -> Option<Prepared> {
    let [(at_a, a), (at_b, b)] = both(object)?;
    let motion = |name: &str, at: Pose| {
        let Some(motion) = object.get(name) else { return Some(NonlinearRigidMotion::constant_position(at)) };
        let part = |field: &str| motion.get(field).map_or(Some(Vector::ZERO), vector);
        let center = at.inverse() * part("center")?;
        Some(NonlinearRigidMotion::new(at, center, part("velocity")?, part("angular_velocity")?))
    };
    let (of_a, of_b) = (motion("motion_a", at_a)?, motion("motion_b", at_b)?);
    let most = limit(object, "max_time");
    Some(Box::new(move || {
        let hit = query::cast_shapes_nonlinear(&of_a, &*a, &of_b, &*b, 0.0, most, true).ok()?;
        Some(cast(hit.map(|hit| f64::from(hit.time_of_impact))))
    }))
}

fn limit(object: &Object, field: &str) -> Real {
    object.get(field).and_then(Value::as_f64).map_or(Real::MAX, number)
}

/// A shape where it is.
type Placed = (Pose, Box<dyn Shape>);

fn both(object: &Object) -> Option<[Placed; 2]> {
    Some([shape(object.get("a")?)?, shape(object.get("b")?)?])
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::unnecessary_cast,
    trivial_numeric_casts,
    reason = "`Real` is f32 here, f64 there"
)]
fn number(x: f64) -> Real {
    x as Real
}

fn vector(value: &Value) -> Option<Vector> {
    let [x, y, z] = value.as_array()?.as_slice() else { return None };
    Some(Vector::new(number(x.as_f64()?), number(y.as_f64()?), number(z.as_f64()?)))
}

/// The shape of the query format as parry's; none where it has none, in 2D or without a body.
fn shape(value: &Value) -> Option<Placed> {
    let real = |field: &str| value.get(field)?.as_f64().map(number);
    let corners = || value.get("points")?.as_array()?.iter().map(vector).collect::<Option<Vec<_>>>();
    let here = |shape: Box<dyn Shape>| Some((Pose::IDENTITY, shape));
    match value.get("type")?.as_str()? {
        "point" => Some((Pose::from_parts(vector(value.get("at")?)?, Rotation::IDENTITY), Box::new(Ball::new(0.0)))),
        "ball" => here(Box::new(Ball::new(real("radius")?))),
        "cuboid" => here(Box::new(Cuboid::new(vector(value.get("half_extents")?)?))),
        "capsule" => here(Box::new(Capsule::new_y(real("half_height")?, real("radius")?))),
        "cylinder" => here(Box::new(Cylinder::new(real("half_height")?, real("radius")?))),
        "cone" => here(Box::new(Cone::new(real("half_height")?, real("radius")?))),
        "polytope" => here(Box::new(ConvexPolyhedron::from_convex_hull(&corners()?)?)),
        "segment" => match corners()?.as_slice() {
            [a, b] => here(Box::new(Segment::new(*a, *b))),
            _ => None,
        },
        "triangle" => match corners()?.as_slice() {
            [a, b, c] => here(Box::new(Triangle::new(*a, *b, *c))),
            _ => None,
        },
        "rounded" => {
            let (radius, inner) = (real("radius")?, value.get("of")?);
            match inner.get("type")?.as_str()? {
                "cuboid" => here(Box::new(RoundCuboid {
                    inner_shape: Cuboid::new(vector(inner.get("half_extents")?)?),
                    border_radius: radius,
                })),
                "point" => Some((
                    Pose::from_parts(vector(inner.get("at")?)?, Rotation::IDENTITY),
                    Box::new(Ball::new(radius)),
                )),
                _ => None,
            }
        }
        "posed" => {
            let (within, of) = shape(value.get("of")?)?;
            let translation = value.get("translation").map_or(Some(Vector::ZERO), vector)?;
            Some((Pose::from_parts(translation, rotation(value.get("rotation"))?) * within, of))
        }
        _ => None,
    }
}

fn rotation(value: Option<&Value>) -> Option<Rotation> {
    let Some(value) = value else { return Some(Rotation::IDENTITY) };
    let [x, y, z, w] = value.as_array()?.as_slice() else { return None };
    // Any length is allowed in the format.
    let q = [x.as_f64()?, y.as_f64()?, z.as_f64()?, w.as_f64()?];
    let length = q.iter().map(|c| c * c).sum::<f64>().sqrt();
    Some(Rotation::from_array(q.map(|c| number(c / length))))
}
