//! The directions in which a feature extends.

use convex_support::Scalar;

use crate::contact::Outline;
use crate::symmetric::{Across, cross, direction, scaled, sum};

/// The directions in the plane across a normal in which a body's supporting feature extends: those of a vertex, of an
/// edge (a unit vector), or of a face. In 2D an edge is all there can be.
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

    /// The turn of the normal that makes it exactly across the feature, where that is an edge or a face.
    pub(super) fn turn(self, outline: &Outline<S>) -> Across<S> {
        let zero = (S::ZERO, S::ZERO);
        let slope = |e: Across<S>| {
            let first = outline.corners[0].at;
            outline.height(sum(first, e)) - outline.height(first)
        };
        match self {
            Self::Vertex => zero,
            Self::Edge(e) => scaled(e, -slope(e)),
            Self::Face => (-slope((S::ONE, S::ZERO)), -slope((S::ZERO, S::ONE))),
        }
    }
}

/// The directions in which the difference of two features extends, where each of them is one way only of moving their
/// points: then the points are the only ones.
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
    /// `None` where both features extend the same way. Edges are parallel where the sine of their angle is no more than
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
