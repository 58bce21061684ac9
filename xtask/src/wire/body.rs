//! Bodies as written: shapes, and half-spaces, which are none.

use convex_support::Scalar as _;
use gjk_raycast::{Body as SceneBody, HalfSpace};

use super::error::{Kind, Problem};
use super::fields::{Coordinates, Written};
use super::shape::{Shape, Solid, Space, TYPES, vector};
use crate::mesh::Meshes;

/// A body as the query says it.
#[derive(Debug)]
pub enum Body {
    Shape(Shape),
    HalfSpace { normal: Coordinates, offset: f64 },
}

impl Body {
    /// The body that an object is.
    pub fn read(written: Written<'_>) -> Result<Self, Problem> {
        let types = TYPES.iter().map(|(name, kind)| (*name, Some(kind))).chain([("half_space", None)]);
        if let Some(kind) = written.named("type", types, Kind::UnknownShape)? {
            return kind.read(written).map(Self::Shape);
        }
        let fields = written.fields(&["type"], &["normal", "offset"])?;
        Ok(Self::HalfSpace { normal: fields.vector("normal")?, offset: fields.get("offset")? })
    }

    /// The body in a space; `place` is where the query says it, for errors.
    pub fn build<V: Space>(&self, place: &str, meshes: &Meshes) -> Result<SceneBody<Solid<V>>, Problem> {
        Ok(match self {
            Self::Shape(shape) => SceneBody::Convex(shape.build(place, meshes)?),
            Self::HalfSpace { normal, offset } => {
                let half_space = HalfSpace::new(vector(normal), V::Scalar::from_f64(*offset));
                SceneBody::HalfSpace(half_space.map_err(|why| Problem::invalid_shape(place, why))?)
            }
        })
    }
}
