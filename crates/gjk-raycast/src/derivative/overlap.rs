//! The overlap of the features of two bodies, projected along the normal, and the directions in which they extend.
//!
//! It is never empty, since the closest points are in it, but often it has no area: boxes side by side have the edges
//! of their faces in common, and boxes across a corner only the corners. Therefore a corner within rounding of a line
//! counts as being on both sides of it.

use convex_support::Scalar;
use convex_support::numerics::elementary::hypot;
use smallvec::SmallVec;

use crate::contact::{ClippedCorners, ContactPart, Corner, Ellipse, Outline, clip, cut};
use crate::symmetric::{Across, cross, direction, dot, scaled, way};

/// The most tangents along which discs are cut. Each halves the angle in which the least value lies, so that its error
/// falls to a quarter.
const MAX_CUTS: usize = 48;

/// The least value over the overlap of two features, neither of them a vertex, and not edges that cross, of a function
/// whose minimum over any polygon is at a corner, as for a linear one and a quotient of two; `None` if there is no
/// corner. A point no farther than `slack` from a line is on it.
pub(super) fn least_over_overlap<S: Scalar>(
    [a, b]: &[Outline<S>; 2],
    slack: S,
    value: impl Fn(Across<S>) -> S,
) -> Option<S> {
    // A segment is cut by a polygon.
    let (own, other) = if a.corners.len() > b.corners.len() { (b, a) } else { (a, b) };
    let mut lists = [&mut ClippedCorners::new(), &mut ClippedCorners::new()];
    clip(&around(own), &around(other), slack, &mut lists);
    let least_corner = |corners: &ClippedCorners<S>| {
        let values = corners.iter().map(|corner| (corner.at, value(corner.at)));
        values.reduce(|least, other| if other.1 < least.1 { other } else { least })
    };
    let rims = [own.rim, other.rim];
    for _ in 0..MAX_CUTS {
        let (at, least) = least_corner(lists[0])?;
        let outside = rims.iter().flatten().find_map(|rim| tangent(rim, at, slack).map(|q| (*rim, q)));
        let Some((rim, q)) = outside else { return Some(least) };
        let radius = mean_radius(&rim);
        let inside = |at| (S::ONE - dot(of_circle(&rim, at), q)) * radius;
        cut(&mut lists, 0, slack, inside, |_, at| (at, [ContactPart::Face; 2]));
    }
    least_corner(lists[0]).map(|(_, least)| least)
}

/// If a point is outside an ellipse, the unit vector to it, in coordinates in which the ellipse is the unit circle.
fn tangent<S: Scalar>(rim: &Ellipse<S>, at: Across<S>, slack: S) -> Option<Across<S>> {
    let p = of_circle(rim, at);
    let length = dot(p, p).sqrt();
    let is_outside = (length - S::ONE) * mean_radius(rim) > slack;
    is_outside.then(|| (p.0 / length, p.1 / length))
}

/// The directions, as unit vectors, along which two features only touch, or are apart. The normal could turn in these
/// directions if nothing else held it.
pub(super) fn separating<S: Scalar>(outlines: &[Outline<S>; 2], slack: S) -> SmallVec<[Across<S>; 16]> {
    axes(outlines).into_iter().filter(|&u| gap(outlines, u) >= -slack).collect()
}

/// Whether two features are apart by more than rounding. For parallel edges, and for an edge and a vertex, this is
/// tested only along the edges.
pub(super) fn are_apart<S: Scalar>(outlines: &[Outline<S>; 2], slack: S) -> bool {
    axes(outlines).into_iter().any(|u| gap(outlines, u) > slack)
}

/// How far two features are apart along a unit vector, either way; negative where they overlap.
fn gap<S: Scalar>([a, b]: &[Outline<S>; 2], u: Across<S>) -> S {
    let [of_a, of_b] = [a, b].map(|outline| range(outline, u));
    (of_a[0] - of_b[1]).max(of_b[0] - of_a[1])
}

/// Directions such that two features that do not overlap are apart along at least one: those across the edges of both,
/// and those from the centre of a disc to the corners of the other.
fn axes<S: Scalar>([a, b]: &[Outline<S>; 2]) -> SmallVec<[Across<S>; 16]> {
    let edge = |outline: &Outline<S>| match outline.corners[..] {
        [from, to] => Some(direction(from.at, to.at)),
        _ => None,
    };
    let mut axes = SmallVec::new();
    for (own, other) in [(a, b), (b, a)] {
        let sides = own.corners.len();
        if let Some(rim) = own.rim {
            let ends = other.corners.iter().map(|corner| corner.at).chain(other.rim.map(|rim| rim.center));
            axes.extend(ends.map(|end| direction(rim.center, end)));
        } else if let Some(e) = edge(own) {
            let is_alone =
                other.corners.len() < 2 || edge(other).is_some_and(|f| cross(e, f).abs() <= S::EPSILON.sqrt());
            axes.push(if is_alone { e } else { (e.1, -e.0) });
        } else if sides > 2 {
            let along = |i: usize| direction(own.corners[i].at, own.corners[(i + 1) % sides].at);
            axes.extend((0..sides).map(along).map(|e| (e.1, -e.0)));
        }
    }
    axes
}

