//! What the queries of two bodies share: what they are.

use gjk_raycast::Body as SceneBody;

use super::How;
use crate::wire::body::Body;
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::shape::{Shape, Solid, Space};

/// The bodies of a query as written: `a` is a shape, and `b` a shape or a half-space.
pub(super) struct Bodies {
    a: Shape,
    b: Body,
}

impl Bodies {
    pub(super) fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self { a: Shape::read(fields.within("a")?)?, b: Body::read(fields.within("b")?)? })
    }

    /// The bodies in a space.
    pub(super) fn build<V: Space>(&self, how: &How<'_>) -> Result<(Solid<V>, SceneBody<Solid<V>>), Problem> {
        Ok((self.a.build("a", how.meshes)?, self.b.build("b", how.meshes)?))
    }

    /// Whether the query asks for the derivatives of its scalar, of which there are those by the poses of two shapes.
    pub(super) fn gradient(&self, fields: &Fields<'_>) -> Result<bool, Problem> {
        let is_wanted = fields.flag("gradient")?;
        if is_wanted && matches!(self.b, Body::HalfSpace { .. }) {
            let message = "gradient is answered for two shapes, but b is a half_space";
            return Err(Problem::new(Kind::InvalidShape, message));
        }
        Ok(is_wanted)
    }
}
