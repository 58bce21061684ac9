//! What answers say of themselves: random bodies of every kind, mostly near contact, rays at surfaces, and motions that
//! end at their own hit, held to the laws of gjk-raycast.

use std::collections::BTreeMap;

use gjk_raycast::laws::Report;
use serde_json::{Value, json};
use workloads::rng::Rng;

use crate::claims;
use crate::draw::{self, KINDS, decades, with};
use crate::engine;
use crate::judge::fact::ask;
use crate::mesh::Meshes;
use crate::validate::score;
use crate::wire::answer::{Line, as_read};
use crate::wire::fields::Object;

/// The queries that have laws, each as often as it is named.
const QUERIES: [&str; 10] = [
    "ray_cast",
    "ray_cast",
    "ray_cast",
    "signed_distance",
    "signed_distance",
    "signed_distance",
    "linear_cast",
    "linear_cast",
    "contact",
    "motion_cast",
];

/// Which queries to draw; all, where nothing is chosen.
#[derive(Clone, Debug, Default)]
pub(super) struct Choice {
    pub(super) precision: Option<String>,
    pub(super) dimension: Option<usize>,
    pub(super) query: Option<String>,
}

/// What was asked of a kind of query.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub(super) asked: u64,
    pub(super) claims: u64,
    /// The widest converged bracket, as a part of what is allowed.
    pub(super) widest: f64,
}

/// What was asked, by query, precision and dimension.
pub(super) type Tallies = BTreeMap<String, Tally>;

/// Draws a query and holds its answers to the laws.
pub(super) fn case(choice: &Choice, rng: &mut Rng, tallies: &mut Tallies) -> Result<(), String> {
    let precision = choice.precision.as_deref().unwrap_or(["f32", "f64"][rng.below(2) as usize]);
    let dimension = choice.dimension.unwrap_or(2 + rng.below(2) as usize);
    let query = choice.query.as_deref().unwrap_or(QUERIES[rng.below(QUERIES.len() as u64) as usize]);
    let line = line(query, precision, dimension, rng);
    let starts: Vec<_> = (0..2).map(|_| direction(dimension, rng)).collect();
    let Value::Object(object) = &line else { return Ok(()) };
    let Some(report) = claims::of(object, &starts, &Meshes::relative_to("")) else { return Ok(()) };
    count(&report, &format!("{precision} {dimension}D"), tallies);
    if let Some(wrong) = expected(object).first() {
        return Err(format!("BROKEN Certain of {query}, by construction: {wrong}\n  {line}"));
    }
    told(&report, &line)
}

/// What is wrong with the answer to a query that says what is expected of it.
fn expected(query: &Object) -> Vec<String> {
    let Ok(question) = engine::question(query, &Meshes::relative_to("")) else { return Vec::new() };
    let answer = as_read(Line { id: None, line: 0, outcome: question.ask() });
    let is_undecided = answer.contains_key("error");
    if is_undecided { Vec::new() } else { score::judge(query, &answer).wrong }
}

/// A failure, with the line that shows it.
pub(super) fn told(report: &Report, line: &Value) -> Result<(), String> {
    let mut laws: Vec<_> = report.broken.iter().map(|broken| format!("{:?} of {}", broken.law, broken.query)).collect();
    laws.sort();
    laws.dedup();
    match report.broken.first() {
        Some(first) => Err(format!("BROKEN {}: {first}\n  {line}", laws.join(", "))),
        None => Ok(()),
    }
}

fn count(report: &Report, space: &str, tallies: &mut Tallies) {
    let all = tallies.entry(format!("all {space}")).or_default();
    all.asked += 1;
    all.claims += report.examined;
    for (query, widest) in &report.widest {
        let entry = tallies.entry(format!("{query} {space}")).or_default();
        entry.asked += 1;
        entry.widest = entry.widest.max(*widest);
    }
}

