//! What is drawn of a question in the plane: outlines of its bodies and of their difference, by support points alone.

use std::f64::consts::TAU;

use convex_support::glam::DVec2;
use convex_support::{Difference, SupportMap};
use serde_json::{Map, Value, json};
use xtask::mesh::Meshes;
use xtask::wire::fields::Object;

use crate::observed::{coordinates, dimension, shape};

/// How many directions an outline is asked for: a curve is then as smooth as a screen shows it.
const DIRECTIONS: u32 = 240;

/// The outlines of the bodies of a query in the plane, by the names of their fields, and `difference`; the dimension.
pub(crate) fn drawing(query: &Object, meshes: &Meshes) -> Value {
    let dimension = dimension(query);
    let mut outlines = Map::new();
    // The other engine draws nothing.
    if cfg!(feature = "plane") && dimension == 2 {
        for key in ["a", "b", "target"] {
            if let Some(body) = shape::<DVec2>(query, key, meshes) {
                outlines.insert(key.to_owned(), outline(&body));
            }
        }
        if let Some((a, b)) = shape::<DVec2>(query, "a", meshes).zip(shape::<DVec2>(query, "b", meshes)) {
            outlines.insert("difference".to_owned(), outline(&Difference::new(a, b)));
        }
    }
    json!({ "dimension": dimension, "outlines": outlines })
}

/// The support points all around, each once.
fn outline(body: &impl SupportMap<Vector = DVec2>) -> Value {
    let mut points: Vec<DVec2> = Vec::new();
    for i in 0..DIRECTIONS {
        // Between the axes, so that of a box's edges no direction is square to one.
        let point = body.support(DVec2::from_angle(TAU * (f64::from(i) + 0.5) / f64::from(DIRECTIONS)));
        if points.last() != Some(&point) {
            points.push(point);
        }
    }
    points.into_iter().map(coordinates).collect()
}
