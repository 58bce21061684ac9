//! Random queries to prove.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use checker::Verdict;
use rayon::prelude::*;
use serde_json::{Value, json};
use workloads::rng::Rng;

use super::{Counts, judge_line};
use crate::draw::{self, KINDS, with};
use crate::mesh::Meshes;
use crate::query::certified;

/// Counts of each kind of query in each precision, and of what is claimed of a robot.
pub(super) type Tally = BTreeMap<String, Counts>;

/// Draws, answers and judges queries for so many seconds, on all cores; the lines that are not proved go to `told`.
pub(super) fn prove_for(kinds: &[&str], seconds: u64, seed: u64, told: impl Fn(&str) + Sync) -> Tally {
    let end = Instant::now() + Duration::from_secs(seconds);
    let meshes = Meshes::relative_to("");
    let lanes = 0..rayon::current_num_threads() as u64;
    let lane = |lane: u64| {
        let mut rng = Rng::new(seed.wrapping_mul(0x9E37_79B9).wrapping_add(lane));
        let mut tally = Tally::new();
        while Instant::now() < end {
            let query = query(kinds, &mut rng);
            let [kind, precision] = ["query", "precision"].map(|name| query[name].as_str().unwrap_or_default());
            let among = query.get("clearance").map_or("", |_| " clearance");
            let among = query.get("obstacles").filter(|_| kind == "joint_box").map_or(among, |_| " among");
            let among = query.get("grow").map_or(among, |_| " grown");
            let mut name = format!("{kind}{among} {precision}");
            let Some(line) = certified(query.to_string().as_bytes(), &meshes) else {
                tally.entry(name).or_default().unanswered += 1;
                continue;
            };
            let (verdict, said) = judge_line(&line, &meshes);
            if let Some(claim) = said["claim"].as_str() {
                name = format!("{name} {claim}");
            }
            tally.entry(name).or_default().add(verdict, &said);
            if verdict != Verdict::Proved {
                told(&format!("{said} of {}", String::from_utf8_lossy(line.trim_ascii())));
            }
        }
        tally
    };
    lanes.into_par_iter().map(lane).reduce(Tally::new, |mut sum, tally| {
        for (kind, counts) in tally {
            let entry = sum.entry(kind).or_default();
            *entry = entry.plus(counts);
        }
        sum
    })
}

/// Kinds of queries that have a certificate of one plane and some points.
pub(super) const PLANES: &[&str] = &["distance", "intersect", "linear_cast", "ray_cast"];
/// Those whose certificates have many planes.
pub(super) const ROBOTS: &[&str] = &["path", "joint_box"];
/// Least distances over motions and paths, growth distances, and boxes of joint values among obstacles: each is drawn
/// as another kind is, and then changed.
pub(super) const CLEARANCES: &[&str] = &["growth_distance", "motion_clearance", "path_clearance", "joint_box_among"];

/// A query of one of some kinds that have a certificate: none of a half-space, and none that asks for what no
/// certificate of ours is made for: derivatives, what happens after a start in contact, a start within the target
/// distance or at a `min_lambda`, and what the papers' method leaves open.
pub(super) fn query(kinds: &[&str], rng: &mut Rng) -> Value {
    loop {
        let name = kinds[rng.below(kinds.len() as u64) as usize];
        let precision = if rng.below(4) == 0 { "f32" } else { "f64" };
        let dimension = 2 + rng.below(2) as usize;
        let drawn_as = match name {
            "growth_distance" => "distance",
            "motion_clearance" => "motion_cast",
            "path_clearance" | "joint_box_among" => "path",
            other => other,
        };
        for kind in KINDS.iter().copied().filter(|(known, _)| *known == drawn_as) {
            let mut query = draw::query(kind, precision, dimension, rng);
            if let Some(fields) = query.as_object_mut() {
                let _ = fields.remove("gradient");
            }
            match name {
                "growth_distance" if query["b"]["type"] != "half_space" => return growing(query, rng),
                "growth_distance" => {}
                "motion_clearance" => {
                    return without(with(query, "query", name), &["start_in_contact", "target_distance"]);
                }
                "path_clearance" => return with(query, "clearance", true),
                "joint_box_among" => return boxed(query, rng),
                _ => {
                    let unread = ["start_in_contact", "target_distance", "min_lambda", "method"];
                    let is_read =
                        query["b"]["type"] != "half_space" && unread.iter().all(|name| query.get(name).is_none());
                    if is_read || ROBOTS.contains(&name) {
                        return query;
                    }
                }
            }
        }
    }
}

/// A distance as a growth distance about points that are inside: the mean of the farthest points of a shape along some
/// directions, those of it that are nearest to points far away.
fn growing(query: Value, rng: &mut Rng) -> Value {
    let dimension = query["a"]["translation"].as_array().map_or(3, Vec::len);
    let center = |shape: &Value, rng: &mut Rng| {
        let mut mean = vec![0.0; dimension];
        let count = 2 + rng.below(6);
        for _ in 0..count {
            let at: Vec<f64> = (0..dimension).map(|_| 1e12 * rng.signed()).collect();
            let far = json!({"query": "distance", "a": shape, "b": {"type": "point", "at": at}});
            let line = certified(far.to_string().as_bytes(), &Meshes::relative_to("")).unwrap_or_default();
            let answer = serde_json::from_slice::<Value>(&line).unwrap_or_default();
            for (i, x) in mean.iter_mut().enumerate() {
                *x += answer["answer"]["point_a"][i].as_f64().unwrap_or(0.0) / count as f64;
            }
        }
        mean
    };
    let (a, b) = (center(&query["a"], rng), center(&query["b"], rng));
    with(with(with(query, "query", "growth_distance"), "center_a", a), "center_b", b)
}

/// A path as a box of joint values about its first waypoint.
fn boxed(path: Value, rng: &mut Rng) -> Value {
    let values = path["waypoints"][0].as_array().into_iter().flatten().filter_map(Value::as_f64);
    let joint_box: Vec<_> = values.map(|value| (value, 0.25 * value.abs() * rng.unit())).collect();
    let joint_box: Vec<_> = joint_box.into_iter().map(|(value, half)| [value - half, value + half]).collect();
    // At times a box is grown around the waypoint.
    let grow = if rng.below(3) == 0 { with(path.clone(), "grow", path["waypoints"][0].clone()) } else { path };
    without(with(with(grow, "query", "joint_box"), "box", json!(joint_box)), &["waypoints"])
}

fn without(mut query: Value, names: &[&str]) -> Value {
    if let Some(fields) = query.as_object_mut() {
        fields.retain(|name, _| !names.contains(&name.as_str()));
    }
    query
}
