//! The answers of `Box3D` and Jolt to the questions of the workloads, by the functions that `benches` times them with.
//!
//! The suite is not asked of them: their shapes are built for bodies of about a metre.

use std::time::Duration;

use benches::measure::Solver;
use convex_support::glam::{DAffine3, DQuat, DVec3};
use serde_json::Value;
use workloads::Pose;
use workloads::pairs::Pair;
use workloads::shapes::Shape;
use workloads::w1_ray_cast::{Ambiguity, Ray};
use workloads::w2_linear_cast::Cast;
use workloads::w3_distance::DistanceQuery;
use workloads::w3b_intersect::IntersectQuery;
use xtask::judge::questions::Question;
use xtask::judge::verdict::Claim;
use xtask::judge::witnesses::{MICROSECONDS, Reply, Witness, rounding};
use xtask::wire::fields::Object;

/// A library, by what it makes of some rays against a shape, or of some poses of a pair; `None` where it has no such
/// shape.
struct Library {
    name: &'static str,
    /// How far from contact its documentation lets an answer be, in metres.
    tolerance: f64,
    settings: &'static str,
    ray_casts: fn(&Shape, &[Ray]) -> Option<Solver>,
    linear_casts: fn(&Pair, &[Cast]) -> Option<Solver>,
    distances: fn(&Pair, &[DistanceQuery]) -> Option<Solver>,
    intersections: fn(&Pair, &[IntersectQuery]) -> Option<Solver>,
}

/// `Box3D`. Its turning casts move along arcs of its own, not at constant angular velocity, and are not asked.
#[cfg(feature = "box3d")]
pub(super) fn box3d(questions: &[Question], progress: impl FnMut(usize)) -> Witness {
    use benches::box3d::{distances, intersections, linear_casts, ray_casts};
    let library = Library {
        name: "Box3D f32",
        tolerance: 1.25 * 0.005,
        settings: "by boxddd 0.4, with lengths in metres: casts stop within one and a quarter of its linear slop of 5 mm from contact, \
                   bodies overlap from 0.5 mm on",
        ray_casts,
        linear_casts,
        distances,
        intersections,
    };
    library.witness(questions, progress)
}

/// Jolt, which has no distances.
#[cfg(feature = "jolt")]
pub(super) fn jolt(questions: &[Question], progress: impl FnMut(usize)) -> Witness {
    use benches::jolt::{intersections, linear_casts, ray_casts};
    let library = Library {
        name: "Jolt f32",
        tolerance: 1e-4,
        settings: "5.6 by oxijolt 1.5, through a world of one body, convex radii 0, back faces counted; bodies touch from its collision \
                   tolerance of 0.1 mm on",
        ray_casts,
        linear_casts,
        distances: |_, _| None,
        intersections,
    };
    library.witness(questions, progress)
}

impl Library {
    fn witness(&self, questions: &[Question], mut progress: impl FnMut(usize)) -> Witness {
        let reply = |(k, question): (usize, &Question)| {
            progress(k);
            self.reply(question).unwrap_or(Reply::NotAsked)
        };
        Witness {
            name: self.name.to_owned(),
            tolerance: self.tolerance,
            of_motion: 0.0,
            rounding: rounding("f32"),
            settings: self.settings.to_owned(),
            replies: questions.iter().enumerate().map(reply).collect(),
        }
    }

    fn reply(&self, question: &Question) -> Option<Reply> {
        let (solver, end) = self.solver(question)?;
        let answer = *solver.answers().first()?;
        if answer.is_nan() {
            return Some(Reply::NoAnswer);
        }
        let claim = match question.object.get("query")?.as_str()? {
            "distance" => Claim { flag: None, scalar: Some(answer) },
            "intersect" => Claim { flag: Some(answer > 0.0), scalar: None },
            _ => Claim { flag: Some(answer.is_finite()), scalar: answer.is_finite().then_some(answer * end) },
        };
        let ns = solver.nanoseconds(0..COPIES, Duration::from_micros(3 * MICROSECONDS));
        Some(Reply::Answer { claim, ns })
    }

