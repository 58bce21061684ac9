//! Robots as written: joints, and the links that they carry.

use gjk_raycast::{Joint as Jointed, JointKind, Link as Carried, Linkage as Robot, LinkageError, Pose as Placed};

use super::error::{Kind, Problem};
use super::fields::{AngularVelocity, Coordinates, Fields, Written};
use super::shape::{Pose, Shape, Solid, Space, rotation_of, vector};
use crate::mesh::Meshes;

/// A robot as the query says it.
#[derive(Debug)]
pub struct Linkage {
    joints: Vec<Joint>,
    links: Vec<Link>,
}

#[derive(Debug)]
struct Joint {
    parent: Option<usize>,
    pose: Pose,
    kind: Kinematics,
}

/// How a joint moves.
#[derive(Debug)]
enum Kinematics {
    Fixed,
    Revolute(AngularVelocity),
    Prismatic(Coordinates),
}

#[derive(Debug)]
struct Link {
    joint: Option<usize>,
    shapes: Vec<Shape>,
}

impl Linkage {
    /// The robot that is among the fields of a query.
    pub fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            joints: fields.each("joints")?.into_iter().map(Joint::read).collect::<Result<_, _>>()?,
            links: fields.each("links")?.into_iter().map(Link::read).collect::<Result<_, _>>()?,
        })
    }

    /// The robot in a space.
    pub fn build<V: Space>(&self, meshes: &Meshes) -> Result<Robot<Solid<V>>, Problem> {
        let links = self.links.iter().enumerate().map(|(i, link)| {
            let shapes = link.shapes.iter().enumerate();
            let bodies = shapes.map(|(k, shape)| shape.build(&format!("links[{i}].shapes[{k}]"), meshes));
            Ok(Carried { joint: link.joint, bodies: bodies.collect::<Result<_, _>>()? })
        });
        let links = links.collect::<Result<Vec<_>, Problem>>()?;
        Robot::new(self.joints.iter().map(Joint::build), links).map_err(problem)
    }
}

impl Joint {
    fn read(written: Written<'_>) -> Result<Self, Problem> {
        let kinds = [("revolute", "revolute"), ("prismatic", "prismatic"), ("fixed", "fixed")];
        let kind = written.named("type", kinds, Kind::Parse)?;

        let own: super::names::Names = if kind == "fixed" { &[] } else { &["axis"] };
        let fields = written.fields(&["type", "parent", "translation", "rotation"], own)?;
        let missing = || Problem::new(Kind::Parse, format!("the field \"axis\" of {} is missing", fields.place()));
        Ok(Self {
            parent: index(&fields, "parent")?,
            pose: Pose::of(&fields)?,
            kind: match kind {
                "revolute" => Kinematics::Revolute(fields.angular_velocity("axis")?.ok_or_else(missing)?),
                "prismatic" => Kinematics::Prismatic(fields.vector("axis")?),
                _ => Kinematics::Fixed,
            },
        })
    }

    fn build<V: Space>(&self) -> Jointed<V> {
        let Pose { translation, rotation } = &self.pose;
        Jointed {
            parent: self.parent,
            pose: Placed { translation: vector(translation), rotation: rotation_of::<V>(rotation.as_ref()) },
            kind: match self.kind {
                Kinematics::Fixed => JointKind::Fixed,
                Kinematics::Revolute(axis) => JointKind::Revolute(V::angular_velocity(axis)),
                Kinematics::Prismatic(axis) => JointKind::Prismatic(vector(&axis)),
            },
        }
    }
}

impl Link {
    fn read(written: Written<'_>) -> Result<Self, Problem> {
        let fields = written.fields(&["joint", "shapes"], &[])?;
        let shapes = fields.each("shapes")?.into_iter().map(Shape::read).collect::<Result<_, _>>()?;
        Ok(Self { joint: index(&fields, "joint")?, shapes })
    }
}

/// The index of a joint; -1 is the world.
fn index(fields: &Fields<'_>, key: &str) -> Result<Option<usize>, Problem> {
    let index: i64 = fields.get(key)?;
    match usize::try_from(index) {
        Ok(index) => Ok(Some(index)),
        Err(_) if index == -1 => Ok(None),
        Err(_) => {
            let message = format!("{} is {index}, but is the index of a joint, or -1 for the world", fields.at(key));
            Err(Problem::new(Kind::Parse, message))
        }
    }
}

/// What is said of a robot or a path that is none.
pub fn problem(why: LinkageError) -> Problem {
    let kind = match why {
        LinkageError::Value { .. } | LinkageError::Option(_) | LinkageError::BodyNotFinite { .. } => Kind::NonFinite,
        LinkageError::Axis { .. } => Kind::ZeroDirection,
        LinkageError::Count { .. } => Kind::DimensionMismatch,
        LinkageError::EmptyPath
        | LinkageError::NoSuchJoint { .. }
        | LinkageError::Pair { .. }
        | LinkageError::OutsideLimits { .. } => Kind::Parse,
        // That the values to grow a box around are free is not known.
        LinkageError::NotFree { .. } => Kind::NotConverged,
        _ => Kind::InvalidShape,
    };
    Problem::new(kind, why.to_string())
}
