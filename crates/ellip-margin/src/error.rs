//! What can be wrong with the lists a clearance is asked for.

use core::fmt;

/// Why a clearance could not be computed.
///
/// A single ellipsoid is checked when it is built ([`InvalidShape`](convex_support::InvalidShape)); what is left are lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum InvalidQuery {
    /// There is no link, hence no pair to take the minimum over.
    NoLinks,
    /// There is no obstacle, hence no pair to take the minimum over.
    NoObstacles,
    /// The number of links or obstacles differs from that of the step before, whose bounds would be carried over.
    /// Build a new [`Clearance`](crate::Clearance) when the scene changes.
    CountChanged {
        /// The list that changed: `"links"` or `"obstacles"`.
        list: &'static str,
        /// How many there were.
        before: usize,
        /// How many there are.
        now: usize,
    },
    /// Two lists that should go together pair by pair are of different lengths.
    LengthsDiffer {
        /// The length of the first list.
        first: usize,
        /// The length of the second list.
        second: usize,
    },
}

impl fmt::Display for InvalidQuery {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoLinks => f.write_str("at least one link is needed, but the list of links is empty"),
            Self::NoObstacles => f.write_str("at least one obstacle is needed, but the list of obstacles is empty"),
            Self::LengthsDiffer { first, second } => {
                write!(
                    f,
                    "the lists of first and second ellipsoids must be equally long, but have {first} and {second}"
                )
            }
            Self::CountChanged { list, before, now } => {
                write!(f, "the number of {list} must stay the same along a motion, but it went from {before} to {now}")
            }
        }
    }
}

impl core::error::Error for InvalidQuery {}
