//! The point of a simplex closest to zero.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::simplex::MAX_POINTS;

/// The point of a simplex closest to zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest<V: Vector> {
    /// The point.
    pub(crate) v: V,
    /// Its barycentric coordinates: positive for the smallest face that contains it, zero elsewhere.
    pub(crate) weights: [V::Scalar; MAX_POINTS],
    /// Whether the simplex has full dimension and contains zero.
    pub(crate) contains: bool,
}

/// The closest point found by looking at every face, and taking the nearest of those whose affine hull comes closest
/// to zero within the face. The newest point, the last, belongs to the face unless the simplex is degenerate.
pub(crate) fn closest<V: Vector>(points: &[V]) -> Option<Closest<V>> {
    let mut best: Option<Closest<V>> = None;
    let mut least = V::Scalar::infinity();
    for face in 1_u8..1 << points.len() {
        let mut corners = [V::ZERO; MAX_POINTS];
        let mut count = 0;
        for (i, &point) in points.iter().enumerate() {
            if face >> i & 1 == 1 {
                corners[count] = point;
                count += 1;
            }
        }
        let Some((v, coordinates)) = foot(&corners[..count]) else { continue };
        let contains = count > V::DIM;
        let squared = if contains { V::Scalar::ZERO } else { v.length_squared() };
        if squared < least {
            let mut weights = [V::Scalar::ZERO; MAX_POINTS];
            let mut next = 0;
            for (i, weight) in weights.iter_mut().enumerate().take(points.len()) {
                if face >> i & 1 == 1 {
                    *weight = coordinates[next];
                    next += 1;
                }
            }
            least = squared;
            best = Some(Closest { v, weights, contains });
        }
    }
    best
}

/// The point of the affine hull of up to four points closest to zero and its barycentric coordinates, if these are all
/// positive; `None` also where the points are affinely dependent to rounding.
///
/// With the newest point `y` and edges `e_i = y_i − y`, the edges are made orthogonal by Gram–Schmidt,
///
/// ```text
/// f_i = e_i − Σ_{j<i} c_ij·f_j,   c_ij = e_i·f_j / f_j·f_j,
/// ```
///
/// and zero's foot is `v = y − Σ t_i·f_i` with `t_i = y·f_i / f_i·f_i`. The coordinates follow by back-substitution:
/// `v = y + Σ b_i·e_i` with `b_i = −t_i − Σ_{k>i} b_k·c_ki`. Each projection is done twice, after which the result is
/// orthogonal to rounding even where nearly everything cancels: `v` keeps its direction when zero is close.
pub(crate) fn foot<V: Vector>(points: &[V]) -> Option<(V, [V::Scalar; MAX_POINTS])> {
    let zero = V::Scalar::ZERO;
    let (&y, others) = points.split_last()?;
    let n = others.len();
    let mut f = [V::ZERO; 3];
    let mut c = [[zero; 3]; 3];
    let mut squared = [zero; 3];
    for i in 0..n {
        let mut fi = others[i] - y;
        for _ in 0..2 {
            for j in 0..i {
                let cij = fi.dot(f[j]) / squared[j];
                fi -= f[j] * cij;
                c[i][j] += cij;
            }
        }
        f[i] = fi;
        squared[i] = fi.length_squared();
    }
    let mut v = y;
    let mut t = [zero; 3];
    for _ in 0..2 {
        for i in 0..n {
            let ti = v.dot(f[i]) / squared[i];
            v -= f[i] * ti;
            t[i] += ti;
        }
    }
    let mut b = [zero; MAX_POINTS];
    let mut rest = V::Scalar::ONE;
    for i in (0..n).rev() {
        b[i] = -t[i];
        for k in i + 1..n {
            b[i] -= b[k] * c[k][i];
        }
        rest -= b[i];
        // Not `b <= 0`: NaN, from edges of length zero, must end here too.
        if !(b[i] > zero) {
            return None;
        }
    }
    b[n] = rest;
    (rest > zero).then_some((v, b))
}
