//! A link that has moved little: a bound on its distance from anything.

use convex_support::{Ellipsoid, Scalar, Vector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::frame::{columns, padded};
use super::search::Normals;
use crate::numerics::{dot, sub};

/// A link where its margins were last bounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<V: Vector> {
    pub(super) link: Ellipsoid<V>,
    /// √(1 + m) was at least this for every obstacle.
    pub(super) scale: f64,
    /// The drift at that time.
    pub(super) drift: f64,
    /// The pairs solved last, the newest first.
    pub(super) normals: Normals,
}

impl<V: Vector> Seen<V> {
    /// A lower bound on √(1 + m) with the link at `now` and the obstacles drifted.
    ///
    /// A point with the coordinates p = diag(a)⁻¹Rᵀ(x − x₁) in the old ball has p′ = Gp + δ in the new one, with G =
    /// diag(a)⁻¹R′ᵀR·diag(a), δ = diag(a)⁻¹R′ᵀ(x₁ − x₁′): ‖p′‖ ≥ (1 − ‖G − I‖)‖p‖ − ‖δ‖. And an obstacle's point that
    /// moves by η moves by η/a_min in the ball at most.
    pub(super) fn bound_after(&self, now: &Ellipsoid<V>, drift: f64) -> f64 {
        let a: [f64; 3] = padded(self.link.semi_axes());
        if padded(now.semi_axes()) != a || self.scale == 0.0 {
            return 0.0;
        }
        let n = V::DIM;
        let (old, new) = (columns(self.link.axes()), columns(now.axes()));
        let moved = sub(padded(self.link.center()), padded(now.center()));
        let (mut turn, mut shift, mut least) = (0.0, 0.0, f64::INFINITY);
        for i in 0..n {
            for j in 0..n {
                let entry = (dot(new[i], old[j]) - f64::from(u8::from(i == j))) * (a[j] / a[i]);
                turn += entry * entry;
            }
            let delta = dot(new[i], moved) / a[i];
            shift += delta * delta;
            least = a[i].min(least);
        }
        // A generous bound on the rounding of axes and products.
        let aspect = a[..n].iter().fold(0.0f64, |m, x| m.max(*x)) / least;
        let turn = turn.sqrt() + 64.0 * V::Scalar::EPSILON.as_f64() * aspect;
        (1.0 - turn) * self.scale - shift.sqrt() * (1.0 + 1e-12) - (drift - self.drift) / least * (1.0 + 1e-12)
    }
}
