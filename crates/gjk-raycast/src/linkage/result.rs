//! What is answered of a path.

use convex_support::Vector;

use crate::Status;

/// The answer of [`Linkage::path`](crate::Linkage::path).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Path<V: Vector> {
    /// Whether the path is free.
    pub outcome: PathOutcome<V>,
    /// What was done for it.
    pub work: PathWork,
}

/// Whether a path is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathOutcome<V: Vector> {
    /// Nothing is met, nor nearer than the target distance, at any time of the whole path. This is a proof.
    Free,
    /// Something is met.
    Contact(PathContact<V>),
    /// The path is free up to a time, as bodies may touch from there on: rounding decides, or a limit was reached.
    Undecided(PathStop<V::Scalar>),
}

/// The first contact on a path.
///
/// Times are those of its edge, which begins at 0 and ends at 1. The edges before it are free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathContact<V: Vector> {
    /// The edge, counted from 0: from the waypoint of this index to the next one.
    pub edge: usize,
    /// The time of the contact.
    pub time: V::Scalar,
    /// Nothing is met before this time.
    pub lower: V::Scalar,
    /// Something is met at this time; infinite where that is not certain. It is more than 1 for a contact at the end
    /// of the edge that the next edge has shown: so much after that one's beginning.
    pub upper: V::Scalar,
    /// The link.
    pub link: usize,
    /// The body of the link.
    pub body: usize,
    /// What it meets.
    pub met: Met,
    /// A point of contact, in the world, at the time: one of what is met, where a target distance was asked for.
    pub point: V,
    /// The unit normal out of what is met, towards the link; `None` where they overlap as the path begins.
    pub normal: Option<V>,
    /// How the search ended.
    pub status: Status,
}

/// What a link meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Met {
    /// A body of the scene, by its index.
    Obstacle(usize),
    /// A body of another link.
    Link {
        /// The index of the link.
        link: usize,
        /// That of its body.
        body: usize,
    },
}

/// Up to where an undecided path is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathStop<S> {
    /// The edge; those before it are free.
    pub edge: usize,
    /// The time in it before which nothing is met.
    pub lower: S,
    /// The link that may touch something there, its body, and what that is.
    pub link: usize,
    /// The body of the link.
    pub body: usize,
    /// What it may touch.
    pub met: Met,
}

/// What was done for an answer: a report that need not be looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PathWork {
    /// The parts of edges at whose middle the joints were placed, to see what is near.
    pub parts: usize,
    /// The [motion casts](crate::motion_cast()) of a body of a link against another.
    pub casts: usize,
}

impl<V: Vector> Path<V> {
    /// Whether the whole path is proved to be free.
    #[must_use]
    pub fn is_free(&self) -> bool {
        matches!(self.outcome, PathOutcome::Free)
    }

    /// The first contact, if there is one.
    #[must_use]
    pub fn contact(&self) -> Option<PathContact<V>> {
        match self.outcome {
            PathOutcome::Contact(contact) => Some(contact),
            PathOutcome::Free | PathOutcome::Undecided(_) => None,
        }
    }
}

impl<V: Vector> PathContact<V> {
    /// Whether it certainly is one.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.upper < num_traits::Float::infinity()
    }
}
