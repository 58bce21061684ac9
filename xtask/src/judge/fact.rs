//! What is proved of a question, by the brackets of this workspace, and the evidence that refutes a claim.
//!
//! Everything here is a bound from geometry: a plane shows how far bodies are apart at least, points how far at most, a
//! translation how deep they are in one another at most, and planes how deep at least. None of it depends on the answer
//! under judgement, nor is any answer of anybody believed.

use crate::engine;
use crate::mesh::Meshes;
use crate::wire::answer::Line;
use crate::wire::answer::as_read;
use crate::wire::fields::{Dimension, Object, Written};
use crate::wire::names::Names;
use crate::wire::shape::{Shape, Space};
use convex_support::glam::{self, DVec2, DVec3};
use convex_support::{Scalar as _, support_value};
use serde_json::{Value, json};

/// What is proved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fact {
    /// The bodies first meet at a time between these.
    Hit([f64; 2]),
    /// They first meet at this time at the earliest, or never: rounding decides whether a corner is met.
    Graze(f64),
    /// They never meet.
    Miss,
    /// Their distance, negative where they overlap, is between these.
    Distance([f64; 2]),
    /// Nothing: the bracket did not close.
    Open,
}

/// Two bodies and their motions, of whatever query.
#[derive(Clone, Debug)]
pub struct Bodies {
    shapes: [Value; 2],
    motions: [Motion; 2],
    /// The end of the motion, as far as it is worth looking.
    pub max_time: f64,
    /// The reach of the scene: the largest length that is rounded in it.
    pub reach: f64,
    /// No point of either body is faster, relative to the other.
    pub speed: f64,
}

/// A motion at constant velocities, as in the query format.
#[derive(Clone, Debug, Default)]
struct Motion {
    velocity: Vec<f64>,
    angular_velocity: Option<Value>,
    center: Vec<f64>,
}

/// The answer of this workspace to a query: the fields, or none where it gave an error.
pub fn ask(object: &Object) -> Option<Object> {
    let outcome = engine::question(object, &Meshes::relative_to("")).and_then(|question| question.ask());
    outcome.is_ok().then(|| as_read(Line { id: None, line: 0, outcome }))
}

fn number(object: &Object, field: &str) -> Option<f64> {
    object.get(field).and_then(Value::as_f64)
}

fn bracket(answer: &Object) -> Option<[f64; 2]> {
    Some([number(answer, "lower")?, number(answer, "upper")?])
}

impl Fact {
    /// What the bracket of this workspace proves about a query.
    pub fn of(object: &Object, bodies: Option<&Bodies>) -> Self {
        let query = object.get("query").and_then(Value::as_str).unwrap_or_default();
        if query == "intersect" {
            return bodies.and_then(|bodies| bodies.gap(0.0)).map_or(Self::Open, Self::Distance);
        }
        let Some(answer) = ask(object) else { return Self::Open };
        match answer.get("hit").and_then(Value::as_bool) {
            Some(false) => Self::Miss,
            Some(true) => match (number(&answer, "lower"), number(&answer, "upper")) {
                (Some(lower), Some(upper)) => Self::Hit([lower, upper]),
                (Some(lower), None) => Self::Graze(lower),
                (None, _) => Self::Open,
            },
            None => bracket(&answer).map_or(Self::Open, Self::Distance),
        }
    }
}

impl Bodies {
    /// Those of a query; a ray is a point that moves along it.
    pub fn of(object: &Object) -> Option<Self> {
        let list = |field: &str| numbers(object.get(field));
        let (shapes, motions) = if object.contains_key("target") {
            let point = json!({"type": "point", "at": object.get("source")?});
            let motion = Motion { velocity: list("direction"), ..Motion::default() };
            ([point, object.get("target")?.clone()], [motion, Motion::default()])
        } else {
            let motion = |who: &str| match object.get(&format!("motion_{who}")) {
                Some(Value::Object(motion)) => Motion::of(motion),
                _ => Motion { velocity: list(&format!("velocity_{who}")), ..Motion::default() },
            };
            ([object.get("a")?.clone(), object.get("b")?.clone()], [motion("a"), motion("b")])
        };
        let max_time = number(object, "max_lambda").or(number(object, "max_time")).unwrap_or(f64::INFINITY);
        let extents = match dimension(object)? {
            2 => extents::<DVec2>(&shapes)?,
            _ => extents::<DVec3>(&shapes)?,
        };
        let relative = (0..3).map(|i| at(&motions[0].velocity, i) - at(&motions[1].velocity, i));
        let turning: f64 = motions.iter().zip(extents).map(|(motion, reach)| motion.turning() * 2.0 * reach).sum();
        let speed = relative.map(|v| v * v).sum::<f64>().sqrt() + turning;
        Some(Self { shapes, motions, max_time, reach: extents[0].max(extents[1]), speed })
    }

    /// Bounds on the signed distance of the bodies after a time.
    pub fn gap(&self, time: f64) -> Option<[f64; 2]> {
        let [a, b] = [0, 1].map(|k| self.motions[k].moved(&self.shapes[k], time));
        let Value::Object(query) = json!({"query": "signed_distance", "a": a, "b": b}) else { return None };
        bracket(&ask(&query)?)
    }

