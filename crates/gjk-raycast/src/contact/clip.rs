//! Where two outlines overlap.

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
enum Edge {
    Own(u32, u32),
    Other(usize),
}

pub(crate) type ClippedCorners<S> = SmallVec<[Clipped<S>; ROOM]>;

/// The overlap of two outlines by the method of Sutherland and Hodgman: the first is cut along each edge of the second.
/// A segment is clipped by a polygon, and two parallel segments by each other. It is empty if there is none. An outline
/// without corners is the whole plane. Both lists are empty at first; they are large, and the overlap is one of them.
pub(crate) fn clip<'l, S: Scalar>(
    own: &Outline<S>,
    other: &Outline<S>,
    [overlap, rest]: &'l mut [ClippedCorners<S>; 2],
) -> &'l [Clipped<S>] {
    overlap.extend(corners_of(&own.corners));
    let mut overlap = [overlap, rest];
    let count = other.corners.len();
    if count == 2 {
        let [from, to] = [other.corners[0], other.corners[1]];
        let e = way(from.at, to.at);
        let across = way(own.corners[0].at, own.corners[own.corners.len() - 1].at);
        if own.corners.len() > 2 || !are_parallel(e, across) {
            return &[];
        }
        cut(&mut overlap, 0, ContactPart::Vertex(from.id), |at| dot(way(from.at, at), e), other);
        cut(&mut overlap, 1, ContactPart::Vertex(to.id), |at| dot(way(at, to.at), e), other);
        return overlap[0];
    }
    for i in 0..count {
        let [from, to] = [other.corners[i], other.corners[(i + 1) % count]];
        let e = way(from.at, to.at);
        let part = ContactPart::Edge(from.id, to.id);
        cut(&mut overlap, i, part, |at| cross(e, way(from.at, at)), other);
    }
    overlap[0]
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

/// Keeps the part of a polygon or a segment, the first of two lists, in which `inside` is not negative. The cut is
/// along the part `along` of the other outline, which is its edge of index `index`.
fn cut<S: Scalar>(
    lists: &mut [&mut ClippedCorners<S>; 2],
    index: usize,
    along: ContactPart,
    inside: impl Fn(Across<S>) -> S,
    other: &Outline<S>,
) {
    let [polygon, kept] = lists;
    let polygon = polygon.as_slice();
    // Most edges of a large face cut nothing.
    if polygon.iter().all(|corner| inside(corner.at) >= S::ZERO) {
        return;
    }
    kept.clear();
    let is_segment = polygon.len() == 2;
    let Some(first) = polygon.first() else { return };
    let mut d = inside(first.at);
    for (i, from) in polygon.iter().enumerate() {
        let to = polygon.get(i + 1).unwrap_or(first);
        let e = inside(to.at);
        let is_crossed = (d >= S::ZERO) != (e >= S::ZERO) && !(is_segment && i == 1);
        if d >= S::ZERO {
            kept.push(*from);
        }
        if is_crossed {
            let at = sum(from.at, scaled(way(from.at, to.at), d / (d - e)));
            let parts = match from.edge {
                Edge::Own(p, q) => [ContactPart::Edge(p, q), along],
                Edge::Other(before) => [ContactPart::Face, ContactPart::Vertex(shared_corner(before, index, other))],
            };
            let edge = if d >= S::ZERO { Edge::Other(index) } else { from.edge };
            kept.push(Clipped { at, parts, edge });
        }
        d = e;
    }
    lists.swap(0, 1);
}

/// The number of the corner between two edges of an outline.
fn shared_corner<S: Scalar>(before: usize, after: usize, outline: &Outline<S>) -> u32 {
    let count = outline.corners.len();
    outline.corners[if (before + 1) % count == after { after } else { before }].id
}
