//! The point of a simplex closest to zero, searched from its newest vertex.

use convex_support::numerics::angular::cross;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::simplex::{Face, MAX_POINTS};

/// The face of a simplex that is closest to zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestFace<V> {
    pub(crate) face: Face,
    /// A vector along the shortest one from zero to the face, of any length; zero if the simplex has full dimension and
    /// certainly contains zero.
    pub(crate) normal: V,
}

/// A simplex counts as flat if its volume is less than this many rounding errors of the product of its edges.
const FLAT: f64 = 64.0;

/// The face of a simplex closest to zero, if it has the newest point `y` as a corner and rounding leaves little doubt.
///
/// In GJK a support point is added because it is nearer to zero, along the shortest vector so far, than all the others,
/// which are equally near. So it is a corner of the nearest face. With edges `e_i = y_i − y`, products `G_ij = e_i·e_j`
/// and `g_i = −y·e_i`, zero's foot on a face is `y + Σ t_i·e_i` with
///
/// ```text
/// edge i:       t_i = g_i / G_ii,
/// facet i, j:   t_j = r_ij / (G_ii·G_jj − G_ij²),   r_ij = g_j·G_ii − g_i·G_ij,
/// all of 3D:    t_k = −y·n_k / det,   n_k = e_i × e_j,   det = e_k·n_k,
/// ```
///
/// and zero is in the region of a face if the `t` of the face are positive and those of each further corner are not.
/// These are Johnson's determinants of the faces at `y`, as differences of points that are near one another. In space a
/// facet's normal comes from the cross product, right to rounding however near zero is; an edge's normal is equally
/// accurate, by two projections.
///
/// A wrong sign costs no more than a step: the caller measures the distance of whatever face is found. Only that zero
/// is inside needs proof here. `None` if no region fits.
#[inline(always)]
pub(crate) fn nearest<V: Vector>(points: &[V; MAX_POINTS], newest: usize, y: V) -> Option<NearestFace<V>> {
    match newest {
        0 => Some(vertex(0, y)),
        1 => of_segment(y, points[0] - y),
        2 => of_triangle(y, [points[0] - y, points[1] - y]),
        _ => of_tetrahedron(y, [points[0] - y, points[1] - y, points[2] - y]),
    }
}

#[inline(always)]
fn vertex<V: Vector>(newest: usize, y: V) -> NearestFace<V> {
    NearestFace { face: Face::of_corners(&[newest]), normal: y }
}

/// The edge along `e` from the newest point to point `i`.
#[inline(always)]
fn edge<V: Vector>(newest: usize, i: usize, y: V, e: V, squared: V::Scalar) -> NearestFace<V> {
    let per_square = squared.recip();
    let across = |v: V| v - e * (v.dot(e) * per_square);
    // Twice, because the first projection leaves rounding errors of the length of y along e.
    NearestFace { face: Face::of_corners(&[newest, i]), normal: across(across(y)) }
}

#[inline(always)]
fn of_segment<V: Vector>(y: V, e: V) -> Option<NearestFace<V>> {
    let (squared, g) = (e.length_squared(), -y.dot(e));
    if g >= squared {
        return None;
    }
    Some(if g > V::Scalar::ZERO { edge(1, 0, y, e, squared) } else { vertex(1, y) })
}

