//! What is asked of everybody: samples of the workloads, and the embedded suite, as queries of the query format.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use crate::EMBEDDED;
use crate::engine;
use crate::mesh::Meshes;
use crate::validate::score::scalar_of;
use crate::wire::fields::Object;
use crate::wire::json;
use serde_json::{Value, json};
use workloads::pairs::{PAIR_NAMES, Pair};
use workloads::rng::Rng;
use workloads::shapes::{SHAPE_NAMES, Shape};
use workloads::vec3::scale;
use workloads::{Pose, w1_ray_cast, w2_linear_cast, w3_distance, w3b_intersect};

/// A question to everybody.
#[derive(Clone, Debug)]
pub struct Question {
    /// What answers refer to.
    pub id: String,
    /// The kind of questions that it is counted among.
    pub set: &'static str,
    pub object: Object,
    /// The answer known by construction, or in ninety digits: of the scalar that the query asks for.
    pub truth: Option<f64>,
}

/// The kinds of questions of the workloads, in their order.
pub const SETS: [&str; 7] =
    ["ray cast", "linear cast", "turning cast", "distance", "distance of 1e-6", "overlap", "depth"];

/// The kinds of queries of the suite that somebody else might answer, and the sets they make.
const SUITE: [(&str, &str); 6] = [
    ("ray_cast", "suite: ray cast"),
    ("linear_cast", "suite: linear cast"),
    ("motion_cast", "suite: turning cast"),
    ("distance", "suite: distance"),
    ("signed_distance", "suite: depth"),
    ("intersect", "suite: overlap"),
];

/// `each` questions of each case of the workloads, evenly spread, and all of the suite.
#[must_use]
pub fn all(each: usize) -> Vec<Question> {
    let mut questions = of_workloads(each);
    suite(&mut questions);
    questions
}

/// `each` questions of each case of the workloads, evenly spread.
#[must_use]
pub fn of_workloads(each: usize) -> Vec<Question> {
    let mut questions = Vec::new();
    for case in SHAPE_NAMES {
        ray_casts(case, each, &mut questions);
    }
    for case in PAIR_NAMES {
        let pair = Pair::named(case);
        linear_casts(case, &pair, each, &mut questions);
        distances(case, &pair, each, &mut questions);
        overlaps(case, &pair, each, &mut questions);
    }
    questions
}

/// The questions of a file whose lines have ids.
///
/// # Errors
/// What is wrong with the file, as a sentence.
pub fn of_file(path: &Path) -> Result<Vec<Question>, String> {
    let text = fs::read_to_string(path).map_err(|why| format!("cannot read {}: {why}", path.display()))?;
    let read = |line: &str| {
        let object = json::object(line.as_bytes()).map_err(|why| format!("{}: {}", path.display(), why.message))?;
        let id = object.get("id").and_then(Value::as_str).ok_or_else(|| format!("a line has no id: {line}"))?;
        Ok(Question { id: id.to_owned(), set: "file", object, truth: None })
    };
    text.lines().filter(|line| !line.starts_with('#')).map(read).collect()
}

/// About `count` of the items, evenly spread.
fn spread<T>(items: &[T], count: usize) -> impl Iterator<Item = (usize, &T)> {
    items.iter().enumerate().step_by((items.len() / count.max(1)).max(1)).take(count)
}

fn question(set: &'static str, case: &str, number: usize, body: Value, truth: Option<f64>) -> Question {
    let id = format!("{set}/{case}/{number}").replace(' ', "-");
    let Value::Object(mut object) = body else { unreachable!("a query is an object") };
    object.insert("id".to_owned(), Value::from(id.as_str()));
    Question { id, set, object, truth }
}

fn ray_casts(case: &str, each: usize, questions: &mut Vec<Question>) {
    let target = written(&Shape::named(case));
    let rays = w1_ray_cast::rays(case);
    questions.extend(spread(&rays, each).map(|(k, ray)| {
        let body = json!({"query": "ray_cast", "target": target, "source": ray.origin, "direction": ray.direction, "max_lambda": 1.0});
        question(SETS[0], case, k, body, ray.lambda)
    }));
}

/// Casts of straight motions; and half as many in which the body that moves turns about its middle, by 1 to 3 in the
/// same time.
fn linear_casts(case: &str, pair: &Pair, each: usize, questions: &mut Vec<Question>) {
    let (a, casts) = (written(&pair.a), w2_linear_cast::casts(pair));
    for (k, cast) in spread(&casts, each) {
        let b = posed(&pair.b, cast.pose);
        let body = json!({"query": "linear_cast", "a": a, "b": b, "velocity_b": cast.velocity, "max_time": 1.0});
        questions.push(question(SETS[1], case, k, body, cast.lambda));
    }
    let mut rng = Rng::new(7000);
    for (k, cast) in spread(&casts, each / 2) {
        let angular_velocity = scale(rng.sphere(), 1.0 + 2.0 * rng.unit());
        let motion =
            json!({"velocity": cast.velocity, "angular_velocity": angular_velocity, "center": cast.pose.translation});
        let b = posed(&pair.b, cast.pose);
        let body = json!({"query": "motion_cast", "a": a, "b": b, "motion_b": motion, "max_time": 1.0});
        questions.push(question(SETS[2], case, k, body, None));
    }
}

