//! The facets of a small point set in general position, by incremental insertion: a reference, not a fast method.

use std::collections::BTreeSet;

use crate::real::Real;
use crate::vec3::{Vec3, cross, dot, norm, scale, sub};

/// The plane `{ x : normal·x = offset }`, with the hull on its lower side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub normal: Vec3,
    pub offset: f64,
}

/// The triangular facets of the hull of at least four points in general position, counter-clockwise from outside.
///
/// The first four points make a tetrahedron. Each further point that sees some of the facets replaces them by the
/// triangles between itself and the horizon, `[a, b, point]` for the horizon's edge `a → b`. What a point sees is
/// computed in numbers of the type `R`.
#[must_use]
pub fn facets<R: Real>(points: &[Vec3]) -> Vec<[usize; 3]> {
    let sees = |facet: [usize; 3], p: Vec3| {
        let [a, b, c] = facet.map(|i| points[i].map(R::from));
        dot(cross(sub(b, a), sub(c, a)), sub(p.map(R::from), a)) > R::from(0.0)
    };
    let center = [0, 1, 2].map(|k| (points[0][k] + points[1][k] + points[2][k] + points[3][k]) / 4.0);
    let mut facets: Vec<[usize; 3]> = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
        .into_iter()
        .map(|[a, b, c]| if sees([a, b, c], center) { [a, c, b] } else { [a, b, c] })
        .collect();
    for (i, &point) in points.iter().enumerate().skip(4) {
        let visible: Vec<_> = facets.extract_if(.., |facet| sees(*facet, point)).collect();
        let edges: BTreeSet<_> = visible.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
        let horizon = edges.iter().filter(|&&(a, b)| !edges.contains(&(b, a)));
        facets.extend(horizon.map(|&(a, b)| [a, b, i]));
    }
    facets
}

/// The planes of [`facets`].
pub(crate) fn planes(points: &[Vec3]) -> Vec<Plane> {
    let plane = |facet: [usize; 3]| {
        let [a, b, c] = facet.map(|i| points[i]);
        let normal = cross(sub(b, a), sub(c, a));
        let normal = scale(normal, 1.0 / norm(normal));
        Plane { normal, offset: dot(normal, a) }
    };
    facets::<f64>(points).into_iter().map(plane).collect()
}
