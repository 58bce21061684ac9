//! Random queries to prove: all shapes and combinators, nested, of both dimensions and precisions; some of them far away, some huge or
//! tiny, some of needles and plates.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use checker::Verdict;
use rayon::prelude::*;
use serde_json::{Value, json};
use workloads::rng::Rng;

use super::{Counts, judge_line};
use crate::mesh::Meshes;
use crate::query::certified;

/// Counts of each kind of query in each precision.
pub(super) type Tally = BTreeMap<String, Counts>;

/// Draws, answers and judges queries for so many seconds, on all cores; the lines that are not proved go to `told`.
pub(super) fn prove_for(seconds: u64, seed: u64, told: impl Fn(&str) + Sync) -> Tally {
    let end = Instant::now() + Duration::from_secs(seconds);
    let meshes = Meshes::relative_to("");
    let lanes = 0..rayon::current_num_threads() as u64;
    let lane = |lane: u64| {
        let mut rng = Rng::new(seed.wrapping_mul(0x9E37_79B9).wrapping_add(lane));
        let mut tally = Tally::new();
        while Instant::now() < end {
            let query = query(&mut rng);
            let [kind, precision] = ["query", "precision"].map(|name| query[name].as_str().unwrap_or_default());
            let counts = tally.entry(format!("{kind} {precision}")).or_default();
            let Some(line) = certified(query.to_string().as_bytes(), &meshes) else {
                counts.unanswered += 1;
                continue;
            };
            let (verdict, said) = judge_line(1, &line, &meshes);
            counts.add(verdict);
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

/// A query that has a certificate.
pub(super) fn query(rng: &mut Rng) -> Value {
    let dimension = 2 + rng.below(2) as usize;
    let precision = if rng.below(4) == 0 { "f32" } else { "f64" };
    let scale = if rng.below(4) == 0 { 10.0_f64.powf(6.0 * rng.signed()) } else { 1.0 };
    let far = if precision == "f32" { 4.0 } else { 6.0 };
    let reach = if rng.below(4) == 0 { 10.0_f64.powf(far * rng.unit()) } else { 0.0 };
    let space = Space { dimension, scale, reach };
    let apart = 4.0 * rng.unit();
    match rng.below(4) {
        0 | 1 => {
            let (a, b) = space.pair(rng, apart);
            let query = if rng.below(2) == 0 { "distance" } else { "intersect" };
            json!({"query": query, "precision": precision, "a": a, "b": b})
        }
        2 => {
            let (a, b) = space.pair(rng, 2.0 + 4.0 * apart);
            let (u, v) = (space.vector(rng, 1.0), space.vector(rng, 1.0));
            json!({"query": "linear_cast", "precision": precision, "a": a, "b": b, "velocity_a": u, "velocity_b": v})
        }
        _ => {
            let distance = if rng.below(8) == 0 { 10.0_f64.powf(4.0 * rng.unit()) } else { 1.0 };
            let source = space.vector(rng, (2.0 + 4.0 * apart) * distance);
            // Mostly to somewhere about the target.
            let aim = space.vector(rng, 1.5);
            let direction: Vec<f64> = source.iter().zip(&aim).map(|(s, t)| t - s).collect();
            let target = space.shape(rng, 3);
            json!({"query": "ray_cast", "precision": precision, "target": target, "source": source, "direction": direction})
        }
    }
}

/// Where the shapes live.
#[derive(Clone, Copy)]
struct Space {
    dimension: usize,
    /// The size of shapes.
    scale: f64,
    /// How many sizes away shapes are posed that are moved back afterwards.
    reach: f64,
}

impl Space {
    /// A vector with coordinates of so many sizes at most.
    fn vector(self, rng: &mut Rng, most: f64) -> Vec<f64> {
        (0..self.dimension).map(|_| self.scale * most * rng.signed()).collect()
    }

    fn vectors(self, rng: &mut Rng, count: u64) -> Vec<Vec<f64>> {
        (0..count).map(|_| self.vector(rng, 1.0)).collect()
    }

    fn rotation(self, rng: &mut Rng) -> Value {
        if self.dimension == 2 {
            json!(7.0 * rng.signed())
        } else {
            json!((0..4).map(|_| rng.normal()).collect::<Vec<_>>())
        }
    }

    /// A number of so many decades around one.
    fn stretch(rng: &mut Rng, decades: f64) -> f64 {
        10.0_f64.powf(decades * rng.signed())
    }

    /// Two shapes whose middles are so far apart at most; at times moved away together.
    fn pair(self, rng: &mut Rng, apart: f64) -> (Value, Value) {
        let far = if rng.below(8) == 0 { self.reach.max(1000.0) } else { 0.0 };
        let (a, b) = (self.shape(rng, 3), self.shape(rng, 3));
        let away = self.vector(rng, far);
        let moved: Vec<f64> = self.vector(rng, apart).iter().zip(&away).map(|(x, y)| x + y).collect();
        let posed = |of: Value, translation: Vec<f64>| json!({"type": "posed", "translation": translation, "of": of});
        (posed(a, moved), if far > 0.0 { posed(b, away) } else { b })
    }

    /// A shape posed far away, turned about the origin, turned back and moved back, which leaves it where it was but for rounding.
    fn round_trip(self, rng: &mut Rng, of: &Value) -> Value {
        let there = self.vector(rng, self.reach.max(1.0));
        let back: Vec<f64> = there.iter().map(|x| -x).collect();
        let turn = self.rotation(rng);
        let turn_back = match turn.as_array() {
            Some(q) => q
                .iter()
                .enumerate()
                .map(|(i, x)| if i < 3 { json!(-x.as_f64().unwrap_or(0.0)) } else { x.clone() })
                .collect(),
            None => json!(-turn.as_f64().unwrap_or(0.0)),
        };
        let away = json!({"type": "posed", "translation": there, "of": of});
        let turned = json!({"type": "posed", "rotation": turn, "of": away});
        json!({"type": "posed", "rotation": turn_back, "translation": back, "of": turned})
    }

    /// A shape of sizes about one, combined of others so many levels deep at most.
    fn shape(self, rng: &mut Rng, depth: u64) -> Value {
        if depth == 0 || rng.below(3) == 0 {
            return self.leaf(rng);
        }
        let of = self.shape(rng, depth - 1);
        match rng.below(9) {
            0 | 1 => {
                json!({"type": "posed", "translation": self.vector(rng, 1.0), "rotation": self.rotation(rng), "of": of})
            }
            2 => self.chain(rng, of),
            3 => {
                let stretch = if rng.below(4) == 0 { Self::stretch(rng, 2.0) } else { 1.0 };
                let mut row = || (0..self.dimension).map(|_| stretch * rng.signed()).collect::<Vec<_>>();
                let matrix: Vec<_> = (0..self.dimension).map(|_| row()).collect();
                json!({"type": "affine", "matrix": matrix, "translation": self.vector(rng, 1.0), "of": of})
            }
            4 => json!({"type": "minkowski_sum", "of": [of, self.shape(rng, depth - 1)]}),
            5 => json!({"type": "difference", "a": of, "b": self.shape(rng, depth - 1)}),
            6 => json!({"type": "hull", "of": [of, self.shape(rng, depth - 1)]}),
            7 => self.round_trip(rng, &of),
            _ => json!({"type": "rounded", "radius": self.scale * rng.unit(), "of": of}),
        }
    }

    /// A shape at the end of a chain of poses.
    fn chain(self, rng: &mut Rng, of: Value) -> Value {
        let links = 1 << rng.below(6);
        (0..links).fold(of, |of, _| json!({"type": "posed", "rotation": self.rotation(rng), "translation": self.vector(rng, 0.2), "of": of}))
    }

    fn leaf(self, rng: &mut Rng) -> Value {
        // One in eight is smaller, by up to six decades: needles, plates, dust.
        let small = |rng: &mut Rng| 10.0_f64.powf(-6.0 * rng.unit()) * rng.unit();
        let mut size = || self.scale * if rng.below(8) == 0 { small(rng) } else { 0.05 + rng.unit() };
        let (radius, half_height) = (size(), size());
        let sizes: Vec<f64> = (0..self.dimension).map(|_| size()).collect();
        let flat = if self.dimension == 2 { 8 } else { 10 };
        match rng.below(flat) {
            0 => json!({"type": "point", "at": self.vector(rng, 1.0)}),
            1 => json!({"type": "segment", "points": self.vectors(rng, 2)}),
            2 => json!({"type": "triangle", "points": self.vectors(rng, 3)}),
            3 => json!({"type": "ball", "radius": radius}),
            4 => json!({"type": "cuboid", "half_extents": sizes}),
            5 => json!({"type": "capsule", "half_height": half_height, "radius": radius}),
            6 => {
                json!({"type": "ellipsoid", "center": self.vector(rng, 0.5), "semi_axes": sizes, "rotation": self.rotation(rng)})
            }
            7 => {
                let count = 4 + rng.below(12);
                json!({"type": "polytope", "points": self.vectors(rng, count)})
            }
            8 => json!({"type": "cylinder", "half_height": half_height, "radius": radius}),
            _ => json!({"type": "cone", "half_height": half_height, "radius": radius}),
        }
    }
}