fn direction(dimension: usize, rng: &mut Rng) -> [f64; 3] {
    // In single precision too, the same numbers.
    let mut d = rng.cube().map(|x| f64::from((x * 1024.0).round() as f32) / 1024.0);
    if rng.below(4) == 0 {
        d = [0.0; 3];
        d[rng.below(dimension as u64) as usize] = 1.0;
    }
    if dimension == 2 {
        d[2] = 0.0;
    }
    if d == [0.0; 3] { [1.0, 0.0, 0.0] } else { d }
}

/// A query of a kind, with its bodies brought together.
fn line(query: &str, precision: &str, dimension: usize, rng: &mut Rng) -> Value {
    let kind = KINDS.iter().copied().find(|(name, _)| *name == query).unwrap_or(KINDS[0]);
    let mut line = draw::query(kind, precision, dimension, rng);
    let is_ray = line.get("target").is_some();
    for name in if is_ray { &["target"][..] } else { &["a", "b"] } {
        if line[*name]["type"] == "half_space" || rng.below(3) == 0 {
            line[*name] = special(precision, dimension, rng);
        }
    }
    if let Value::Object(fields) = &mut line {
        fields.remove("gradient");
        fields.remove("method");
    }
    if is_ray { aimed(line, dimension, rng) } else { brought_together(line, dimension, rng) }
}

/// Shapes that are easily told wrong: balls that are called ellipsoids, specks, needles and plates, boxes and hulls of
/// whole numbers.
fn special(precision: &str, dimension: usize, rng: &mut Rng) -> Value {
    let vector = |rng: &mut Rng, most: f64| (0..dimension).map(|_| most * rng.signed()).collect::<Vec<_>>();
    let whole = |rng: &mut Rng, most: i64| {
        let mut one = || (rng.below(2 * most.unsigned_abs() + 1) as i64 - most) as f64;
        (0..dimension).map(|_| one()).collect::<Vec<_>>()
    };
    let aspect = if precision == "f32" { 4.0 } else { 7.0 };
    let turned = |of: Value, rng: &mut Rng| {
        let rotation = if dimension == 2 { json!(7.0 * rng.signed()) } else { json!(rng.quat()) };
        json!({"type": "posed", "rotation": rotation, "of": of})
    };
    let flat = dimension == 2;
    match rng.below(8) {
        0 => {
            let mut axes = vec![[1.0, 0.5, 2.0, 1.25][rng.below(4) as usize]; dimension];
            if rng.below(2) == 0 {
                axes[0] *= [1.0 + 1e-6, 1.5, 0.5, 1.0 + 1e-2][rng.below(4) as usize];
            }
            json!({"type": "ellipsoid", "center": whole(rng, 2), "semi_axes": axes})
        }
        1 => json!({"type": "point", "at": whole(rng, 5)}),
        2 => {
            let (least, at) = (if precision == "f32" { -25 } else { -150 }, whole(rng, 3));
            let radius = 2.0_f64.powi(-(rng.below((-least) as u64) as i32));
            match rng.below(3) {
                0 => json!({"type": "posed", "translation": at, "of": {"type": "ball", "radius": radius}}),
                1 => {
                    json!({"type": "posed", "translation": at, "of": {"type": "cuboid", "half_extents": vec![radius; dimension]}})
                }
                _ => json!({"type": "ellipsoid", "center": at, "semi_axes": vec![radius; dimension]}),
            }
        }
        3 | 4 => {
            let long = decades(aspect * rng.unit());
            let (short, turn) = (0.2 + rng.unit(), rng.below(2) == 0);
            let mut sizes: Vec<f64> = (0..dimension).map(|_| 0.5 + 0.5 * rng.unit()).collect();
            sizes[rng.below(dimension as u64) as usize] *= long;
            let shape = match rng.below(if flat { 4 } else { 6 }) {
                0 => json!({"type": "ellipsoid", "center": vec![0.0; dimension], "semi_axes": sizes}),
                1 => json!({"type": "cuboid", "half_extents": sizes}),
                2 => json!({"type": "capsule", "half_height": long, "radius": short}),
                3 => {
                    let points: Vec<_> =
                        (0..8).map(|_| sizes.iter().map(|size| size * rng.signed()).collect::<Vec<_>>()).collect();
                    json!({"type": "polytope", "points": points})
                }
                4 => json!({"type": "cylinder", "half_height": long, "radius": short}),
                _ => json!({"type": "cone", "half_height": long, "radius": short}),
            };
            if turn { turned(shape, rng) } else { shape }
        }
        5 => {
            let half: Vec<f64> = whole(rng, 3).iter().map(|x| x.abs().max(1.0)).collect();
            json!({"type": "posed", "translation": whole(rng, 4), "of": {"type": "cuboid", "half_extents": half}})
        }
        6 => json!({"type": "polytope", "points": (0..6).map(|_| whole(rng, 4)).collect::<Vec<_>>()}),
        _ => {
            let sizes: Vec<f64> = (0..dimension).map(|_| 0.1 + rng.unit()).collect();
            let round = if flat || rng.below(2) == 0 {
                json!({"type": "capsule", "half_height": sizes[0], "radius": sizes[1]})
            } else {
                json!({"type": "cylinder", "half_height": sizes[0], "radius": sizes[1]})
            };
            let shape = turned(round, rng);
            json!({"type": "posed", "translation": vector(rng, 1.0), "of": shape})
        }
    }
}

