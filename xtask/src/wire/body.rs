//! Bodies as written: shapes, and half-spaces, which are none; and groups of them in a scene.

use convex_support::{Scalar as _, Vector};
use gjk_raycast::{Body as SceneBody, Group, HalfSpace, Pose as ScenePose, Scene, SceneError};

use super::error::{Kind, Problem};
use super::fields::{Coordinates, Written};
use super::shape::{Pose, Shape, Solid, Space, TYPES, rotation_of, vector};
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

/// A body of a scene as the query says it: one by itself, or several posed as one.
#[derive(Debug)]
pub enum Element {
    Body(Body),
    Group { pose: Pose, of: Vec<Self> },
}

/// The same in a space.
pub(crate) enum Built<V: Vector> {
    Body(SceneBody<Solid<V>>),
    Group(Group<V>, ScenePose<V>),
}

impl Element {
    /// The body that an object is.
    pub fn read(written: Written<'_>) -> Result<Self, Problem> {
        let types = TYPES.iter().map(|(name, _)| *name).chain(["half_space"]).map(|name| (name, false));
        if !written.named("type", types.chain([("group", true)]), Kind::UnknownShape)? {
            return Body::read(written).map(Self::Body);
        }
        let fields = written.fields(&["type"], &["translation", "rotation", "of"])?;
        let of = fields.each("of")?.into_iter().map(Self::read).collect::<Result<_, _>>()?;
        Ok(Self::Group { pose: Pose::of(&fields)?, of })
    }

    /// The body in a space; `place` is where the query says it, for errors.
    pub(crate) fn build<V: Space>(&self, place: &str, meshes: &Meshes) -> Result<Built<V>, Problem> {
        Ok(match self {
            Self::Body(body) => Built::Body(body.build(place, meshes)?),
            Self::Group { pose, of } => {
                let list = format!("{place}.of");
                let build = |(i, member): (usize, &Self)| member.build(&format!("{list}[{i}]"), meshes);
                let members = of.iter().enumerate().map(build).collect::<Result<_, _>>()?;
                let group = scene_of(members).and_then(Group::new).map_err(|why| refused(why, &list))?;
                let rotation = rotation_of::<V>(pose.rotation.as_ref());
                Built::Group(group, ScenePose { rotation, translation: vector(&pose.translation) })
            }
        })
    }
}

/// The scene of these bodies, with indices in their order: built at once up to the first that is no shape.
pub(crate) fn scene_of<V: Vector>(mut bodies: Vec<Built<V>>) -> Result<Scene<Solid<V>>, SceneError> {
    use SceneBody::{Convex, HalfSpace};
    let is_shape = |body: &Built<V>| matches!(body, Built::Body(Convex(_)));
    let first = bodies.iter().position(|body| !is_shape(body)).unwrap_or(bodies.len());
    let rest = bodies.split_off(first);
    let shape = |body| if let Built::Body(Convex(body)) = body { Some(body) } else { None };
    let mut scene = Scene::new(bodies.into_iter().filter_map(shape))?;
    for body in rest {
        match body {
            Built::Body(Convex(body)) => scene.insert(body)?,
            Built::Body(HalfSpace(half_space)) => scene.insert_half_space(half_space),
            Built::Group(group, pose) => scene.insert_group(&group, pose)?,
        };
    }
    Ok(scene)
}

/// A body that has no place in a scene, or bodies that make no group; `list` is where the query says them.
pub fn refused(why: SceneError, list: &str) -> Problem {
    match why {
        SceneError::NotFinite { body } => {
            let message = format!("the box of {list}[{body}] is not finite in the precision asked for");
            Problem::new(Kind::NonFinite, message)
        }
        SceneError::NoPose { body, why } => Problem::invalid_shape(&format!("{list}[{body}]"), why),
        SceneError::UnboundedMember { member } => {
            Problem::new(Kind::InvalidShape, format!("{list}[{member}] is a half-space, which no group can have"))
        }
        other => Problem::new(Kind::InvalidShape, format!("{list}: {other}")),
    }
}
