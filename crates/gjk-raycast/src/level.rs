//! A length along a normal, or a speed, and how well it is known.

use convex_support::Scalar;

/// A length along a normal, or a speed along it, as it is measured, and what that is wrong by at most.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level<S> {
    pub(crate) value: S,
    pub(crate) error: S,
}

impl<S: Scalar> Level<S> {
    pub(crate) fn least(&self) -> S {
        self.value - self.error
    }

    pub(crate) fn most(&self) -> S {
        self.value + self.error
    }
}
