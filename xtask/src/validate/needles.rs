//! How certain answers about needles and plates are, and after how many steps: the share of certain answers against
//! the aspect of the shape, for each query, shape and precision.
//!
//! What was reached is recorded in `data/needles.csv`, and to fall behind it is an error, as is a bracket that its
//! certificate disproves. To record a new table, copy the one of the report there.

use checker::Verdict as Proof;
use rayon::prelude::*;
use serde_json::{Value, json};
use workloads::rng::Rng;

use super::page::{Row, Table};
use super::score::{Verdict, called};
use super::{Record, Scope};
use crate::draw::with;
use crate::mesh::Meshes;
use crate::prove::judge_line;
use crate::query::certified;

/// What is asked, of which shapes, and how many times as long as wide they are, or as wide as long.
const QUERIES: [&str; 4] = ["ray_cast", "linear_cast", "distance", "signed_distance"];
const SHAPES: [&str; 7] = ["ellipsoid", "cylinder", "cone", "capsule", "cuboid", "polytope", "affine"];
const ASPECTS: [f64; 6] = [1e2, 1e3, 1e4, 1e5, 1e6, 1e7];

/// Questions for each row and aspect.
const EACH: u64 = 24;

/// A distance is certain to within this part of about the width of the shapes.
const NARROW: f64 = 1.0 / 1024.0;

/// The certain answers and the most steps that the report had when it was recorded.
const RECORDED: &str = include_str!("../../data/needles.csv");

/// The stem of the table's file.
const NAME: &str = "needles";

/// The answers to one query about one shape of one aspect.
#[derive(Clone, Debug, Default)]
struct Cell {
    certain: u64,
    steps: u64,
    /// The questions whose answer is disproved.
    wrong: Vec<String>,
}

