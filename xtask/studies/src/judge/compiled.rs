//! The answers of `Box3D` and Jolt to the questions of the workloads, by the functions that `benches` times them with.
//!
//! The suite is not asked of them: their shapes are built for bodies of about a metre.

use std::time::Duration;

use benches::measure::Solver;
use serde_json::Value;
use workloads::Pose;
use workloads::pairs::{PAIR_NAMES, Pair};
use workloads::shapes::{SHAPE_NAMES, Shape};
use workloads::w1_ray_cast::{Ambiguity, Ray};
use workloads::w2_linear_cast::Cast;
use workloads::w3_distance::DistanceQuery;
use workloads::w3b_intersect::IntersectQuery;
use xtask::judge::questions::{Question, SETS};
use xtask::judge::verdict::Claim;
use xtask::judge::witnesses::{MICROSECONDS, Reply, Witness, rounding};

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
            is_measured: true,
            settings: self.settings.to_owned(),
            replies: questions.iter().enumerate().map(reply).collect(),
        }
    }

    fn reply(&self, question: &Question) -> Option<Reply> {
        let solver = self.solver(question)?;
        let answer = *solver.answers().first()?;
        if answer.is_nan() {
            return Some(Reply::NoAnswer);
        }
        let claim = match question.object.get("query")?.as_str()? {
            "distance" => Claim { flag: None, scalar: Some(answer) },
            "intersect" => Claim { flag: Some(answer > 0.0), scalar: None },
            _ => Claim { flag: Some(answer.is_finite()), scalar: answer.is_finite().then_some(answer) },
        };
        let ns = solver.nanoseconds(0..COPIES, Duration::from_micros(3 * MICROSECONDS));
        Some(Reply::Answer { claim, ns })
    }

    /// The question, as often as it takes to be timed.
    fn solver(&self, question: &Question) -> Option<Solver> {
        let Question { set, case, object, .. } = question;
        if !SETS.contains(set) {
            return None;
        }
        let field = |name: &str| object.get(name);
        match field("query")?.as_str()? {
            "ray_cast" if SHAPE_NAMES.contains(&case.as_str()) => {
                let (origin, direction) = (numbers(field("source")?)?, numbers(field("direction")?)?);
                let ray = Ray { origin, direction, lambda: None, ambiguity: Ambiguity::None };
                (self.ray_casts)(&Shape::named(case), &[ray; COPIES])
            }
            query if PAIR_NAMES.contains(&case.as_str()) => {
                // The first of a pair rests at the origin.
                let b = field("b")?;
                let pose =
                    Pose { rotation: numbers(b.get("rotation")?)?, translation: numbers(b.get("translation")?)? };
                let (pair, nowhere) = (Pair::named(case), [0.0; 3]);
                match query {
                    "linear_cast" => {
                        let velocity = numbers(field("velocity_b")?)?;
                        let cast = Cast { pose, velocity, lambda: None, cosine_or_gap: 0.0 };
                        (self.linear_casts)(&pair, &[cast; COPIES])
                    }
                    "distance" => {
                        (self.distances)(&pair, &[DistanceQuery { pose, normal: nowhere, distance: 0.0 }; COPIES])
                    }
                    "intersect" => {
                        let query = IntersectQuery { pose, normal: nowhere, meet: false, moved: 0.0 };
                        (self.intersections)(&pair, &[query; COPIES])
                    }
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

/// Queries in a block that is timed.
const COPIES: usize = 100;

fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    numbers?.try_into().ok()
}
