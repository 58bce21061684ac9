//! What bodies of revolution about the y axis have in common.

use num_traits::Float as _;

use crate::ball_support::swept_hessian;
use crate::numerics::elementary::hypot;
use crate::numerics::range::is_comfortable;
use crate::{Scalar, Vector3};

/// The part of `direction` across the y axis.
#[inline]
pub(crate) fn across<V: Vector3>(direction: V) -> V {
    direction - V::axis(1) * direction.get(1)
}

/// The Hessian of the support value `r·|a|` of a disc across the y axis, with `a` the part of the direction across the
/// axis, as seen along two changes. It is `r/|a|·t·tᵀ`, where the unit vector `t` is across the axis and `a`.
#[inline(always)]
pub(crate) fn disc_hessian<V: Vector3>(radius: V::Scalar, direction: V, [u, w]: [V; 2]) -> [V::Scalar; 3] {
    let (x, z) = (direction.get(0), direction.get(2));
    let squared = x * x + z * z;
    if !is_comfortable(squared) {
        return swept_hessian(radius, across(direction), [across(u), across(w)]);
    }
    let (tu, tw) = (u.get(0) * z - u.get(2) * x, w.get(0) * z - w.get(2) * x);
    let bend = radius / (squared * squared.sqrt());
    [tu * tu * bend, tu * tw * bend, tw * tw * bend]
}

/// The measures of a cone with its apex at `(0, half_height, 0)` and its base disc at `y = −half_height`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ConeMeasures<S> {
    pub(crate) half_height: S,
    /// The radius of the base disc.
    pub(crate) radius: S,
    /// The greatest length of its points.
    pub(crate) extent: S,
    /// Cosine and sine of half the opening angle.
    pub(crate) slant: (S, S),
}

impl<S: Scalar> ConeMeasures<S> {
    /// The cone of this half height and radius, neither of which is negative.
    pub(crate) fn new(half_height: S, radius: S) -> Self {
        // The slant is from the rim up to the apex; a point has an upright one.
        let half_radius = radius * S::from_f64(0.5);
        let half_length = hypot(half_height, half_radius);
        let slant = if half_length > S::ZERO {
            (half_height / half_length, half_radius / half_length)
        } else {
            (S::ONE, S::ZERO)
        };
        Self { half_height, radius, extent: hypot(radius, half_height), slant }
    }
}