#[inline(always)]
fn of_triangle<V: Vector>(y: V, e: [V; 2]) -> Option<NearestFace<V>> {
    let zero = V::Scalar::ZERO;
    let (g00, g01, g11) = (e[0].length_squared(), e[0].dot(e[1]), e[1].length_squared());
    let (g0, g1) = (-y.dot(e[0]), -y.dot(e[1]));
    let (r0, r1) = (g0 * g11 - g1 * g01, g1 * g00 - g0 * g01);
    if r0 > zero && r1 > zero {
        let determinant = g00 * g11 - g01 * g01;
        let flat = flatness::<V>() * g00 * g11;
        if r0 + r1 >= determinant {
            return None;
        }
        if V::DIM == 2 {
            // In the plane the triangle has full dimension; its r are areas squared.
            let doubt = flatness::<V>() * y.length_squared() * g00 * g11;
            let inside = determinant > flat && r0 * r0 > doubt * g11 && r1 * r1 > doubt * g00;
            return inside.then_some(NearestFace { face: Face::of_corners(&[0, 1, 2]), normal: V::ZERO });
        }
        let normal = towards(cross(e[0], e[1]), y);
        return (normal.length_squared() > flat).then_some(NearestFace { face: Face::of_corners(&[0, 1, 2]), normal });
    }
    if g0 > zero && r1 <= zero {
        (g0 < g00).then(|| edge(2, 0, y, e[0], g00))
    } else if g1 > zero && r0 <= zero {
        (g1 < g11).then(|| edge(2, 1, y, e[1], g11))
    } else {
        (g0 <= zero && g1 <= zero).then(|| vertex(2, y))
    }
}

#[inline(always)]
fn of_tetrahedron<V: Vector>(y: V, e: [V; 3]) -> Option<NearestFace<V>> {
    let zero = V::Scalar::ZERO;
    let squared = [e[0].length_squared(), e[1].length_squared(), e[2].length_squared()];
    let (g01, g12, g20) = (e[0].dot(e[1]), e[1].dot(e[2]), e[2].dot(e[0]));
    let g = [-y.dot(e[0]), -y.dot(e[1]), -y.dot(e[2])];
    let n = [cross(e[1], e[2]), cross(e[2], e[0]), cross(e[0], e[1])];
    let det = e[0].dot(n[0]);
    // With the sign of det, so that positive means inside.
    let sign = V::Scalar::ONE.copysign(det);
    let s = [-y.dot(n[0]) * sign, -y.dot(n[1]) * sign, -y.dot(n[2]) * sign];
    if s[0] > zero && s[1] > zero && s[2] > zero {
        let doubt = flatness::<V>() * y.length_squared();
        let inside = det * det > flatness::<V>() * squared[0] * n[0].length_squared()
            && s[0] * s[0] > doubt * squared[1] * squared[2]
            && s[1] * s[1] > doubt * squared[2] * squared[0]
            && s[2] * s[2] > doubt * squared[0] * squared[1]
            && s[0] + s[1] + s[2] < det.abs();
        return inside.then_some(NearestFace { face: Face::of_corners(&[0, 1, 2, 3]), normal: V::ZERO });
    }
    // r[i][j] for the facets in the order of n: the part across edge i for the corner of edge j.
    let (r01, r10) = (g[1] * squared[0] - g[0] * g01, g[0] * squared[1] - g[1] * g01);
    let (r12, r21) = (g[2] * squared[1] - g[1] * g12, g[1] * squared[2] - g[2] * g12);
    let (r20, r02) = (g[0] * squared[2] - g[2] * g20, g[2] * squared[0] - g[0] * g20);
    // If s is not positive, the normal that makes det positive points to the side of y.
    let facet = |k: usize, i: usize, j: usize, r: V::Scalar| {
        let area = n[k].length_squared();
        (r < area && area > flatness::<V>() * squared[i] * squared[j])
            .then(|| NearestFace { face: Face::of_corners(&[i, j, 3]), normal: n[k] * sign })
    };
    if s[0] <= zero && r12 > zero && r21 > zero {
        return facet(0, 1, 2, r12 + r21);
    }
    if s[1] <= zero && r20 > zero && r02 > zero {
        return facet(1, 2, 0, r20 + r02);
    }
    if s[2] <= zero && r01 > zero && r10 > zero {
        return facet(2, 0, 1, r01 + r10);
    }
    let along = |i: usize| (g[i] < squared[i]).then(|| edge(3, i, y, e[i], squared[i]));
    if g[0] > zero && r01 <= zero && r02 <= zero {
        along(0)
    } else if g[1] > zero && r12 <= zero && r10 <= zero {
        along(1)
    } else if g[2] > zero && r20 <= zero && r21 <= zero {
        along(2)
    } else {
        (g[0] <= zero && g[1] <= zero && g[2] <= zero).then(|| vertex(3, y))
    }
}

