//! A triangle of points of the body that is seen around the line, by which an entry near an edge is bounded.
//!
//! Let `τ(x)` be where the line moved by `x` across itself enters the body: a convex function, whose graph is the body's lower hull. In a
//! triangle it is at most the height `h` of the highest corner. Where a point of the body is known at `(x', μ)`, no farther than `e` from
//! the line, and the sides of the triangle are farther than `m`, zero is between `x'` and a point of the triangle on the other side,
//! at least `m` away, so that
//!
//! ```text
//! τ(0) ≤ μ + (h − μ)·e/(e + m).
//! ```
//!
//! All points may be wrong by `e`, too: that raises the right side by `e`, and is taken from the distance of the sides.

use convex_support::{Scalar, Vector};

use super::ray_frame::{RayPoint, weights_of_zero};
use crate::symmetric::{Across, dot};

/// The corners, across the line and along it.
#[derive(Clone, Copy)]
pub(super) struct Window<S> {
    across: [Across<S>; 3],
    along: [S; 3],
}

impl<S: Scalar> Window<S> {
    #[inline(always)]
    pub(super) fn new<V: Vector<Scalar = S>, W>(corners: [&RayPoint<V, W>; 3]) -> Self {
        Self { across: corners.map(RayPoint::across), along: corners.map(|p| p.t) }
    }

    /// Where the line is in the body, at the latest, that has a point at `mu` to within an error; `None` where the triangle is not seen
    /// around it by more than that.
    #[cold]
    #[inline(never)]
    pub(super) fn latest_entry(&self, mu: S, error: S) -> Option<S> {
        let [p, q, s] = self.across;
        let side = |from: Across<S>, to: Across<S>| (to.0 - from.0, to.1 - from.1);
        // Twice the area that zero spans with a side is the length of that times its distance.
        let sides = [side(q, s), side(s, p), side(p, q)];
        let areas = weights_of_zero(self.across);
        let distance = |i: usize| areas[i].abs() / dot(sides[i], sides[i]).sqrt();
        let least = distance(0).min(distance(1)).min(distance(2));
        let is_around = areas.iter().all(|&area| area > S::ZERO) || areas.iter().all(|&area| area < S::ZERO);
        let [p, q, s] = self.along;
        let rise = (p.max(q).max(s) - mu).max(S::ZERO);
        (is_around && least > error + error).then(|| mu + error + rise * (error / least))
    }
}
