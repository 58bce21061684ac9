//! What an observer of a motion cast is shown.

use convex_support::Vector;

/// What an observer of a motion cast is shown of every time that is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionIterate<V: Vector> {
    /// Counts from 0.
    pub iteration: usize,
    /// The time looked at.
    pub time: V::Scalar,
    /// By how much a plane certainly separates the bodies then; not positive where none is known.
    pub gap: V::Scalar,
    /// The unit normal of that plane, from `b` to `a`.
    pub normal: V,
    /// The bodies have no point in common up to this time.
    pub lower: V::Scalar,
    /// The bodies have a point in common at this time; infinite where none is known.
    pub upper: V::Scalar,
}
