//! Boxes, moved or sheared in any way, by their edges.

use crate::Vector;

/// A parallelotope: the points `center + t₀·e₀ + t₁·e₁ + t₂·e₂` with all `|tᵢ| ≤ 1`. A box, whatever linear map it went
/// through; a parallelogram or a segment, where edges are zero.
///
/// The difference of two is a zonotope, each of whose facets is spanned by two of the edges of both, in 2D by one: so
/// its facets are known without a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallelotope<V> {
    /// The centre.
    pub center: V,
    /// Half of each edge; in 2D the third is zero.
    pub half_edges: [V; 3],
}

impl<V: Vector> Parallelotope<V> {
    /// The single point `center`.
    #[must_use]
    pub fn point(center: V) -> Self {
        Self { center, half_edges: [V::ZERO; 3] }
    }

    /// The image under a linear map and then a translation.
    #[inline(always)]
    #[must_use]
    pub(crate) fn mapped(self, linear: impl Fn(V) -> V, translation: V) -> Self {
        let mut half_edges = self.half_edges;
        for edge in &mut half_edges[..V::DIM] {
            *edge = linear(*edge);
        }
        Self { center: linear(self.center) + translation, half_edges }
    }
}
