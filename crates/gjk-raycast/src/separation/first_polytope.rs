//! The first polytope of an expansion.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::boundary::Boundary;
use super::cores::{Cores, Vertex, WayOut};
use crate::gjk::Gjk;
use crate::simplex::{MAX_POINTS, cross};

/// The start of an expansion, with the best way out found so far.
#[derive(Clone, Copy, Debug)]
pub(super) enum FirstPolytope<V: Vector> {
    /// The boundary of a simplex.
    Full(WayOut<V>),
    /// The difference is no thicker than rounding along this direction.
    Flat(WayOut<V>),
}

/// A simplex of support points, beginning with those of GJK; `None` if a support point is not finite.
///
/// For cores in deep overlap GJK has led to a simplex that is thicker than rounding. As long as the points span no
/// volume, those farthest both ways across them are computed, and the farther one is added.
#[inline]
pub(super) fn first_polytope<V: Vector>(
    cores: &mut Cores<'_, V>,
    state: &Gjk<V>,
    boundary: &mut Boundary<V>,
) -> Option<FirstPolytope<V>> {
    let known = state.simplex.points().len();
    let is_curved = cores.is_curved();
    let mut span = AffineSpan::new();
    let mut vertices = span.points;
    for (i, vertex) in vertices[..known].iter_mut().enumerate() {
        let along = state.simplex.along()[i];
        // Nothing asks for the length of others.
        let along = if is_curved { along.unit().unwrap_or(along) } else { along };
        *vertex = Vertex { point: state.simplex.points()[i], along, pair: state.simplex.witnesses()[i] };
    }
    // GJK's best plane is a way out; its support point may be dropped.
    let mut best = state
        .axis
        .unit()
        .filter(|_| known > 0 && state.lower.is_finite())
        .map(|n| WayOut { h: -state.lower, vertex: Vertex { along: -n, ..vertices[0] } });
    if known > V::DIM
        && let Some(best) = best
    {
        let thickness = cores.greatest_error() * Scalar::from_f64(2.0);
        if boundary.begin(&vertices[..known], thickness) {
            return Some(FirstPolytope::Full(best));
        }
    }
    for vertex in &vertices[..known] {
        let _ = span.add(cores, vertex);
    }
    while span.len < V::DIM + 1 {
        let u = span.across();
        let ways = [WayOut::new(cores.support(u)?), WayOut::new(cores.support(-u)?)];
        let least = if ways[1].h < ways[0].h { ways[1] } else { ways[0] };
        if best.is_none_or(|best| least.h < best.h) {
            best = Some(least);
        }
        if span.len == 0 {
            let _ = span.add(cores, &ways[0].vertex);
        }
        let height = |way: &WayOut<V>| way.h - way.u().dot(span.points[0].point);
        let farther = if height(&ways[1]) > height(&ways[0]) { ways[1] } else { ways[0] };
        if !span.add(cores, &farther.vertex) {
            return Some(FirstPolytope::Flat(least));
        }
    }
    if !boundary.begin(&span.points[..span.len], Scalar::ZERO) {
        return None;
    }
    let best = match best {
        Some(best) => best,
        None => {
            let (nearest, _) = boundary.nearest();
            let u = boundary.facet_at(nearest).normal;
            WayOut::new(cores.support(u)?)
        }
    };
    Some(FirstPolytope::Full(best))
}

/// Affinely independent points.
struct AffineSpan<V: Vector> {
    points: [Vertex<V>; MAX_POINTS],
    len: usize,
    /// Orthogonal unit vectors along the edges from the first point.
    basis: [V; MAX_POINTS],
}

impl<V: Vector> AffineSpan<V> {
    fn new() -> Self {
        let none = Vertex { point: V::ZERO, along: V::ZERO, pair: Default::default() };
        Self { points: [none; MAX_POINTS], len: 0, basis: [V::ZERO; MAX_POINTS] }
    }

    /// Adds a point, unless it is no farther from the span of the others than rounding; whether it was added.
    #[inline(never)]
    fn add(&mut self, cores: &Cores<'_, V>, &vertex: &Vertex<V>) -> bool {
        if self.len > 0 {
            let edge = self.orthogonal(vertex.point - self.points[0].point);
            match edge.unit() {
                Some(u) if u.dot(edge) > cores.rounding_along(u) => self.basis[self.len - 1] = u,
                _ => return false,
            }
        }
        self.points[self.len] = vertex;
        self.len += 1;
        true
    }

    /// The part of a vector across the span. Done twice, it is so to rounding.
    #[inline(never)]
    fn orthogonal(&self, mut v: V) -> V {
        for _ in 0..2 {
            for &e in &self.basis[..self.len.saturating_sub(1)] {
                v -= e * e.dot(v);
            }
        }
        v
    }

    fn across(&self) -> V {
        if V::DIM == 3 && self.len == 3 {
            return cross(self.basis[0], self.basis[1]).unit().unwrap_or_else(|| V::axis(0));
        }
        let mut best = V::ZERO;
        for i in 0..V::DIM {
            let v = self.orthogonal(V::axis(i));
            if v.length_squared() > best.length_squared() {
                best = v;
            }
        }
        best.unit().unwrap_or_else(|| V::axis(0))
    }
}

/// The number of points is no more than the room for them.
const _: () = assert!(MAX_POINTS == 4, "a simplex in space has four points");
