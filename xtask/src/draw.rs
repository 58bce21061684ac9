//! Random queries of every kind: all shapes and combinators, nested, of both dimensions and precisions; some of them
//! far away, some huge or tiny, some of needles and plates.
//!
//! Made with `+ − × ÷` and [`decades`] only, so that every machine draws the same bits.

use serde_json::{Value, json};
use workloads::rng::Rng;

/// What draws the fields of a query.
type Draw = fn(Space, &mut Rng) -> Value;

/// The kinds of queries.
pub(crate) const KINDS: &[(&str, Draw)] = &[
    ("ray_cast", |space, rng| {
        let ray = space.ray(rng);
        if rng.below(8) == 0 { with(ray, "method", "iterative") } else { ray }
    }),
    ("ray_exit", Space::ray),
    ("distance", |space, rng| space.near(rng, 4.0)),
    ("signed_distance", |space, rng| space.near(rng, 2.0)),
    ("contact", |space, rng| with(space.bodies(rng, 2.0), "within", space.scale * rng.unit())),
    ("intersect", |space, rng| space.bodies(rng, 3.0)),
    ("linear_cast", Space::linear_cast),
    ("motion_cast", Space::motion_cast),
    ("scene", Space::scene),
    ("enclosing_ellipsoid", |space, rng| {
        let methods = ["newton", "newton", "khachiyan", "ellipsoid", "dual_newton"];
        json!({"points": space.wider(rng).cloud(rng), "method": methods[rng.below(5) as usize]})
    }),
    ("inscribed_ellipsoid", |space, rng| match rng.below(4) {
        0 => json!({"halfspaces": space.wider(rng).half_spaces(rng)}),
        _ => json!({"points": space.cloud(rng)}),
    }),
    (
        "margin",
        |space, rng| json!({"e1": space.ellipsoid(rng, 3.0), "e2": space.ellipsoid(rng, 3.0), "gradient": rng.below(2) == 0}),
    ),
    ("track", |space, rng| {
        let (start, step) = (space.vector(rng, 3.0), space.vector(rng, 0.3));
        let at = |k: usize| start.iter().zip(&step).map(|(x, v)| x + v * k as f64).collect::<Vec<_>>();
        let poses: Vec<_> = (0..4).map(|k| json!({"translation": at(k), "rotation": space.rotation(rng)})).collect();
        json!({"e1": space.ellipsoid(rng, 0.5), "e2": space.ellipsoid(rng, 0.5), "poses": poses})
    }),
    ("clearance", |space, rng| {
        let mut several = |most| (0..=rng.below(most)).map(|_| space.ellipsoid(rng, 5.0)).collect::<Vec<_>>();
        let (links, obstacles) = (several(4), several(12));
        let method = if rng.below(4) == 0 { "all_pairs" } else { "culled" };
        json!({"links": links, "obstacles": obstacles, "method": method})
    }),
    ("path", Space::path),
    ("joint_box", Space::joint_box),
];

/// A query of a kind in a precision and a dimension.
pub(crate) fn query((kind, draw): (&str, Draw), precision: &str, dimension: usize, rng: &mut Rng) -> Value {
    let scale = if rng.below(4) == 0 { decades(6.0 * rng.signed()) } else { 1.0 };
    let far = if precision == "f32" { 4.0 } else { 6.0 };
    let reach = if rng.below(4) == 0 { decades(far * rng.unit()) } else { 0.0 };
    let fields = draw(Space { dimension, scale, reach }, rng);
    with(with(fields, "query", kind), "precision", precision)
}

/// `10ˣ`, the same on every machine.
fn decades(x: f64) -> f64 {
    libm::pow(10.0, x)
}

/// The query with one more field.
pub(crate) fn with(mut query: Value, field: &str, value: impl Into<Value>) -> Value {
    query[field] = value.into();
    query
}

