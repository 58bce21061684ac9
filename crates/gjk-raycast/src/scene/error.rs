//! Why a scene refuses what it is given.

use core::error::Error;
use core::fmt::{self, Display, Formatter};

use convex_support::InvalidShape;

/// Why a scene refused a body, or cannot be a group.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum SceneError {
    /// The box of the body is not finite: one of its support points is NaN or infinite.
    NotFinite {
        /// The index of the body.
        body: usize,
    },
    /// No bounded body has this index.
    NoSuchBody {
        /// The index.
        body: usize,
    },
    /// No instance has this index.
    NoSuchInstance {
        /// The index.
        body: usize,
    },
    /// The pose of an instance is none: a number is not finite, or the quaternion is zero.
    NoPose {
        /// The index of the body.
        body: usize,
        /// What is wrong with it.
        why: InvalidShape,
    },
    /// A group without members has no box.
    EmptyGroup,
    /// A member of a group is a half-space, which no box contains; it can be a body beside the instances.
    UnboundedMember {
        /// The index of the body in the group.
        member: usize,
    },
    /// Groups are nested too deep, or have more members than can be counted.
    TooDeep,
    /// A triangle names a vertex that is not there.
    NoSuchVertex {
        /// The index of the triangle.
        triangle: usize,
        /// The index of the vertex.
        vertex: usize,
    },
}

impl Display for SceneError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { body } => {
                write!(f, "body {body} has no finite bounding box: one of its support points is NaN or infinite")
            }
            Self::NoSuchBody { body } => write!(f, "no bounded body has the index {body}"),
            Self::NoSuchInstance { body } => write!(f, "no instance of a group has the index {body}"),
            Self::NoPose { body, why } => write!(f, "body {body}, an instance, has no pose: {why}"),
            Self::EmptyGroup => f.write_str("a group has no members, but at least one is needed"),
            Self::UnboundedMember { member } => {
                write!(f, "member {member} of a group is a half-space: insert it into the scene of the instances")
            }
            Self::TooDeep => f.write_str("groups are nested more than 16 deep, or have too many members to count"),
            Self::NoSuchVertex { triangle, vertex } => {
                write!(f, "triangle {triangle} has a corner with the index {vertex}, but there is no such vertex")
            }
        }
    }
}

impl Error for SceneError {}
