//! Errors of options and lists.

use core::fmt;

/// Why a question cannot be answered.
///
/// A single ellipsoid is checked when it is built ([`InvalidShape`](convex_support::InvalidShape)), so that only
/// options and lists can be wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum InvalidQuery {
    /// The tolerance given to [`MarginOptions`](crate::MarginOptions) is not positive and finite.
    Tolerance(f64),
    /// The threshold of the pairs is not a number.
    ThresholdNotANumber,
    /// There is no link, hence no pair to take the minimum over.
    NoLinks,
    /// There is no obstacle, hence no pair to take the minimum over.
    NoObstacles,
    /// The number of links or obstacles differs from that of the step before, whose bounds would be carried over.
    /// Build a new [`Clearance`](crate::Clearance) when the scene changes.
    CountChanged {
        /// The list that changed: `"links"` or `"obstacles"`.
        list: &'static str,
        /// The number before.
        before: usize,
        /// The number now.
        now: usize,
    },
    /// Two lists that should go together pair by pair are of different lengths.
    LengthsDiffer {
        /// The length of the first list.
        first: usize,
        /// The length of the second list.
        second: usize,
    },
    /// The length of a column for answers is not the number of pairs.
    AnswersLength {
        /// The number of pairs.
        pairs: usize,
        /// The length of the column.
        answers: usize,
    },
}

impl fmt::Display for InvalidQuery {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Tolerance(tolerance) => {
                write!(f, "the tolerance must be a positive, finite number, but is {tolerance}")
            }
            Self::ThresholdNotANumber => f.write_str("the threshold of margins is not a number"),
            Self::NoLinks => f.write_str("at least one link is needed, but the list of links is empty"),
            Self::NoObstacles => f.write_str("at least one obstacle is needed, but the list of obstacles is empty"),
            Self::LengthsDiffer { first, second } => {
                write!(
                    f,
                    "the lists of first and second ellipsoids must be equally long, but have {first} and {second}"
                )
            }
            Self::AnswersLength { pairs, answers } => {
                write!(f, "the column of answers must have one for each of {pairs} pairs, but has {answers}")
            }
            Self::CountChanged { list, before, now } => {
                write!(f, "the number of {list} must stay the same along a motion, but it went from {before} to {now}")
            }
        }
    }
}

impl core::error::Error for InvalidQuery {}