    /// How deep the bodies are in one another, at least, at some time from this one on; and that time.
    ///
    /// The deepest of even steps, and then of ever shorter ones beside it: what is found holds, however much was
    /// missed.
    pub fn deepest(&self, from: f64) -> (f64, f64) {
        const STEPS: usize = 48;
        // Bodies that meet have left one another after this at the latest, if they go straight.
        let crossed = from + 4.0 * self.reach / self.speed;
        let depth = |time: f64| self.gap(time).map_or(f64::NEG_INFINITY, |gap| -gap[1]);
        let (mut best, mut beside) = ((from, depth(from)), 0.0);
        let consider = |best: &mut (f64, f64), time: f64| {
            let found = depth(time);
            let is_deeper = found > best.1;
            if is_deeper {
                *best = (time, found);
            }
            is_deeper
        };
        for to in [crossed.min(self.max_time), self.max_time].into_iter().filter(|to| to.is_finite()) {
            let step = (to - from) / STEPS as f64;
            for k in 1..=STEPS {
                if consider(&mut best, from + k as f64 * step) {
                    beside = step;
                }
            }
        }
        for _ in 0..20 {
            let middle = best.0;
            for time in [middle - beside, middle + beside] {
                if (from..=self.max_time).contains(&time) {
                    consider(&mut best, time);
                }
            }
            beside /= 2.0;
        }
        best
    }
}

impl Motion {
    fn of(object: &Object) -> Self {
        let list = |field: &str| numbers(object.get(field));
        Self {
            velocity: list("velocity"),
            angular_velocity: object.get("angular_velocity").cloned(),
            center: list("center"),
        }
    }

    /// How fast it turns.
    fn turning(&self) -> f64 {
        match &self.angular_velocity {
            Some(Value::Array(vector)) => vector.iter().filter_map(Value::as_f64).map(|w| w * w).sum::<f64>().sqrt(),
            Some(rate) => rate.as_f64().unwrap_or(0.0).abs(),
            None => 0.0,
        }
    }

    /// The shape after a time: x goes to c + t·v + R(x − c).
    fn moved(&self, shape: &Value, time: f64) -> Value {
        let shift = |i: usize| time * at(&self.velocity, i);
        let c = |i: usize| at(&self.center, i);
        match &self.angular_velocity {
            Some(Value::Array(_)) => {
                let w = numbers(self.angular_velocity.as_ref());
                let turn = glam::DQuat::from_scaled_axis(DVec3::new(at(&w, 0), at(&w, 1), at(&w, 2)) * time);
                let center = DVec3::new(c(0), c(1), c(2));
                let translation = center - turn * center + DVec3::new(shift(0), shift(1), shift(2));
                json!({"type": "posed", "translation": translation.to_array(), "rotation": turn.to_array(), "of": shape})
            }
            Some(rate) => {
                let angle = rate.as_f64().unwrap_or(0.0) * time;
                let turned = DVec2::from_angle(angle).rotate(DVec2::new(c(0), c(1)));
                let translation = [c(0) - turned.x + shift(0), c(1) - turned.y + shift(1)];
                json!({"type": "posed", "translation": translation, "rotation": angle, "of": shape})
            }
            None if self.velocity.is_empty() => shape.clone(),
            None => {
                let translation: Vec<f64> = (0..self.velocity.len()).map(shift).collect();
                json!({"type": "posed", "translation": translation, "of": shape})
            }
        }
    }
}

fn at(list: &[f64], i: usize) -> f64 {
    list.get(i).copied().unwrap_or(0.0)
}

fn numbers(value: Option<&Value>) -> Vec<f64> {
    value.and_then(Value::as_array).map(|list| list.iter().filter_map(Value::as_f64).collect()).unwrap_or_default()
}

/// The dimension of a query.
fn dimension(object: &Object) -> Option<usize> {
    const SPACES: Names = &["target", "a", "b", "source", "velocity_a", "velocity_b"];
    let (dimension, mut object) = (Dimension::default(), object.clone());
    object.retain(|key, _| SPACES.contains(&key.as_str()));
    let fields = Written::new(&object, &dimension).fields(SPACES, &[]).ok()?;
    let (shapes, vectors) = SPACES.split_at(3);
    for name in shapes.iter().filter(|name| fields.has(name)) {
        Shape::read(fields.within(name).ok()?).ok()?;
    }
    for name in vectors {
        fields.vector_or_zero(name).ok()?;
    }
    Some(dimension.known().unwrap_or(3))
}

/// The farthest that a point of each shape can be from the origin, by its box.
fn extents<V: Space<Scalar = f64>>(shapes: &[Value; 2]) -> Option<[f64; 2]> {
    let of = |shape: &Value| {
        let dimension = Dimension::default();
        let solid = Shape::read(Written::new(shape.as_object()?, &dimension))
            .ok()?
            .build::<V>("", &Meshes::relative_to(""))
            .ok()?;
        let along = |axis: V| support_value(&solid, axis).as_f64().abs();
        let squares = (0..V::DIM).map(|i| along(V::axis(i)).max(along(-V::axis(i))).powi(2));
        Some(squares.sum::<f64>().sqrt())
    };
    Some([of(&shapes[0])?, of(&shapes[1])?])
}