/// The square of [`FLAT`] rounding errors.
#[inline]
fn flatness<V: Vector>() -> V::Scalar {
    let flat = V::Scalar::from_f64(FLAT) * V::Scalar::EPSILON;
    flat * flat
}

/// The normal or its opposite, whichever points to the side of `y`.
#[inline(always)]
fn towards<V: Vector>(normal: V, y: V) -> V {
    if normal.dot(y) < V::Scalar::ZERO { -normal } else { normal }
}

/// Whether zero is in the simplex of some points, even if each is wrong by an error, which is at least `8ε` of the
/// longest.
///
/// It is if it has the same orientation with each face as the corner opposite. This is the sign of a determinant,
/// which an error `e` of each corner changes by no more than `e·Σ(|q| + e)(|r| + e)` over the pairs of corners of the
/// face; in the plane `e·Σ(|q| + e)`. Its computation loses no more than as much again.
///
/// [`room_within`](crate::separation::room_within()) says by how much, in more than twice the operations, which every
/// query whose bodies overlap would pay.
pub(crate) fn is_around_zero<V: Vector>(points: &[V], error: V::Scalar) -> bool {
    let length = |p: V| p.length() + error;
    let twice = error * V::Scalar::from_f64(2.0);
    let mut sides = (0, 0);
    let mut sees = |determinant: V::Scalar, wrong: V::Scalar| {
        sides.0 += usize::from(determinant > wrong);
        sides.1 += usize::from(determinant < -wrong);
    };
    match *points {
        [p, q, r] if V::DIM == 2 => {
            for [p, q] in [[p, q], [q, r], [r, p]] {
                sees(p.get(0) * q.get(1) - p.get(1) * q.get(0), twice * (length(p) + length(q)));
            }
        }
        [p, q, r, s] => {
            let (pq, rs) = (cross(p, q), cross(r, s));
            let [lp, lq, lr, ls] = [p, q, r, s].map(length);
            let (sum_pq, sum_rs, product_pq, product_rs) = (lp + lq, lr + ls, lp * lq, lr * ls);
            sees(q.dot(rs), twice * (product_rs + lq * sum_rs));
            sees(-p.dot(rs), twice * (product_rs + lp * sum_rs));
            sees(s.dot(pq), twice * (product_pq + ls * sum_pq));
            sees(-r.dot(pq), twice * (product_pq + lr * sum_pq));
        }
        _ => return false,
    }
    sides.0.max(sides.1) == V::DIM + 1
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DVec2, DVec3};

    use super::*;

    /// A corner that is wrong by more than zero is from a face may leave zero outside. The bound is a sum over the
    /// edges of a face, so that zero has to be a few errors within.
    #[test]
    fn zero_is_inside_only_beyond_the_error_of_the_corners() {
        let tetrahedron = |depth: f64| {
            [DVec3::new(-1.0, -1.0, -depth), DVec3::new(2.0, -1.0, -depth), DVec3::new(-1.0, 2.0, -depth), DVec3::Z]
        };
        for depth in [1e-3, 1e-9, 1e-14] {
            assert!(is_around_zero(&tetrahedron(depth), depth / 64.0), "{depth}");
            assert!(!is_around_zero(&tetrahedron(depth), depth), "{depth}");
            assert!(!is_around_zero(&tetrahedron(-depth), 0.0), "{depth}");
        }
        let triangle = [DVec2::new(-1.0, -1e-9), DVec2::new(1.0, -1e-9), DVec2::Y];
        assert!(is_around_zero(&triangle, 1e-11) && !is_around_zero(&triangle, 1e-9));
        assert!(!is_around_zero(&triangle[..2], 0.0), "a segment has no inside");
        assert!(!is_around_zero(&[DVec3::NAN; 4], 0.0), "NaN is nowhere");
    }
}