/// A length that is nothing, or small, of either sign: often at the level of rounding.
fn small(precision: &Value, rng: &mut Rng) -> f64 {
    let epsilon = if precision == "f32" { f64::from(f32::EPSILON) } else { f64::EPSILON };
    match rng.below(6) {
        0 => 0.0,
        1 => epsilon * (rng.below(17) as f64 - 8.0),
        2 => epsilon * decades(4.0 * rng.unit()) * rng.signed().signum(),
        _ => decades(-12.0 * rng.unit()) * rng.signed().signum(),
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().map(|list| list.iter().filter_map(Value::as_f64).collect()).unwrap_or_default()
}

fn moved(of: &Value, by: &[f64]) -> Value {
    json!({"type": "posed", "translation": by, "of": of})
}

/// Half of the pairs nearly in contact: `b` is moved along the normal.
fn brought_together(mut line: Value, dimension: usize, rng: &mut Rng) -> Value {
    if rng.below(3) > 0 {
        let asked = json!({"query": "signed_distance", "precision": line["precision"], "a": line["a"], "b": line["b"]});
        let answer = asked.as_object().and_then(ask).unwrap_or_default();
        if let Some(apart) = answer.get("signed_distance").and_then(Value::as_f64) {
            let normal = numbers(&answer["normal"]);
            let size = apart.abs().max(1.0);
            let by: Vec<f64> = normal.iter().map(|n| n * (apart - size * small(&line["precision"], rng))).collect();
            if by.len() == dimension {
                line["b"] = moved(&line["b"], &by);
                slide(&mut line, &normal, rng);
            }
        }
    }
    if line["query"] == "linear_cast" && rng.below(3) == 0 {
        line["start_in_contact"] = "if_deeper".into();
    }
    line
}

/// At times the velocity of a body is along the plane of contact, straight into it, or made of whole numbers.
fn slide(line: &mut Value, normal: &[f64], rng: &mut Rng) {
    if line["query"] != "linear_cast" {
        return;
    }
    let velocity: Vec<f64> = match rng.below(5) {
        0 => (0..normal.len()).map(|i| if i < 2 { [-normal[1], normal[0]][i] } else { 0.0 }).collect(),
        1 => normal.iter().map(|n| -n).collect(),
        2 => (0..normal.len()).map(|_| rng.below(7) as f64 - 3.0).collect(),
        3 => {
            let tilt = decades(-8.0 * rng.unit()) * rng.signed();
            (0..normal.len()).map(|i| tilt * normal[i] + if i < 2 { [-normal[1], normal[0]][i] } else { 0.0 }).collect()
        }
        _ => return,
    };
    line["velocity_a"] = velocity.into();
    line["velocity_b"] = vec![0.0; normal.len()].into();
}

/// A ray that meets a point exactly: all coordinates are whole numbers, times a power of two.
fn through_a_point(line: Value, dimension: usize, rng: &mut Rng) -> Value {
    let mut whole = |most: i64| {
        (0..dimension).map(|_| (rng.below(2 * most.unsigned_abs() + 1) as i64 - most) as f64).collect::<Vec<_>>()
    };
    let (at, mut step) = (whole(9), whole(5));
    if step.iter().all(|x| *x == 0.0) {
        step[0] = 1.0;
    }
    let (times, back) = (1.0 + rng.below(7) as f64, rng.below(8) as f64);
    let unit = 2.0_f64.powi(rng.below(21) as i32 - 10);
    let scaled = |v: Vec<f64>| v.iter().map(|x| x * unit).collect::<Vec<_>>();
    let source = at.iter().zip(&step).map(|(x, d)| x - back * d).collect();
    let direction = step.iter().map(|d| d * times).collect();
    let at = scaled(at);
    let speck = 2.0_f64.powi(-120);
    let target = match rng.below(4) {
        0 if line["precision"] != "f32" => moved(&json!({"type": "ball", "radius": speck}), &at),
        1 => moved(&json!({"type": "ball", "radius": 0.0}), &at),
        2 => json!({"type": "segment", "points": [at, at]}),
        _ => json!({"type": "point", "at": at}),
    };
    let (source, direction): (Vec<f64>, Vec<f64>) = (scaled(source), scaled(direction));
    let precision = &line["precision"];
    json!({"query": "ray_cast", "precision": precision, "target": target, "source": source, "direction": direction,
           "expect": {"hit": true}})
}

/// A ray at the surface of its target, from near and far, at times grazing, from the surface, or from within.
fn aimed(mut line: Value, dimension: usize, rng: &mut Rng) -> Value {
    if rng.below(12) == 0 {
        return through_a_point(line, dimension, rng);
    }
    if rng.below(4) == 0 {
        return line;
    }
    let far: Vec<f64> = direction(dimension, rng)[..dimension].iter().map(|x| x * decades(8.0 * rng.unit())).collect();
    let point = json!({"type": "point", "at": far});
    let asked = json!({"query": "signed_distance", "precision": line["precision"], "a": point, "b": line["target"]});
    let answer = asked.as_object().and_then(ask).unwrap_or_default();
    let (on, normal) = (answer.get("point_b").map(numbers), answer.get("normal").map(numbers));
    let Some((on, normal)) = on.zip(normal) else { return line };
    let size = on.iter().fold(1e-3, |most: f64, x| most.max(x.abs()));
    let off = size * small(&line["precision"], rng) * rng.below(2) as f64;
    let aim: Vec<f64> = on.iter().zip(&normal).map(|(x, n)| x + off * n).collect();
    let toward = match rng.below(4) {
        // Along the surface.
        0 => (0..dimension).map(|i| if i < 2 { [-normal[1], normal[0]][i] } else { 0.0 }).collect(),
        1 => normal.iter().map(|n| -n).collect(),
        _ => direction(dimension, rng)[..dimension].to_vec(),
    };
    let back = match rng.below(6) {
        0 => 0.0,
        1 => [1.0, 2.0, 3.0, 10.0][rng.below(4) as usize],
        _ => size * decades(4.0 * rng.unit() - 1.0),
    };
    let source: Vec<f64> = aim.iter().zip(&toward).map(|(x, d)| x - back * d).collect();
    let direction: Vec<f64> =
        if back > 0.0 && rng.below(2) == 0 { aim.iter().zip(&source).map(|(x, s)| x - s).collect() } else { toward };
    let factor = [1.0, 1.0, 3.0, 0.125, 7.0][rng.below(5) as usize];
    line["direction"] = direction.iter().map(|d| d * factor).collect::<Vec<_>>().into();
    line["source"] = source.into();
    if let Value::Object(fields) = &mut line {
        fields.remove("max_lambda");
        if rng.below(4) > 0 {
            fields.remove("min_lambda");
        }
    }
    with(line, "query", "ray_cast")
}
