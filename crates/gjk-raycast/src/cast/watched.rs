//! The bracket that an observer of a cast is shown.
//!
//! A search records its bounds only where it uses them: a portal has neither before it is about to close. An observer
//! is to see the bracket narrow from the first support point on. So for an observer every support point counts at once.
//! The body is behind the plane that supports it there, which the line crosses no later than the body. The point itself
//! is of the body, and where the line runs through the triangle of three such points (in the plane: between two), it is
//! in the body. Nothing of this is computed without an observer, and no search depends on it.

use alloc::boxed::Box;
use alloc::vec::Vec;

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::line::Line;
use crate::symmetric::{Across, axes_across, cross};

/// The last points that are looked at for a triangle about the line, beside the corners of the nearest one.
const LAST_POINTS: usize = 12;

/// A point across the line, and where along it.
type OffLine<S> = (Across<S>, S);

/// Two points (in the plane: one, twice) that have the line within their hull with a new one, and where it is in it.
type Enclosing<S> = ([OffLine<S>; 2], S);

/// What an observer is shown of the bounds. It is apart from the bracket, since few casts have an observer.
pub(super) struct Watched<V: Vector>(Box<ShownBracket<V>>);

/// Both bounds by all support points so far, as parameters of the line.
struct ShownBracket<V: Vector> {
    line: Line<V>,
    axes: [V; 2],
    /// The corners of the nearest triangle first, and then the last points.
    points: Vec<OffLine<V::Scalar>>,
    corners: usize,
    lower: V::Scalar,
    upper: V::Scalar,
}

impl<V: Vector> Watched<V> {
    pub(super) fn new(line: Line<V>) -> Self {
        let (axes, unknown) = (axes_across(line.direction), V::Scalar::infinity());
        Self(Box::new(ShownBracket { line, axes, points: Vec::new(), corners: 0, lower: -unknown, upper: unknown }))
    }

    /// Both bounds, by those of the search and all support points so far, of which the last is the one of the core
    /// along `n`.
    pub(super) fn narrow(&mut self, [low, high]: [V::Scalar; 2], n: V, core: V, radius: V::Scalar) -> [V::Scalar; 2] {
        self.0.count(n, core, radius);
        self.0.narrow(low, high).into()
    }
}

impl<V: Vector> ShownBracket<V> {
    /// Both bounds, by those of the search and all support points so far. They only ever narrow, and do not pass one
    /// another by rounding.
    fn narrow(&mut self, low: V::Scalar, high: V::Scalar) -> (V::Scalar, V::Scalar) {
        self.lower = self.lower.max(low.min(self.upper));
        self.upper = self.upper.min(high.max(self.lower));
        (self.lower, self.upper)
    }

    /// Counts the support point of a core along `n`, of a body that is the core swept by a ball.
    fn count(&mut self, n: V, core: V, radius: V::Scalar) {
        let Some(unit) = n.unit() else { return };
        let (point, line) = (core + unit * radius, self.line);
        let slope = -unit.dot(line.direction);
        if slope > V::Scalar::ZERO {
            self.narrow(unit.dot(line.foot - point) / slope, self.upper);
        }
        let aside = point - line.foot;
        let new = ((aside.dot(self.axes[0]), aside.dot(self.axes[1])), point.dot(line.direction));
        let nearest = if V::DIM == 2 { self.between(new) } else { self.through(new) };
        if let Some((corners, upper)) = nearest {
            self.narrow(self.lower, upper);
            self.points.splice(..self.corners, corners.into_iter().take(V::DIM - 1));
            self.corners = V::DIM - 1;
        }
        self.points.push(new);
        if self.points.len() > self.corners + LAST_POINTS {
            self.points.remove(self.corners);
        }
    }

    /// The point with which a new one has the line between them, in the plane, where that is nearer than the bound.
    fn between(&self, new: OffLine<V::Scalar>) -> Option<Enclosing<V::Scalar>> {
        let ends = self.points.iter().map(|&p| ([p, p], entry(&[(new.0.0, p.1), (-p.0.0, new.1)])));
        self.nearest(ends)
    }

    /// The points with which a new one has the line within their triangle, where that is nearer than the bound.
    fn through(&self, new: OffLine<V::Scalar>) -> Option<Enclosing<V::Scalar>> {
        let pairs = self.points.iter().enumerate().flat_map(|(i, &p)| self.points[..i].iter().map(move |&q| [p, q]));
        self.nearest(pairs.map(|[p, q]| {
            ([p, q], entry(&[(cross(q.0, new.0), p.1), (cross(new.0, p.0), q.1), (cross(p.0, q.0), new.1)]))
        }))
    }

    fn nearest(&self, found: impl Iterator<Item = Enclosing<V::Scalar>>) -> Option<Enclosing<V::Scalar>> {
        found.filter(|found| found.1 < self.upper).reduce(|a, b| if b.1 < a.1 { b } else { a })
    }
}

/// Where the line is in the hull of points, given zero's weight of each and where they are along the line; infinity if
/// the weights are of both signs.
fn entry<S: Scalar>(points: &[(S, S)]) -> S {
    let sum = points.iter().fold(S::ZERO, |sum, (weight, _)| sum + *weight);
    if sum != S::ZERO && points.iter().all(|(weight, _)| *weight * sum >= S::ZERO) {
        points.iter().fold(S::ZERO, |place, (weight, along)| place + *weight / sum * *along)
    } else {
        S::infinity()
    }
}
