//! The reference that finds where two bodies touch: the distance algorithm of Gilbert, Johnson and Keerthi in its
//! plainest form, checked by its own bound.

use crate::shapes::Shape;
use crate::vec3::{Quat, Vec3, add, conjugate, dot, neg, norm, rotate, scale, sub};

/// A body turned by a unit quaternion, then moved.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// The rotation `(x, y, z, w)`.
    pub rotation: Quat,
    /// The translation.
    pub translation: Vec3,
}

/// The answer of [`shortest_vector`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shortest {
    /// The bodies overlap.
    Inside,
    /// The shortest vector of `A − B`, and by how much it may be too long.
    Outside { v: Vec3, gap: f64 },
}

impl Shortest {
    /// Whether a plane is known that separates the bodies.
    pub(crate) fn separated(self) -> bool {
        match self {
            Self::Inside => false,
            Self::Outside { v, gap } => norm(v) > gap,
        }
    }
}

/// The shortest vector of `A − B`, for `A` where it is and `B` in `pose`.
pub(crate) fn shortest_vector(a: &Shape, b: &Shape, pose: Pose) -> Shortest {
    let inverse = conjugate(pose.rotation);
    let support = |direction: Vec3| {
        let on_b = b.support(rotate(inverse, neg(direction)));
        sub(a.support(direction), add(rotate(pose.rotation, on_b), pose.translation))
    };
    let mut v = neg(pose.translation);
    let mut simplex: Vec<Vec3> = Vec::with_capacity(4);
    let mut bound = f64::NEG_INFINITY;
    let mut best = (f64::INFINITY, v);
    for _ in 0..200 {
        let w = support(neg(v));
        // The plane through w with normal v separates zero from the whole of A − B.
        bound = bound.max(dot(v, w) / norm(v));
        if best.0 - bound <= 1e-15 || simplex.contains(&w) {
            break;
        }
        simplex.push(w);
        let Some((closest, kept)) = closest_point(&simplex) else { return Shortest::Inside };
        if norm(closest) < 1e-15 {
            return Shortest::Inside;
        }
        if norm(closest) >= best.0 {
            break; // rounding: the simplex is no longer any help
        }
        (v, simplex) = (closest, kept);
        best = (norm(v), v);
    }
    Shortest::Outside { v: best.1, gap: best.0 - bound }
}

/// The point of a simplex closest to zero, and the vertices of the face it lies in; `None` if a tetrahedron holds zero.
///
/// Every face is tried: the closest point of its plane is a candidate if it lies in the face, and the closest of them
/// all is the answer.
fn closest_point(simplex: &[Vec3]) -> Option<(Vec3, Vec<Vec3>)> {
    let mut best: Option<(Vec3, Vec<Vec3>)> = None;
    for subset in 1_usize..1 << simplex.len() {
        let face: Vec<Vec3> = (0..simplex.len()).filter(|i| subset >> i & 1 == 1).map(|i| simplex[i]).collect();
        let Some(weights) = closest_weights(&face) else { continue };
        if face.len() == 4 {
            return None;
        }
        let point = face.iter().zip(weights).fold([0.0; 3], |sum, (&y, weight)| add(sum, scale(y, weight)));
        if best.as_ref().is_none_or(|(closest, _)| norm(point) < norm(*closest)) {
            best = Some((point, face));
        }
    }
    best
}

/// The barycentric coordinates of the point closest to zero in the plane of a face, if none is negative.
///
/// With the edges `eᵢ = yᵢ − y₀`, the closest point `y₀ + Σ xᵢeᵢ` is perpendicular to all of them:
/// `Σⱼ (eᵢ·eⱼ) xⱼ = −eᵢ·y₀`.
fn closest_weights(face: &[Vec3]) -> Option<[f64; 4]> {
    let edges: Vec<Vec3> = face[1..].iter().map(|&y| sub(y, face[0])).collect();
    let right = |i: usize| -dot(edges[i], face[0]);
    let x = match edges.len() {
        0 => [0.0; 3],
        1 => [right(0) / dot(edges[0], edges[0]), 0.0, 0.0],
        2 => {
            let (a, b, c) = (dot(edges[0], edges[0]), dot(edges[0], edges[1]), dot(edges[1], edges[1]));
            let determinant = a * c - b * b;
            [(right(0) * c - right(1) * b) / determinant, (a * right(1) - b * right(0)) / determinant, 0.0]
        }
        _ => {
            let (e, r) = (&edges, neg(face[0]));
            let determinant = triple(e[0], e[1], e[2]);
            [triple(r, e[1], e[2]), triple(e[0], r, e[2]), triple(e[0], e[1], r)].map(|d| d / determinant)
        }
    };
    let weights = [1.0 - x[0] - x[1] - x[2], x[0], x[1], x[2]];
    weights.iter().all(|&weight| weight >= 0.0).then_some(weights)
}

fn triple(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    dot(a, crate::vec3::cross(b, c))
}
