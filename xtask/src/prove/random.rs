//! Random queries to prove.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use checker::Verdict;
use rayon::prelude::*;
use serde_json::Value;
use workloads::rng::Rng;

use super::{Counts, judge_line};
use crate::draw::{self, KINDS};
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
            let mut name = format!("{kind} {precision}");
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

/// A query of one of some kinds that have a certificate: none of a half-space, and none that asks for what no
/// certificate of ours is made for: derivatives, what happens after a start in contact, a start within the target
/// distance or at a `min_lambda`, and what the papers' method leaves open.
pub(super) fn query(kinds: &[&str], rng: &mut Rng) -> Value {
    loop {
        let name = kinds[rng.below(kinds.len() as u64) as usize];
        let precision = if rng.below(4) == 0 { "f32" } else { "f64" };
        let dimension = 2 + rng.below(2) as usize;
        for kind in KINDS.iter().copied().filter(|(known, _)| *known == name) {
            let mut query = draw::query(kind, precision, dimension, rng);
            if let Some(fields) = query.as_object_mut() {
                let _ = fields.remove("gradient");
            }
            let unread = ["start_in_contact", "target_distance", "min_lambda", "method"];
            let is_read = query["b"]["type"] != "half_space" && unread.iter().all(|name| query.get(name).is_none());
            if is_read || ROBOTS.contains(&name) {
                return query;
            }
        }
    }
}
