//! Whether what the answers to a query say of themselves is true: the laws of gjk-raycast, with planes in intervals for
//! a judge.

use checker::{Reader, Solid};
use gjk_raycast::laws::{Numbers, PairPlanes, Planes, Report, Term};
use serde_json::json;

use crate::engine;
use crate::mesh::Meshes;
use crate::wire::fields::Object;

/// A body whose planes are evaluated in intervals of 256 bits.
struct Exact(Solid);

impl Planes for Exact {
    fn beyond(&self, normal: Numbers, point: &[Term]) -> [f64; 2] {
        self.0.beyond(normal, point)
    }
}

/// What became of the claims of a query's answers. `None` where there are no laws for it, or it cannot be asked.
///
/// The starts are directions to begin with, and of planes to try.
pub(crate) fn of(query: &Object, starts: &[Numbers], meshes: &Meshes) -> Option<Report> {
    let question = engine::question(query, meshes).ok()?;
    let mesh = |path: &str| {
        let mesh = meshes.load(std::path::Path::new(path)).map_err(|why| why.message)?;
        Ok(mesh.points().iter().map(|point| point.to_array()).collect())
    };
    let precision = json!({"precision": query.get("precision").unwrap_or(&json!("f64"))});
    let reader = Reader::new(&precision, &mesh).ok()?;
    let solid = |name: &str| Solid::read(query.get(name)?, &reader).ok();
    // Zero, in any dimension.
    let point = || Solid::read(&json!({"type": "ball", "radius": 0.0}), &reader).ok();
    let (a, b) = if query.contains_key("target") { (solid("target")?, point()?) } else { (solid("a")?, solid("b")?) };
    let apart = Exact(b.minus(&a));
    let (a, b) = (Exact(a), Exact(b));
    question.claims(starts, PairPlanes { a: &a, b: &b, apart: &apart })
}
