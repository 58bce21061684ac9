//! Where two outlines overlap: the one is cut along each edge of the other (Sutherland and Hodgman).

use convex_support::Scalar;
use smallvec::SmallVec;

use super::outline::{ContactPart, Corner, Outline, ROOM};
use crate::symmetric::{Across, cross, dot, scaled, sum, way};

/// A corner of the overlap, and the part of the clipped outline and of the other one that it is on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clipped<S> {
    pub(crate) at: Across<S>,
    pub(crate) parts: [ContactPart; 2],
    /// The edge that begins here.
    edge: Edge,
}

/// An edge of the overlap: one of the clipped outline, by the numbers of its ends, or the edge of the other outline
/// with this index.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Edge {
    Own(u32, u32),
    Other(usize),
}

pub(crate) type ClippedCorners<S> = SmallVec<[Clipped<S>; ROOM]>;

/// The overlap of two outlines by the method of Sutherland and Hodgman: the first is cut along each edge of the second.
/// A segment is clipped by a polygon, and two parallel segments by each other. It is empty if there is none. An outline
/// without corners is the whole plane. A point no farther than `slack` from a line is on both sides of it. Both lists
/// are empty at first; they are large, and the overlap is the first of them afterwards.
pub(crate) fn clip<S: Scalar>(own: &Outline<S>, other: &Outline<S>, slack: S, lists: &mut [&mut ClippedCorners<S>; 2]) {
    lists[0].extend(corners_of(&own.corners));
    let corners = &other.corners;
    let is_segment = corners.len() == 2;
    if is_segment {
        let [e, f] = [corners, &own.corners].map(|ends| way(ends[0].at, ends[ends.len() - 1].at));
        if own.corners.len() > 2 || !are_parallel(e, f) {
            lists[0].clear();
        }
    }
    for (i, from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % corners.len()];
        let e = way(from.at, to.at);
        let along = if is_segment { ContactPart::Vertex(from.id) } else { ContactPart::Edge(from.id, to.id) };
        let inside = |at| if is_segment { dot(e, way(from.at, at)) } else { cross(e, way(from.at, at)) };
        cut(lists, i, slack * dot(e, e).sqrt(), inside, |edge, at| match edge {
            Edge::Own(p, q) => (at, [ContactPart::Edge(p, q), along]),
            Edge::Other(before) => {
                let (corner, is_shared) = corner_between(before, i, corners);
                // The lines of the edges of a thin corner cross only somewhere near it, by rounding.
                (if is_shared { corner.at } else { at }, [ContactPart::Face, ContactPart::Vertex(corner.id)])
            }
        });
    }
}

/// Whether segments are parallel to within about a degree.
fn are_parallel<S: Scalar>(a: Across<S>, b: Across<S>) -> bool {
    let turn = cross(a, b);
    turn * turn <= S::from_f64(3e-4) * dot(a, a) * dot(b, b)
}

fn corners_of<S: Scalar>(corners: &[Corner<S>]) -> impl Iterator<Item = Clipped<S>> {
    let corner = |(c, next): (&Corner<S>, &Corner<S>)| Clipped {
        at: c.at,
        parts: [ContactPart::Vertex(c.id), ContactPart::Face],
        edge: Edge::Own(c.id, next.id),
    };
    corners.iter().zip(corners.iter().cycle().skip(1)).map(corner)
}

/// Keeps the part of a polygon or a segment, the first of two lists, in which `inside` is not less than `-slack`. The
/// cut is along the edge of index `index` of the other outline, and `crossing` tells where it crosses an edge, given
/// where their lines do, and what the crossing is on.
pub(crate) fn cut<S: Scalar>(
    lists: &mut [&mut ClippedCorners<S>; 2],
    index: usize,
    slack: S,
    inside: impl Fn(Across<S>) -> S,
    crossing: impl Fn(Edge, Across<S>) -> (Across<S>, [ContactPart; 2]),
) {
    let [polygon, kept] = lists;
    let polygon = polygon.as_slice();
    let is_in = |d: S| d >= -slack;
    // Most edges of a large face cut nothing.
    if polygon.iter().all(|corner| is_in(inside(corner.at))) {
        return;
    }
    kept.clear();
    let is_segment = polygon.len() == 2;
    let Some(first) = polygon.first() else { return };
    let mut d = inside(first.at);
    for (i, from) in polygon.iter().enumerate() {
        let to = polygon.get(i + 1).unwrap_or(first);
        let e = inside(to.at);
        if is_in(d) {
            kept.push(*from);
        }
        if is_in(d) != is_in(e) && !(is_segment && i == 1) {
            // Between two points of which one is outside by no more than the slack, the line need not be crossed.
            let share = (d / (d - e)).max(S::ZERO).min(S::ONE);
            let at = sum(from.at, scaled(way(from.at, to.at), share));
            let edge = if is_in(d) { Edge::Other(index) } else { from.edge };
            let (at, parts) = crossing(from.edge, at);
            kept.push(Clipped { at, parts, edge });
        }
        d = e;
    }
    lists.swap(0, 1);
}

/// The corner between two edges of an outline, and whether there is one: other edges may meet on their way to be cut
/// off.
fn corner_between<S: Scalar>(before: usize, after: usize, corners: &[Corner<S>]) -> (Corner<S>, bool) {
    let follows = |i: usize, j: usize| (i + 1) % corners.len() == j;
    let is_next = follows(before, after);
    (corners[if is_next { after } else { before }], is_next || follows(after, before))
}
