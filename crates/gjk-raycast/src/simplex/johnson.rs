//! Johnson's distance subalgorithm (Section 3 of the paper).

use convex_support::{Scalar, Vector};

use crate::simplex::closest::{Closest, closest_in_face, nearest_face};
use crate::simplex::{Face, MAX_POINTS, faces};

/// The point of a simplex closest to zero, by Johnson's determinants.
///
/// With the vertices `y_i`, and `k` any index in `X`, the determinants are
///
/// ```text
/// Δ_i{i} = 1,   Δ_j(X ∪ {j}) = Σ_{i in X} Δ_i(X)·(y_k − y_j)·y_i,
/// ```
///
/// and the face is the `X` with `Δ_i(X) > 0` for all `i` in `X` and `Δ_j(X ∪ {j}) ≤ 0` for all others. Then `v = Σ
/// Δ_i·y_i / Σ Δ_i`. Each determinant is computed once. The differences are taken before the products: a product of
/// long vectors less another has no digits left for a short edge.
///
/// Rounding may change signs such that no face, or the wrong one, satisfies them. If none does, every face is tested
/// for the nearest. The point is recomputed in its face by orthogonal projection, because the weighted sum of long
/// vectors is a poor direction when it is short.
pub(crate) fn johnson<V: Vector>(points: &[V], dimension: usize) -> Option<Closest<V>> {
    let zero = V::Scalar::ZERO;
    let len = points.len();
    let mut delta = [[zero; MAX_POINTS]; 1 << MAX_POINTS];
    // Supersets have larger numbers, so that each set is complete when its turn comes.
    for x in faces(len, len) {
        let Some(k) = (0..len).find(|&k| x.has(k)) else { continue };
        if x.len() == 1 {
            delta[x.index()][k] = V::Scalar::ONE;
        }
        for j in (0..len).filter(|&j| !x.has(j)) {
            let difference = points[k] - points[j];
            let mut sum = zero;
            for i in (0..len).filter(|&i| x.has(i)) {
                sum += delta[x.index()][i] * difference.dot(points[i]);
            }
            delta[x.with(j).index()][j] = sum;
        }
    }
    let is_answer = |x: &Face| {
        (0..len).all(|i| if x.has(i) { delta[x.index()][i] > zero } else { delta[x.with(i).index()][i] <= zero })
    };
    let Some(face) = faces(len, dimension + 1).find(is_answer) else { return nearest_face(points, dimension) };
    closest_in_face(points, face, dimension).or_else(|| nearest_face(points, dimension))
}