/// The least and the greatest coordinate along a unit vector.
fn range<S: Scalar>(outline: &Outline<S>, u: Across<S>) -> [S; 2] {
    if let Some(Ellipse { center, radii: [p, q] }) = outline.rim {
        let (middle, reach) = (dot(center, u), hypot(dot(p, u), dot(q, u)));
        return [middle - reach, middle + reach];
    }
    let along = |corner: &Corner<S>| dot(corner.at, u);
    outline.corners.iter().map(along).fold([S::infinity(), -S::infinity()], |[low, high], x| [low.min(x), high.max(x)])
}

/// The outline of a feature, or a parallelogram around a disc; counterclockwise.
fn around<S: Scalar>(outline: &Outline<S>) -> Outline<S> {
    let Some(Ellipse { center, radii: [p, q] }) = outline.rim else { return outline.clone() };
    let (p, q) = if cross(p, q) < S::ZERO { (q, p) } else { (p, q) };
    let signs = [(S::ONE, S::ONE), (-S::ONE, S::ONE), (-S::ONE, -S::ONE), (S::ONE, -S::ONE)];
    let corner = |(i, j)| {
        let at = (center.0 + p.0 * i + q.0 * j, center.1 + p.1 * i + q.1 * j);
        Corner { at, height: S::ZERO, id: 0 }
    };
    Outline { corners: signs.into_iter().map(corner).collect(), ..Outline::empty() }
}

/// The coordinates of a point in which an ellipse is the unit circle.
fn of_circle<S: Scalar>(&Ellipse { center, radii: [p, q] }: &Ellipse<S>, at: Across<S>) -> Across<S> {
    let (from, area) = (way(center, at), cross(p, q));
    (cross(from, q) / area, cross(p, from) / area)
}

fn mean_radius<S: Scalar>(rim: &Ellipse<S>) -> S {
    cross(rim.radii[0], rim.radii[1]).abs().sqrt()
}

/// The directions in the plane across a normal in which a body's supporting feature extends: those of a vertex, of an
/// edge (a unit vector), or of a face. In 2D there is no more than an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Span<S> {
    Vertex,
    Edge(Across<S>),
    Face,
}

impl<S: Scalar> Span<S> {
    pub(super) fn of(outline: &Outline<S>) -> Self {
        match outline.corners.as_slice() {
            [] | [_] => Self::Vertex,
            [from, to] => Self::Edge(direction(from.at, to.at)),
            _ => Self::Face,
        }
    }

    /// The dimension of the feature.
    pub(super) fn kind(self) -> usize {
        match self {
            Self::Vertex => 0,
            Self::Edge(_) => 1,
            Self::Face => 2,
        }
    }

    /// The turn of the normal that makes it exactly across the feature, if that is an edge or a face.
    pub(super) fn turn(self, outline: &Outline<S>) -> Across<S> {
        if self == Self::Vertex { (S::ZERO, S::ZERO) } else { scaled(outline.tangent().gradient, -S::ONE) }
    }
}

/// The directions in which the difference of two features extends, if different features extend in different
/// directions: then the points are the only ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum DifferenceSpan<S> {
    /// Two vertices.
    None,
    /// An edge of `a`, 0, or of `b`, 1, and a vertex.
    Edge(usize, Across<S>),
    /// A face of `a`, or of `b`, and a vertex.
    Face(usize),
    /// Two edges that cross.
    Crossed([Across<S>; 2]),
}

impl<S: Scalar> DifferenceSpan<S> {
    /// `None` if both features extend in one direction. Edges are parallel if the sine of their angle is no more than
    /// `parallel`.
    pub(super) fn of(spans: [Span<S>; 2], parallel: S) -> Option<Self> {
        match spans {
            [Span::Vertex, Span::Vertex] => Some(Self::None),
            [Span::Edge(e), Span::Vertex] => Some(Self::Edge(0, e)),
            [Span::Vertex, Span::Edge(e)] => Some(Self::Edge(1, e)),
            [Span::Face, Span::Vertex] => Some(Self::Face(0)),
            [Span::Vertex, Span::Face] => Some(Self::Face(1)),
            [Span::Edge(e), Span::Edge(f)] if cross(e, f).abs() > parallel => Some(Self::Crossed([e, f])),
            _ => None,
        }
    }
}
