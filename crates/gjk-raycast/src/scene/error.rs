//! Bodies that cannot be in a scene.

use core::error::Error;
use core::fmt::{self, Display, Formatter};

/// Why a scene refused a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
            Self::NoSuchVertex { triangle, vertex } => {
                write!(f, "triangle {triangle} has a corner with the index {vertex}, but there is no such vertex")
            }
        }
    }
}

impl Error for SceneError {}