/// The rows of the table, and what is wrong with each.
#[derive(Clone, Debug, Default)]
pub struct Needles {
    rows: Vec<([&'static str; 3], Vec<Cell>)>,
}

impl Needles {
    /// Asks all questions that are in the scope.
    pub(super) fn ask(scope: &Scope) -> Self {
        let of_query = |query: &&str| scope.holds(query);
        let names = QUERIES.into_iter().filter(of_query).flat_map(|query| {
            SHAPES.into_iter().flat_map(move |shape| ["f64", "f32"].map(|precision| [query, shape, precision]))
        });
        let names: Vec<[&str; 3]> = names.collect();
        let row = |names: [&'static str; 3]| (names, ASPECTS.map(|aspect| Cell::ask(names, aspect)).to_vec());
        Self { rows: names.into_par_iter().map(row).collect() }
    }

    /// A record for each row, which is wrong if an answer is disproved, or if it fell behind what is recorded.
    pub(super) fn records(&self) -> impl Iterator<Item = Record> {
        let recorded = recorded();
        self.rows.iter().map(move |(names, cells)| {
            let mut wrong: Vec<String> = cells.iter().flat_map(|cell| cell.wrong.iter().cloned()).collect();
            let known = recorded.iter().find(|(name, _)| *name == names.join(" "));
            for (k, (cell, aspect)) in cells.iter().zip(ASPECTS).enumerate() {
                match known.and_then(|(_, cells)| cells.get(k)) {
                    Some([certain, steps]) if cell.certain >= *certain && cell.steps <= *steps => {}
                    Some([certain, steps]) => wrong.push(format!(
                        "at an aspect of {aspect:e} {} of {EACH} answers are certain, after {} steps at most; {certain} \
                         were, after {steps}",
                        cell.certain, cell.steps
                    )),
                    None => wrong.push(format!("{NAME}.csv has no such row, or none of an aspect of {aspect:e}")),
                }
            }
            let [query, shape, precision] = *names;
            Record {
                file: NAME.to_owned(),
                id: names.join(" "),
                query: query.to_owned(),
                precision,
                tags: vec![shape.to_owned()],
                verdict: Verdict { wrong, ..Verdict::default() },
                time: None,
                iterations: cells.iter().map(|cell| cell.steps).max(),
            }
        })
    }

    /// The table; `None` if nothing was asked.
    pub(super) fn table(&self) -> Option<Table> {
        let aspects = ASPECTS.map(|aspect| format!("{aspect:e}"));
        let headers: Vec<&str> =
            ["question", "shape", "precision"].into_iter().chain(aspects.iter().map(String::as_str)).collect();
        let row = |([query, shape, precision], cells): &([&str; 3], Vec<Cell>)| {
            let names = [called(query), (*shape).to_owned(), (*precision).to_owned()];
            let cell = |cell: &Cell| format!("{}/{EACH} in {}", cell.certain, cell.steps);
            Row::of(names.into_iter().chain(cells.iter().map(cell)))
                .bad_if(cells.iter().any(|cell| !cell.wrong.is_empty()))
        };
        let caption = format!(
            "Needles and plates: for each aspect, how many of {EACH} answers are certain, and in how many steps at most. \
             A distance is certain if its bounds are within a thousandth of the least width of the shape. Half of the \
             shapes are long and half are flat; rays, motions and bodies are aimed at tips, rims, sides and \
             ends. Of an affine image, the shape is a ball. The certificates of casts and distances are checked."
        );
        let rows: Vec<Row> = self.rows.iter().map(row).collect();
        (!rows.is_empty()).then(|| Table::new(NAME, &caption, &headers, rows).with_names(3))
    }
}

/// The rows of the recorded table: names, and the certain answers and steps of each aspect.
fn recorded() -> Vec<(String, Vec<[u64; 2]>)> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').map(|cell| cell.trim_matches('"')).collect();
        let names = cells.iter().take(3).map(|name| name.replace(' ', "_")).collect::<Vec<_>>().join(" ");
        let numbers = |cell: &&str| {
            let (certain, rest) = cell.split_once('/')?;
            Some([certain.parse().ok()?, rest.split_once(" in ")?.1.parse().ok()?])
        };
        (names, cells.iter().skip(3).filter_map(numbers).collect())
    };
    RECORDED.lines().skip(1).map(row).collect()
}

impl Cell {
    /// Asks the questions of one cell. Long and flat shapes, and the places that are aimed at, take turns.
    fn ask([query, shape, precision]: [&str; 3], aspect: f64) -> Self {
        let meshes = Meshes::relative_to("");
        let mut rng = Rng::new(aspect.to_bits());
        let mut cell = Self::default();
        for k in 0..EACH {
            let line = question(query, shape, precision, aspect, k, &mut rng).to_string();
            // A question that is not answered has no bounds either.
            let Some(answered) = certified(line.as_bytes(), &meshes) else { continue };
            let answer =
                serde_json::from_slice::<Value>(&answered).map(|line| line["answer"].clone()).unwrap_or_default();
            // A bound that is left out, as of a graze, is infinite.
            let bound = |name: &str| answer[name].as_f64().unwrap_or(f64::INFINITY);
            let is_certain = if query.ends_with("cast") {
                answer["certain"] == true
            } else {
                answer["status"] == "converged" && bound("upper") - bound("lower") <= NARROW
            };
            cell.certain += u64::from(is_certain);
            cell.steps = cell.steps.max(answer["iterations"].as_u64().unwrap_or(0));
            let (proof, said) = judge_line(&answered, &meshes);
            if proof == Proof::Disproved {
                cell.wrong.push(format!("disproved, by {said}: {line}"));
            }
        }
        cell
    }
}

/// A question about a shape with a place on it, and a direction towards that.
fn question(query: &str, shape: &str, precision: &str, aspect: f64, k: u64, rng: &mut Rng) -> Value {
    let aspect = aspect * (1.0 - 0.25 * rng.unit());
    let [width, height] = if k.is_multiple_of(2) { [1.0, aspect] } else { [aspect, 1.0] };
    let other = width * (1.0 - 0.5 * rng.unit());
    let [x, z] = unit_circle(rng);
    let near = 0.1 / (1u64 << rng.below(12)) as f64;
    let side = rng.signed();
    let sign = if rng.below(2) == 0 { 1.0 } else { -1.0 };
    // On the unit cylinder or near it; what is round lies within.
    let place = match k / 2 % 4 {
        0 => [near * x, sign, near * z],
        1 => [x * (1.0 - near), sign * (1.0 - near), z * (1.0 - near)],
        2 => [x, side, z],
        _ => [0.25 * x, sign, 0.25 * z],
    };
    let norm = (place[0] * place[0] + place[1] * place[1] + place[2] * place[2]).sqrt();
    let narrowed = match shape {
        "ellipsoid" | "affine" => 1.0 / norm,
        "polytope" => 1.0 / (place[1].abs() + (place[0] * place[0] + place[2] * place[2]).sqrt()),
        _ => 1.0,
    };
    let body = match shape {
        "ellipsoid" => json!({"type": shape, "center": [0, 0, 0], "semi_axes": [width, height, other]}),
        "cuboid" => json!({"type": shape, "half_extents": [width, height, other]}),
        "polytope" => {
            let corners = [[1.0, 0.0], [0.25, 0.875], [-0.75, 0.5], [-0.75, -0.5], [0.25, -0.875]];
            let ring = corners.map(|[x, z]| [x * width, 0.0, z * width]);
            let points: Vec<[f64; 3]> = ring.into_iter().chain([[0.0, height, 0.0], [0.0, -height, 0.0]]).collect();
            json!({"type": shape, "points": points})
        }
        "affine" => json!({"type": shape, "of": {"type": "ball", "radius": 1},
            "matrix": [[width, 0, 0], [0.25 * height, height, 0], [0, 0, other]]}),
        _ => json!({"type": shape, "half_height": height, "radius": width}),
    };
    let lean = if shape == "affine" { 0.25 * height * place[0] * narrowed } else { 0.0 };
    let depth = if matches!(shape, "ellipsoid" | "affine" | "cuboid") { other } else { width };
    let spot = [place[0] * narrowed * width, place[1] * narrowed * height + lean, place[2] * narrowed * depth];
    // From around, and from outside: along the axis for ends.
    let mut from = rng.sphere();
    from[1] = from[1].abs() * if spot[1] < 0.0 { -1.0 } else { 1.0 };
    let distance = if rng.below(2) == 0 { 3.0 } else { 2.0 * width.max(height) };
    let along = |by: f64| [0, 1, 2].map(|i| spot[i] + from[i] * by);
    let towards = from.map(|x| -x);
    let fields = match query {
        "ray_cast" => json!({"target": body, "source": along(distance), "direction": towards}),
        _ => {
            let partner = if k.is_multiple_of(3) {
                json!({"type": "ball", "radius": 0.25})
            } else {
                json!({"type": "cuboid", "half_extents": [0.25, 0.5, 0.125]})
            };
            let gap = match query {
                "linear_cast" => distance,
                "distance" => 1.0 + rng.unit(),
                _ => rng.signed(),
            };
            let b = json!({"type": "posed", "of": partner, "rotation": rng.quat(), "translation": along(gap)});
            if query == "linear_cast" {
                json!({"a": body, "b": b, "velocity_b": towards})
            } else {
                json!({"a": body, "b": b})
            }
        }
    };
    with(with(fields, "query", query), "precision", precision)
}

/// A point of the unit circle, of rational coordinates.
fn unit_circle(rng: &mut Rng) -> [f64; 2] {
    let t = rng.signed();
    let [x, z] = [(1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t)];
    if rng.below(2) == 0 { [x, z] } else { [-x, z] }
}
