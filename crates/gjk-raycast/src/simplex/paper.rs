//! The papers' sub-algorithms for the point of a simplex closest to zero: signed volumes, and Johnson's distance
//! subalgorithm (Section 3 of the paper).

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::simplex::affine_hull::project;
use crate::simplex::closest::{Closest, closest_in_face, nearest_face};
use crate::simplex::{Face, MAX_POINTS, faces};

/// The face of a simplex closest to zero, by the signs of volumes, areas and lengths.
///
/// A face contains the foot of zero on its affine hull if replacing any corner by the foot leaves the sign of its
/// volume. Otherwise the closest point lies in a face without such a corner. Volumes of faces of lower dimension are
/// taken in their largest coordinate projection, so that every sign is that of a determinant of differences, and
/// nothing is divided before the face is known.
///
/// If rounding makes the signs inconsistent, every face is tested for the nearest.
///
/// # References
/// Mattia Montanari, Nik Petrinic, Ettore Barbieri, *Improving the GJK algorithm for faster and more reliable distance
/// queries between convex objects*, ACM Transactions on Graphics 36(3), 2017.
pub(crate) fn signed_volumes<V: Vector>(points: &[V], dimension: usize) -> Option<Closest<V>> {
    let all = faces(points.len(), points.len()).last()?;
    closest_below(points, all, dimension).or_else(|| nearest_face(points, dimension))
}

fn closest_below<V: Vector>(points: &[V], face: Face, dimension: usize) -> Option<Closest<V>> {
    let zero = V::Scalar::ZERO;
    if face.len() == 1 {
        return closest_in_face(points, face, dimension);
    }
    let mut corners = [V::ZERO; MAX_POINTS];
    let corners = face.of(points, &mut corners);
    let (volume, parts) = if face.len() > dimension + 1 { (zero, [zero; MAX_POINTS]) } else { volumes(corners) };
    let same = |part: V::Scalar| (part > zero && volume > zero) || (part < zero && volume < zero);
    if parts[..corners.len()].iter().all(|&part| same(part)) {
        return closest_in_face(points, face, dimension);
    }
    // The foot is beyond the faces opposite to the corners with another sign.
    let members = (0..points.len()).filter(|&i| face.has(i));
    let mut best: Option<Closest<V>> = None;
    for (member, &part) in members.zip(&parts) {
        if same(part) {
            continue;
        }
        if let Some(found) = closest_below(points, face.without(member), dimension)
            && best.is_none_or(|b| found.v.length_squared() < b.v.length_squared())
        {
            best = Some(found);
        }
    }
    best
}

/// The volumes of a simplex, and with each corner replaced by zero's foot on its affine hull; up to a common factor.
fn volumes<V: Vector>(corners: &[V]) -> (V::Scalar, [V::Scalar; MAX_POINTS]) {
    let n = corners.len() - 1;
    let foot = foot(corners);
    let axes = largest_projection(corners);
    let seen = |p: V| {
        let mut coordinates = [V::Scalar::ZERO; 3];
        for (c, &axis) in coordinates.iter_mut().zip(&axes[..n]) {
            *c = p.get(axis);
        }
        coordinates
    };
    let volume = |replaced: usize| {
        let at = |i: usize| if i == replaced { foot } else { corners[i] };
        let mut edges = [[V::Scalar::ZERO; 3]; 3];
        for (i, edge) in edges.iter_mut().enumerate().take(n) {
            *edge = seen(at(i) - at(n));
        }
        determinant(&edges, n)
    };
    let mut parts = [V::Scalar::ZERO; MAX_POINTS];
    for (i, part) in parts.iter_mut().enumerate().take(n + 1) {
        *part = volume(i);
    }
    (volume(MAX_POINTS), parts)
}

/// Zero's foot on the affine hull; zero itself in a simplex of full dimension.
fn foot<V: Vector>(corners: &[V]) -> V {
    if corners.len() > V::DIM {
        return V::ZERO;
    }
    -project(corners, |corner| -corner).across
}

/// The coordinate axes on whose plane or line the simplex has the largest volume.
fn largest_projection<V: Vector>(corners: &[V]) -> [usize; 3] {
    let n = corners.len() - 1;
    let candidates: &[[usize; 3]] = match (n, V::DIM) {
        (1, 2) => &[[0, 1, 2], [1, 0, 2]],
        (1, _) => &[[0, 1, 2], [1, 0, 2], [2, 0, 1]],
        (2, 3) => &[[0, 1, 2], [0, 2, 1], [1, 2, 0]],
        _ => &[[0, 1, 2]],
    };
    let size = |axes: &[usize; 3]| {
        let mut edges = [[V::Scalar::ZERO; 3]; 3];
        for (i, edge) in edges.iter_mut().enumerate().take(n) {
            for (c, &axis) in edge.iter_mut().zip(&axes[..n]) {
                *c = (corners[i] - corners[n]).get(axis);
            }
        }
        determinant(&edges, n).abs()
    };
    let mut best = candidates[0];
    for candidate in &candidates[1..] {
        if size(candidate) > size(&best) {
            best = *candidate;
        }
    }
    best
}

/// The determinant of the leading `n` rows and columns.
fn determinant<S: Scalar>(m: &[[S; 3]; 3], n: usize) -> S {
    let minor = |a: usize, b: usize| m[1][a] * m[2][b] - m[1][b] * m[2][a];
    match n {
        1 => m[0][0],
        2 => m[0][0] * m[1][1] - m[0][1] * m[1][0],
        _ => m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1),
    }
}

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
