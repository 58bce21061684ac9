//! The planes that have a body behind them, in intervals, for whoever wants to refute a bound.

use std::fmt;

use serde_json::Value;

use crate::body::{Body, Set, apply, difference, product};
use crate::interval::{Interval, Vector};
use crate::reader::{Reader, Unread};

/// A body of a query.
#[derive(Clone)]
pub struct Solid(Body);

impl fmt::Debug for Solid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solid").finish_non_exhaustive()
    }
}

/// The vector of these numbers, exactly.
fn exactly(numbers: [f64; 3]) -> Vector {
    Vector(numbers.map(Interval::from))
}

impl Solid {
    /// The shape that an object is.
    ///
    /// # Errors
    /// Where the object is no shape.
    pub fn read(shape: &Value, reader: &Reader<'_>) -> Result<Self, Unread> {
        let Body { core, radius } = reader.body(shape)?;
        Ok(Self(Body { core: flat(core), radius }))
    }

    /// The set of all differences.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        let Body { core, radius } = difference(self.0.clone(), other.0.clone());
        Self(Body { core: flat(core), radius })
    }

    /// At least and at most how far a point, the sum of some vectors times their factors, is before the plane across
    /// `normal` that touches the body and has it behind.
    #[must_use]
    pub fn beyond(&self, normal: [f64; 3], point: &[(f64, [f64; 3])]) -> [f64; 2] {
        let n = exactly(normal);
        let sum = |sum: Vector, (factor, v): &(f64, [f64; 3])| sum.plus(&exactly(*v).times(&Interval::from(*factor)));
        let point = point.iter().fold(Vector::zero(), sum);
        let length = n.length();
        let reach = &self.0.core.support(&n).1 + &(&self.0.radius * &length);
        let beyond = (&n.dot(&point) - &reach).over(&length);
        [down(beyond.least().to_f64()), -down((-&beyond.greatest()).to_f64())]
    }
}

/// The same set with its maps composed, and those of points applied: support points are asked for often.
fn flat(set: Set) -> Set {
    let all = |parts: Vec<Set>| parts.into_iter().map(flat).collect();
    match set {
        Set::Image(of, rows, translation) => match flat(*of) {
            Set::Points(points) => {
                Set::Points(points.iter().map(|point| apply(&rows, point).plus(&translation)).collect())
            }
            Set::Image(of, inner, at) => {
                let at = apply(&rows, &at).plus(&translation);
                Set::Image(of, product(&rows, &inner), at)
            }
            Set::Sum(parts) => {
                let image = |(i, part)| {
                    let at = if i == 0 { translation.clone() } else { Vector::zero() };
                    flat(Set::Image(Box::new(part), rows.clone(), at))
                };
                Set::Sum(parts.into_iter().enumerate().map(image).collect())
            }
            Set::Hull(parts) => {
                let image = |part| flat(Set::Image(Box::new(part), rows.clone(), translation.clone()));
                Set::Hull(parts.into_iter().map(image).collect())
            }
            Set::Ball => Set::Image(Box::new(Set::Ball), rows, translation),
        },
        Set::Sum(parts) => Set::Sum(all(parts)),
        Set::Hull(parts) => Set::Hull(all(parts)),
        leaf => leaf,
    }
}

/// A number rounded to the nearest double, rounded down instead.
fn down(nearest: f64) -> f64 {
    if nearest == 0.0 { nearest } else { nearest.next_down() }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Composed maps are the same set: a chain of poses about a hull, a sum and a disc, there and back.
    #[test]
    fn a_flat_body_reaches_as_far() {
        let parts = json!([
            {"type": "cone", "half_height": 0.5, "radius": 0.25},
            {"type": "affine", "matrix": [[1.0, 0.5, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.25]],
             "of": {"type": "minkowski_sum", "of": [{"type": "cuboid", "half_extents": [1.0, 0.5, 0.25]},
                                                    {"type": "capsule", "half_height": 0.75, "radius": 0.5}]}},
        ]);
        let turned = json!({"type": "posed", "rotation": [0.5, -0.25, 0.125, 1.0], "translation": [1.0, 2.0, -3.0],
                            "of": {"type": "hull", "of": parts}});
        let shape = json!({"type": "posed", "translation": [-1.0, 0.0, 7.0], "of": turned});
        let mesh = |path: &str| Err(path.to_owned());
        let reader = Reader::new(&json!({}), &mesh).expect("no precision is said");
        let plain = reader.body(&shape).expect("a shape");
        let solid = Solid::read(&shape, &reader).expect("a shape");
        for normal in [[1.0, 0.0, 0.0], [-0.5, 0.25, 3.0], [0.125, -7.0, 1.0]] {
            let n = exactly(normal);
            let reach = &plain.core.support(&n).1 + &(&plain.radius * &n.length());
            let expected = -reach.over(&n.length()).to_f64();
            let [least, most] = solid.beyond(normal, &[]);
            assert!(least <= expected && expected <= most, "{least} ≤ {expected} ≤ {most}");
            assert!(most - least <= 1e-15 * expected.abs(), "{least} {most}");
        }
    }
}
