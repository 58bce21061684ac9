//! The derivative of a time of contact by the pose of a body there.

use convex_support::{MotionGradient, Scalar, Vector};

/// The force `−n/(n·w)` at a point of contact, of which a displacement of the body on the normal's side puts off the
/// hit; `w` is the velocity there as seen from the other body. `None` where the two do not approach one another.
pub(super) fn at_contact<V: Vector>(normal: Option<V>, velocity: V, point: V) -> Option<MotionGradient<V>> {
    let closing = -normal?.dot(velocity);
    let force = normal? / closing;
    // Also where the quotient overflows, or something is NaN.
    (closing > V::Scalar::ZERO && force.is_finite()).then_some(MotionGradient::force(force, point))
}