    /// The question, as often as it takes to be timed; and the end of its ray or motion, which is one to these
    /// functions.
    fn solver(&self, question: &Question) -> Option<(Solver, f64)> {
        let Question { set, object, .. } = question;
        if set.starts_with("suite") {
            return None;
        }
        let vector = |name: &str| object.get(name).map_or(Some(DVec3::ZERO), |v| numbers(v).map(DVec3::from_array));
        let query = object.get("query")?.as_str()?;
        if query == "ray_cast" {
            let (shape, place) = posed(object.get("target")?)?;
            let back = place.inverse();
            let (source, direction) =
                (back.transform_point3(vector("source")?), back.transform_vector3(vector("direction")?));
            let end = end(object, "max_lambda", (source.length() + size(&shape)) / direction.length());
            let ray = Ray {
                origin: source.into(),
                direction: (direction * end).into(),
                lambda: None,
                ambiguity: Ambiguity::None,
            };
            return Some(((self.ray_casts)(&shape, &[ray; COPIES])?, end));
        }
        // The first of a pair rests at the origin.
        let ((a, at_a), (b, at_b)) = (posed(object.get("a")?)?, posed(object.get("b")?)?);
        let back = at_a.inverse();
        let (_, rotation, translation) = (back * at_b).to_scale_rotation_translation();
        let pose = Pose { rotation: rotation.to_array(), translation: translation.into() };
        let (pair, nowhere) = (Pair::new(a, b), [0.0; 3]);
        match query {
            "linear_cast" => {
                let velocity = back.transform_vector3(vector("velocity_b")? - vector("velocity_a")?);
                // These functions cast along a direction, which bodies at rest do not have.
                if velocity == DVec3::ZERO {
                    return None;
                }
                let way = translation.length() + size(&pair.a) + size(&pair.b);
                let end = end(object, "max_time", way / velocity.length());
                let cast = Cast { pose, velocity: (velocity * end).into(), lambda: None, cosine_or_gap: 0.0 };
                Some(((self.linear_casts)(&pair, &[cast; COPIES])?, end))
            }
            "distance" => {
                let query = DistanceQuery { pose, normal: nowhere, distance: 0.0 };
                Some(((self.distances)(&pair, &[query; COPIES])?, 1.0))
            }
            "intersect" => {
                let query = IntersectQuery { pose, normal: nowhere, meet: false, moved: 0.0 };
                Some(((self.intersections)(&pair, &[query; COPIES])?, 1.0))
            }
            _ => None,
        }
    }
}

/// The end that a question gives; if it gives none, twice that which passes the body for certain.
fn end(object: &Object, name: &str, passed: f64) -> f64 {
    object.get(name).and_then(Value::as_f64).unwrap_or(2.0 * passed)
}

/// A shape of the workloads and its place; `None` for others.
fn posed(value: &Value) -> Option<(Shape, DAffine3)> {
    let number = |name: &str| value.get(name)?.as_f64();
    let half_extents = |of: &Value| numbers(of.get("half_extents")?);
    let shape = match value.get("type")?.as_str()? {
        "posed" => {
            let (shape, within) = posed(value.get("of")?)?;
            let rotation = value.get("rotation").map_or(Some([0.0, 0.0, 0.0, 1.0]), numbers)?;
            let translation = value.get("translation").map_or(Some([0.0; 3]), numbers)?;
            let rotation = DQuat::from_array(rotation).normalize();
            return Some((shape, DAffine3::from_rotation_translation(rotation, translation.into()) * within));
        }
        "ball" => Shape::Ball { radius: number("radius")? },
        "cuboid" => Shape::Cuboid { half_extents: half_extents(value)? },
        "cylinder" => Shape::Cylinder { half_height: number("half_height")?, radius: number("radius")? },
        "cone" => Shape::Cone { half_height: number("half_height")?, radius: number("radius")? },
        "capsule" => Shape::Capsule { half_height: number("half_height")?, radius: number("radius")? },
        "polytope" => {
            Shape::Hull { points: value.get("points")?.as_array()?.iter().map(numbers).collect::<Option<_>>()? }
        }
        "rounded" => Shape::RoundBox { half_extents: half_extents(value.get("of")?)?, radius: number("radius")? },
        _ => return None,
    };
    Some((shape, DAffine3::IDENTITY))
}

/// No point of a shape is farther from its origin.
fn size(shape: &Shape) -> f64 {
    let length = |point: &[f64; 3]| DVec3::from(*point).length();
    match shape {
        Shape::Ball { radius } => *radius,
        Shape::Cuboid { half_extents } => length(half_extents),
        Shape::Cylinder { half_height, radius }
        | Shape::Cone { half_height, radius }
        | Shape::Capsule { half_height, radius } => half_height + radius,
        Shape::Ellipsoid { semi_axes } => length(semi_axes),
        Shape::Hull { points } => points.iter().map(length).fold(0.0, f64::max),
        Shape::RoundBox { half_extents, radius } => length(half_extents) + radius,
    }
}

/// Queries in a block that is timed.
const COPIES: usize = 100;

fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    numbers?.try_into().ok()
}
