//! Where a cast begins in contact, or within a few errors of it: whether that is a hit.
//!
//! What a cast knows of its start is known to the errors of the largest number in it. Looked at
//! [once more](crate::gjk::near_contact()), a source may turn out to be apart from the target: then a ray that leaves or slides by
//! misses, and one that approaches hits a little later.

use convex_support::numerics::bound::roundings;
use convex_support::numerics::twofold::dot_minus;
use convex_support::{Rounded, Scalar, SupportMap, Vector};
use num_traits::Float;

use super::Cast;
use crate::gjk::{Shape, near_contact};
use crate::{Miss, Outcome, RayCastOptions, Status};

/// Decides about a hit at λ = 0, or about a search that stalled before it left the source, of the ray that `b` draws as it moves along
/// `direction` towards `a` swept by a ball, its skin.
#[inline(always)]
pub(crate) fn settle_start<A, B, W>(
    cast: &mut Cast<A::Vector, W>,
    a: &A,
    skin: <A::Vector as Vector>::Scalar,
    b: impl FnOnce() -> Option<B>,
    direction: A::Vector,
    options: &RayCastOptions<A::Vector>,
) where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector>,
{
    let zero = <A::Vector as Vector>::Scalar::ZERO;
    let is_at_start = match &cast.outcome {
        Outcome::Hit(hit) => hit.lambda == zero,
        Outcome::Undecided => cast.status == Status::Stalled && cast.lower == zero,
        Outcome::Miss(_) => false,
    };
    if is_at_start
        && cast.upper > zero
        && let Some(b) = b()
        && let Ok(a) = Rounded::new(a, skin)
    {
        let start = start(&a, &b, direction, options.max_iterations);
        cast.iterations += start.iterations;
        match start.way {
            Way::Touches { within } if matches!(cast.outcome, Outcome::Hit(_)) => cast.upper = within,
            Way::Touches { .. } => {}
            Way::Leaves { axis } => cast.miss(axis),
            // Whether a hit at the very end of the ray counts is decided by λ as it is returned.
            Way::Enters { lambda, axis, .. } if lambda > options.max_lambda => cast.miss(axis),
            Way::Enters { lambda, lower, axis } => cast.enter(lambda, lower, axis),
        }
    }
}

/// How the bodies are to one another where the cast begins.
struct Start<V: Vector> {
    way: Way<V>,
    iterations: usize,
}

/// How a ray goes on from a source near the target. The axis is a unit vector from the target to the source, along which they are
/// apart.
enum Way<V: Vector> {
    /// The source is in the target, to the error it is known to, which is that long along the ray, in units of λ.
    Touches { within: V::Scalar },
    /// It is apart, and the ray comes no nearer along the axis.
    Leaves { axis: V },
    /// It is apart, and the ray crosses the plane between them at λ, and not before `lower`.
    Enters { lambda: V::Scalar, lower: V::Scalar, axis: V },
}

#[cold]
#[inline(never)]
fn start<V: Vector>(a: Shape<'_, V>, b: Shape<'_, V>, direction: V, max_iterations: usize) -> Start<V> {
    let zero = V::Scalar::ZERO;
    let Some(near) = near_contact(a, b, max_iterations) else {
        return Start { way: Way::Touches { within: Float::infinity() }, iterations: 0 };
    };
    // The bodies are apart by `gap − λ·n·d` along the normal: the sign of the product is exact.
    let axis = -near.normal;
    let closing = dot_minus((0..V::DIM).map(|i| (near.normal.get(i), direction.get(i))), zero);
    let way = if !near.is_separated() {
        let within = if near.overlaps_certainly { zero } else { near.upper.max(zero) };
        // A ray that leaves, or one from deep inside, is as near as it ever is.
        let approaches = closing > zero && near.gap.abs() <= near.upper;
        let speed = if approaches { closing } else { direction.norm() };
        Way::Touches { within: within * near.frame.scale / speed }
    } else if closing <= zero {
        Way::Leaves { axis }
    } else {
        let at = |gap: V::Scalar| gap * near.frame.scale / closing;
        // What the quotient loses.
        let lower = at(near.lower);
        Way::Enters { lambda: at(near.gap), lower: lower - roundings(8.0, lower), axis }
    };
    Start { way, iterations: near.state.iterations }
}

impl<V: Vector, W> Cast<V, W> {
    fn miss(&mut self, axis: V) {
        (self.lower, self.upper) = (Float::infinity(), Float::infinity());
        self.outcome = Outcome::Miss(Miss { axis });
    }

    /// Turns a hit at the source, as far as it was known, into one at `lambda`, before which a plane across `axis` leaves nothing to
    /// hit until `lower`.
    fn enter(&mut self, lambda: V::Scalar, lower: V::Scalar, axis: V) {
        self.lower = self.lower.max(lower);
        match &mut self.outcome {
            Outcome::Hit(hit) if lambda <= self.upper => {
                (hit.lambda, hit.normal) = (lambda.max(self.lower), Some(axis));
                self.upper = self.upper.max(hit.lambda);
            }
            // The ray runs along the target within rounding, and where it enters it, if ever, is not known.
            Outcome::Undecided => {}
            _ => (self.outcome, self.upper, self.status) = (Outcome::Undecided, Float::infinity(), Status::Stalled),
        }
    }
}
