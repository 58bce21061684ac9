//! Whether an iteration still makes progress.

use convex_support::Scalar;

/// How many steps without progress are borne with.
const PATIENCE: u8 = 8;

/// Watches a quantity that decreases in exact arithmetic, in every step, but in rounded arithmetic only mostly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decrease<S> {
    least: S,
    patience: u8,
}

impl<S: Scalar> Decrease<S> {
    pub(crate) fn new() -> Self {
        Self { least: S::infinity(), patience: PATIENCE }
    }

    /// Takes the next value. False where it is NaN, and after too many values in a row that are no less than one before.
    pub(crate) fn goes_on(&mut self, value: S) -> bool {
        if value < self.least {
            *self = Self { least: value, patience: PATIENCE };
            true
        } else {
            self.patience = self.patience.saturating_sub(1);
            self.patience > 0 && value >= self.least
        }
    }
}