fn distances(case: &str, pair: &Pair, each: usize, questions: &mut Vec<Question>) {
    let (a, queries) = (written(&pair.a), w3_distance::queries(pair));
    let (far, near) = queries.split_at(w3_distance::FAR);
    for (set, queries, count) in [(SETS[3], far, each), (SETS[4], near, each / 2)] {
        questions.extend(spread(queries, count).map(|(k, query)| {
            let body = json!({"query": "distance", "a": a, "b": posed(&pair.b, query.pose)});
            question(set, case, k, body, Some(query.distance))
        }));
    }
}

/// Whether bodies overlap; and where they do, how deep, of half as many.
fn overlaps(case: &str, pair: &Pair, each: usize, questions: &mut Vec<Question>) {
    let (a, queries) = (written(&pair.a), w3b_intersect::queries(pair));
    let ask = |name: &str, query: &w3b_intersect::IntersectQuery| json!({"query": name, "a": a, "b": posed(&pair.b, query.pose)});
    questions
        .extend(spread(&queries, each).map(|(k, query)| question(SETS[5], case, k, ask("intersect", query), None)));
    let deep: Vec<_> = queries.iter().filter(|query| query.meet).collect();
    questions.extend(
        spread(&deep, each / 2).map(|(k, query)| question(SETS[6], case, k, ask("signed_distance", query), None)),
    );
}

/// The cases of the suite in double precision that can be asked of everybody: neither methods and tolerances of ours,
/// nor files.
fn suite(questions: &mut Vec<Question>) {
    let Ok(folder) = fs::read_dir(EMBEDDED) else { return };
    let mut files: Vec<_> = folder.flatten().map(|entry| entry.path()).collect();
    files.sort();
    for file in files.into_iter().filter(|file| file.extension().is_some_and(|e| e == "jsonl")) {
        let case = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let meshes = Arc::new(Meshes::relative_to(EMBEDDED));
        for (k, line) in fs::read_to_string(&file).unwrap_or_default().lines().enumerate() {
            let Ok(mut object) = json::object(line.as_bytes()) else { continue };
            let name = object.get("query").and_then(Value::as_str).unwrap_or_default().to_owned();
            let Some(&(_, set)) = SUITE.iter().find(|(query, _)| *query == name) else { continue };
            let options = ["precision", "method", "tol", "min_lambda", "target_distance", "start_in_contact"];
            let ours = options.iter().any(|option| object.contains_key(*option))
                || ["mesh", "half_space"].iter().any(|shape| line.contains(&format!("\"{shape}\"")));
            if ours || engine::question(&object, &meshes).is_err() {
                continue;
            }
            let expect = object.remove("expect");
            if expect.as_ref().is_some_and(|expect| expect.get("error").is_some()) {
                continue;
            }
            let scalar = scalar_of(&name);
            let truth = scalar.and_then(|name| expect.as_ref()?.get(name)?.as_f64());
            for field in ["allow", "allow_fields", "tags"] {
                object.remove(field);
            }
            questions.push(question(set, &case, k + 1, Value::Object(object), truth));
        }
    }
}

/// A shape of the workloads in the query format.
fn written(shape: &Shape) -> Value {
    match shape {
        Shape::Ball { radius } => json!({"type": "ball", "radius": radius}),
        Shape::Cuboid { half_extents } => json!({"type": "cuboid", "half_extents": half_extents}),
        Shape::Cylinder { half_height, radius } => {
            json!({"type": "cylinder", "half_height": half_height, "radius": radius})
        }
        Shape::Cone { half_height, radius } => json!({"type": "cone", "half_height": half_height, "radius": radius}),
        Shape::Capsule { half_height, radius } => {
            json!({"type": "capsule", "half_height": half_height, "radius": radius})
        }
        Shape::Ellipsoid { semi_axes } => json!({"type": "ellipsoid", "center": [0, 0, 0], "semi_axes": semi_axes}),
        Shape::Hull { points } => json!({"type": "polytope", "points": points}),
        Shape::RoundBox { half_extents, radius } => {
            json!({"type": "rounded", "radius": radius, "of": {"type": "cuboid", "half_extents": half_extents}})
        }
    }
}

fn posed(shape: &Shape, pose: Pose) -> Value {
    json!({"type": "posed", "translation": pose.translation, "rotation": pose.rotation, "of": written(shape)})
}

/// A set of questions as a reader says it.
#[must_use]
pub fn asked_as(set: &str) -> &str {
    if set == "distance of 1e-6" { "near contact" } else { set }
}
