//! The answer about a path, and the parts of a proof that it, or a box of joint values, is free. Observers see the
//! parts; nothing keeps them.

use convex_support::{Scalar as _, Vector};

use crate::{Impact, MotionCast, MotionClearance};

/// The answer of [`Linkage::path`](crate::Linkage::path).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Path<V: Vector> {
    /// The first contact, or a possible one if its cast is undecided: rounding decides, or a limit was reached. `None`
    /// if no body comes as near as the target distance at any time of the whole path. This is a proof.
    pub first: Option<PathContact<V>>,
    /// The number of parts of edges at whose middle the joints were placed, to find near bodies.
    pub parts: usize,
    /// The number of [motion casts](crate::motion_cast()) of a body of a link against another.
    pub casts: usize,
}

/// A contact of a body of a link, or a possible one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathContact<V: Vector> {
    /// The edge, counted from 0: from the waypoint of this index to the next one. The edges before it are free.
    pub edge: usize,
    /// The link.
    pub link: usize,
    /// The body of the link.
    pub body: usize,
    /// The body that it meets.
    pub met: Met,
    /// Their cast, with the normal out of the other body. Times are those of the edge, which begins at 0 and ends at 1,
    /// and the bounds are those of all bodies: there is no contact before the lower one, and a contact, perhaps of
    /// another body, at the upper one. An upper bound of more than 1 means that the contact at the end of this edge was
    /// proved only in the next edge, that much later.
    pub cast: MotionCast<V>,
}

/// The answer of [`Linkage::path_clearance`](crate::Linkage::path_clearance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct PathClearance<V: Vector> {
    /// No body of a link comes nearer to another body than this, at any time of the path up to a first contact. It is
    /// infinite if there is nothing to come near to.
    pub lower: V::Scalar,
    /// What comes nearest; `None` if there is nothing to come near to.
    pub nearest: Option<NearestOnPath<V>>,
    /// The number of parts of edges at whose middle the joints were placed, to find near bodies.
    pub parts: usize,
    /// The number of [least distances](crate::motion_clearance()) of a body of a link from another that were asked for.
    pub casts: usize,
}

/// Two bodies that come nearest to one another along a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestOnPath<V: Vector> {
    /// The edge, counted from 0.
    pub edge: usize,
    /// The link.
    pub link: usize,
    /// The body of the link, which is `a`.
    pub body: usize,
    /// The body that it comes near to, which is `b`.
    pub met: Met,
    /// Their least distance, with its time on the edge, from 0 to 1, and the closest points in the world. The lower
    /// bound is that of all bodies.
    pub least: MotionClearance<V>,
}

impl<V: Vector> PathClearance<V> {
    pub(super) const NOTHING: Self = Self { lower: V::Scalar::ZERO, nearest: None, parts: 0, casts: 0 };
}

/// The body that a link meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Met {
    /// A body of the scene, by its index.
    Obstacle(usize),
    /// A member of an instance in the scene.
    Member {
        /// The index of the instance.
        obstacle: usize,
        /// The number of its member.
        member: usize,
    },
    /// A body of another link.
    Link {
        /// The index of the link.
        link: usize,
        /// The index of its body.
        body: usize,
    },
}

/// A body of a link and another body, of which [`Linkage::joint_box_among`](crate::Linkage::joint_box_among) tells
/// whether they meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodyPair {
    /// The link.
    pub link: usize,
    /// The body of the link.
    pub body: usize,
    /// The other body.
    pub met: Met,
}

impl<V: Vector> Path<V> {
    /// Whether the whole path is proved to be free.
    #[must_use]
    pub fn is_free(&self) -> bool {
        self.first.is_none()
    }

    /// The first contact and where it is, if there is one.
    #[must_use]
    pub fn contact(&self) -> Option<(PathContact<V>, Impact<V>)> {
        self.first.and_then(|first| Some((first, first.cast.outcome.hit()?)))
    }
}

/// A body of a link that is proved to be apart from another, for a part of an edge.
///
/// A plane between them proves it: one across the first normal, or across the second, or one whose normal goes
/// straight, at a constant rate, from the one to the other. At all times of the interval the bodies are apart along
/// one of these by more than the target distance. Two bodies are free along an edge if such intervals cover it. This
/// can be checked with the positions of the joints alone, and a bound on how far points leave the chords of their
/// paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeInterval<V: Vector> {
    /// The edge, counted from 0.
    pub edge: usize,
    /// The beginning of the interval.
    pub from: V::Scalar,
    /// The end.
    pub to: V::Scalar,
    /// The link.
    pub link: usize,
    /// Its body.
    pub body: usize,
    /// The body that it does not meet.
    pub met: Met,
    /// The normals at the ends, towards the link, of length 1 to rounding: in the world, or for a body of another link
    /// in the frame of that one's joint.
    pub normals: [V; 2],
}

/// A part of a box of joint values in which two bodies are proved to be apart: one plane separates them, by more than
/// the target distance, at all values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBox<'b, V: Vector, P = [usize; 2]> {
    /// The body of the first link and that of the second, or a [`BodyPair`].
    pub bodies: P,
    /// The interval of each joint value.
    pub joint_box: &'b [[V::Scalar; 2]],
    /// The normal of the plane, in the frame of the second link's joint or, where that body is at rest, in the world,
    /// towards the first.
    pub normal: V,
}
