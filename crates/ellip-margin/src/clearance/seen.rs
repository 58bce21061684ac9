//! A link that has moved little: a bound on its distance from anything.

use convex_support::{Ellipsoid, Scalar, Vector};

use super::search::Normals;
use crate::margin::scale_after;

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
    /// A lower bound on √(1 + m) with the link at `now` and the obstacles drifted: an obstacle's point that moves by η
    /// moves by η/a_min in the ball at most. If nothing is known, it is not positive.
    pub(super) fn bound_after(&self, now: &Ellipsoid<V>, drift: f64) -> f64 {
        let least = self.link.semi_axes().min_element().as_f64();
        scale_after(self.scale, &self.link, now) - (drift - self.drift) / least * (1.0 + 1e-12)
    }
}
