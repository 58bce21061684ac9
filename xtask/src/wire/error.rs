//! What can be wrong with a line, said to the person who wrote it.

use convex_support::InvalidShape;
use serde::Serialize;

/// The kinds of errors of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Not JSON, not an object, or a field is missing or of the wrong type.
    Parse,
    /// The `query` is not one of the format's.
    UnknownQuery,
    /// A field that is not one of the format's, or not of what it stands in.
    UnknownField,
    /// The `type` of a shape is not one of the format's.
    UnknownShape,
    /// Vectors of different lengths, or of a length the query does not know.
    DimensionMismatch,
    /// A number that is not finite in the precision asked for.
    NonFinite,
    /// Numbers that do not make a shape.
    InvalidShape,
    /// Points, or an intersection of half-spaces, without volume.
    DegeneratePoints,
    /// A direction of length zero.
    ZeroDirection,
    /// A centre outside of its shape.
    CenterOutside,
    /// Half-spaces without a bounded intersection.
    Unbounded,
    /// The answer could not be certified.
    NotConverged,
    /// A file could not be read.
    Io,
}

/// Why a line has no answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    pub kind: Kind,
    /// Where and what, in a sentence.
    pub message: String,
}

impl Problem {
    pub fn new(kind: Kind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }

    /// The same, said of the field at `place`.
    pub fn at(self, place: &str) -> Self {
        Self { message: format!("{place}: {}", self.message), ..self }
    }

    /// A shape that could not be built from the field at `place`.
    pub fn invalid_shape(place: &str, why: InvalidShape) -> Self {
        let item = |parameter: &str, index: usize, lone: bool| {
            if lone { format!("{place}.{parameter}") } else { format!("{place}.{parameter}[{index}]") }
        };
        let is_lone = |parameter: &str| matches!(parameter, "radius" | "half_height");
        match why {
            InvalidShape::NonFinite { parameter, index } => Self::new(
                Kind::NonFinite,
                format!(
                    "{} is not a finite number in the precision asked for",
                    item(parameter, index, is_lone(parameter))
                ),
            ),
            InvalidShape::Negative { parameter, index, value } => Self::new(
                Kind::InvalidShape,
                format!("{} is {value}, but must not be negative", item(parameter, index, is_lone(parameter))),
            ),
            InvalidShape::NotPositive { parameter, index, value } => Self::new(
                Kind::InvalidShape,
                format!("{} is {value}, but must be greater than zero", item(parameter, index, is_lone(parameter))),
            ),
            InvalidShape::NoDirection { parameter } => Self::new(
                Kind::InvalidShape,
                format!(
                    "{place}.{parameter} must have a direction, but is zero, or too short or long for the precision"
                ),
            ),
            InvalidShape::NoPoints => {
                Self::new(Kind::InvalidShape, format!("{place}.points is empty, but must be 1 or more points"))
            }
            InvalidShape::NotSymmetric { row, column } => Self::new(
                Kind::InvalidShape,
                format!(
                    "{place}.matrix[{row}][{column}] and [{column}][{row}] differ, but the matrix must be symmetric"
                ),
            ),
            InvalidShape::NotPositiveDefinite => {
                Self::new(Kind::InvalidShape, format!("{place}.matrix is not positive definite, but must be"))
            }
            InvalidShape::ZeroRotation => Self::new(
                Kind::InvalidShape,
                format!("{place}.rotation is the zero quaternion; to turn nothing, leave it out or write [0, 0, 0, 1]"),
            ),
            other => Self::new(Kind::InvalidShape, format!("{place}: {other}")),
        }
    }
}
