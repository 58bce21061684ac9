//! A length along a normal, or a speed, with a bound on its error.

use convex_support::Scalar;

/// A measured length along a normal, or a speed along it, and a bound on its error.
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