/// Where the shapes live.
#[derive(Clone, Copy)]
pub(crate) struct Space {
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
    fn stretch(rng: &mut Rng, most: f64) -> f64 {
        decades(most * rng.signed())
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

    /// Bodies whose middles are so far apart at most.
    fn bodies(self, rng: &mut Rng, apart: f64) -> Value {
        let apart = apart * rng.unit();
        let (a, b) = self.pair(rng, apart);
        json!({"a": a, "b": b})
    }

    /// The same with the gradient at times, or with a half-space, which has none.
    fn near(self, rng: &mut Rng, apart: f64) -> Value {
        let bodies = self.bodies(rng, apart);
        match rng.below(8) {
            0 => with(bodies, "b", self.half_space(rng)),
            1..4 => with(bodies, "gradient", true),
            _ => bodies,
        }
    }

    fn half_space(self, rng: &mut Rng) -> Value {
        json!({"type": "half_space", "normal": self.vector(rng, 1.0), "offset": self.scale * rng.signed()})
    }

    /// A ray mostly to somewhere about the target.
    fn ray(self, rng: &mut Rng) -> Value {
        let apart = 4.0 * rng.unit();
        let distance = if rng.below(8) == 0 { decades(4.0 * rng.unit()) } else { 1.0 };
        let source = self.vector(rng, (2.0 + 4.0 * apart) * distance);
        let aim = self.vector(rng, 1.5);
        let direction: Vec<f64> = source.iter().zip(&aim).map(|(s, t)| t - s).collect();
        let ray = json!({"target": self.shape(rng, 3), "source": source, "direction": direction});
        match rng.below(8) {
            0 => with(ray, "min_lambda", rng.unit()),
            1 => with(ray, "max_lambda", rng.unit()),
            _ => ray,
        }
    }

    fn linear_cast(self, rng: &mut Rng) -> Value {
        let cast = self.near(rng, 18.0);
        let cast = with(with(cast, "velocity_a", self.vector(rng, 1.0)), "velocity_b", self.vector(rng, 1.0));
        let cast = self.started(rng, cast);
        if rng.below(8) == 0 { with(cast, "max_time", 8.0 * rng.unit()) } else { cast }
    }

    fn motion_cast(self, rng: &mut Rng) -> Value {
        let cast = with(self.near(rng, 6.0), "motion_a", self.motion(rng));
        let cast = if rng.below(2) == 0 { with(cast, "motion_b", self.motion(rng)) } else { cast };
        with(self.started(rng, cast), "max_time", 4.0 * rng.unit())
    }

    /// The cast to a distance at times, or with the contact at its start left out.
    fn started(self, rng: &mut Rng, cast: Value) -> Value {
        match rng.below(8) {
            0 | 1 => with(cast, "target_distance", self.scale * rng.unit()),
            2 => with(cast, "start_in_contact", "if_deeper"),
            _ => cast,
        }
    }

    fn motion(self, rng: &mut Rng) -> Value {
        let turn = if self.dimension == 2 { json!(3.0 * rng.signed()) } else { json!(rng.cube().map(|x| 3.0 * x)) };
        json!({"velocity": self.vector(rng, 2.0), "angular_velocity": turn, "center": self.vector(rng, 0.5)})
    }

    fn scene(self, rng: &mut Rng) -> Value {
        let body = |rng: &mut Rng| {
            let of = self.shape(rng, 1);
            json!({"type": "posed", "translation": self.vector(rng, 4.0), "rotation": self.rotation(rng), "of": of})
        };
        let mut bodies: Vec<_> = (0..3 + rng.below(16)).map(|_| body(rng)).collect();
        if rng.below(4) == 0 {
            bodies.push(self.half_space(rng));
        }
        let mut ray = || json!({"source": self.vector(rng, 6.0), "direction": self.vector(rng, 1.0)});
        let (first, all) = (ray(), ray());
        let straight = json!({"shape": body(rng), "velocity": self.vector(rng, 1.0)});
        json!({"bodies": bodies, "asks": [
            {"ray": first}, {"ray": with(all, "all", true)}, {"nearest": body(rng)},
            {"linear_cast": self.started(rng, straight)},
            {"motion_cast": {"shape": body(rng), "motion": self.motion(rng), "max_time": 2.0}},
            {"pairs_within": self.scale * rng.unit()}, {"contacts_within": 0.5 * self.scale * rng.unit()},
        ]})
    }

    /// A robot of a few joints, each with a link; and how far the value of each may go.
    fn robot(self, rng: &mut Rng) -> (Value, Vec<f64>) {
        let (mut joints, mut links, mut reach) = (Vec::new(), Vec::new(), Vec::new());
        for index in 0..2 + rng.below(4) as usize {
            let parent = if rng.below(4) == 0 { rng.below(1 + index as u64) as i64 - 1 } else { index as i64 - 1 };
            let joint = json!({"parent": parent, "translation": self.vector(rng, 1.0), "rotation": self.rotation(rng)});
            let axis: Vec<f64> = (0..self.dimension).map(|_| rng.signed()).collect();
            joints.push(match rng.below(8) {
                0 => with(joint, "type", "fixed"),
                1 => {
                    reach.push(self.scale);
                    with(with(joint, "type", "prismatic"), "axis", axis)
                }
                _ => {
                    reach.push(2.0);
                    let turns = with(joint, "type", "revolute");
                    if self.dimension == 2 { with(turns, "axis", axis[0]) } else { with(turns, "axis", axis) }
                }
            });
            let shapes: Vec<_> = (0..1 + rng.below(2)).map(|_| self.shape(rng, 1)).collect();
            links.push(json!({"joint": index, "shapes": shapes}));
        }
        (json!({"joints": joints, "links": links}), reach)
    }

    /// Two links of a robot, the second mostly not next to the first.
    fn links(robot: &Value, rng: &mut Rng) -> [u64; 2] {
        let count = robot["links"].as_array().map_or(0, Vec::len) as u64;
        let first = rng.below(count);
        [first, (first + 1 + rng.below(count - 1)) % count]
    }

    fn path(self, rng: &mut Rng) -> Value {
        let (robot, reach) = self.robot(rng);
        let waypoints: Vec<Vec<f64>> =
            (0..1 + rng.below(3)).map(|_| reach.iter().map(|most| most * rng.signed()).collect()).collect();
        let mut obstacles: Vec<_> = (0..rng.below(4))
            .map(|_| json!({"type": "posed", "translation": self.vector(rng, 4.0), "of": self.shape(rng, 1)}))
            .collect();
        if rng.below(4) == 0 {
            let normal = self.vector(rng, 1.0);
            obstacles.push(json!({"type": "half_space", "normal": normal, "offset": -3.0 * self.scale * rng.unit()}));
        }
        let path = with(with(robot, "waypoints", waypoints), "obstacles", obstacles);
        let path = if rng.below(2) == 0 {
            let links = Self::links(&path, rng).to_vec();
            with(path, "self", vec![links])
        } else {
            path
        };
        if rng.below(4) == 0 { with(path, "target_distance", 0.2 * self.scale * rng.unit()) } else { path }
    }

    fn joint_box(self, rng: &mut Rng) -> Value {
        let (robot, reach) = self.robot(rng);
        let mut interval = |most: f64| {
            let (middle, half) = (most * rng.signed(), 0.25 * most * rng.unit());
            vec![middle - half, middle + half]
        };
        let intervals: Vec<_> = reach.into_iter().map(&mut interval).collect();
        let links = Self::links(&robot, rng).to_vec();
        with(with(robot, "pair", links), "box", intervals)
    }

    /// This space, or at times one of four to six dimensions.
    fn wider(self, rng: &mut Rng) -> Self {
        let dimension = if rng.below(8) == 0 { 4 + rng.below(3) as usize } else { self.dimension };
        Self { dimension, ..self }
    }

    /// Points that span the space.
    fn cloud(self, rng: &mut Rng) -> Vec<Vec<f64>> {
        let count = 2 + self.dimension as u64 + rng.below(24);
        self.vectors(rng, count)
    }

    /// A box around the origin, and other half-spaces that cut it.
    fn half_spaces(self, rng: &mut Rng) -> Vec<Value> {
        let axis = |i: usize| (0..self.dimension).map(|k| if i / 2 == k { [1.0, -1.0][i % 2] } else { 0.0 }).collect();
        let mut normals: Vec<Vec<f64>> = (0..2 * self.dimension).map(axis).collect();
        let cuts = rng.below(12);
        normals.extend((0..cuts).map(|_| (0..self.dimension).map(|_| rng.signed()).collect::<Vec<_>>()));
        let mut cut = |normal| json!({"normal": normal, "offset": self.scale * (0.2 + rng.unit())});
        normals.into_iter().map(&mut cut).collect()
    }

    fn ellipsoid(self, rng: &mut Rng, apart: f64) -> Value {
        let semi_axes: Vec<_> = (0..self.dimension).map(|_| self.scale * (0.1 + rng.unit())).collect();
        json!({"center": self.vector(rng, apart), "semi_axes": semi_axes, "rotation": self.rotation(rng)})
    }

    /// A shape posed far away, turned about the origin, turned back and moved back, which leaves it where it was but
    /// for rounding.
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
        let small = |rng: &mut Rng| decades(-6.0 * rng.unit()) * rng.unit();
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
