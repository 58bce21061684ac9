//! Whether an iteration still makes progress.

use convex_support::Scalar;

/// Steps without progress after which none is expected.
const MAX_STEPS_WITHOUT: u8 = 8;

/// Watches a quantity that decreases in every step in exact arithmetic, but only in most steps in rounded arithmetic.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress<S> {
    least: S,
    steps_left: u8,
}

impl<S: Scalar> Progress<S> {
    pub(crate) fn new() -> Self {
        Self { least: S::infinity(), steps_left: MAX_STEPS_WITHOUT }
    }

    /// Takes the next value. False if it is NaN, or after too many values in a row that are no less than an earlier
    /// one.
    pub(crate) fn goes_on(&mut self, value: S) -> bool {
        if value < self.least {
            *self = Self { least: value, steps_left: MAX_STEPS_WITHOUT };
            true
        } else {
            self.steps_left = self.steps_left.saturating_sub(1);
            self.steps_left > 0 && value >= self.least
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_ends_after_steps_without_a_gain_and_at_what_is_no_number() {
        let mut progress = Progress::new();
        assert!(progress.goes_on(2.0) && progress.goes_on(1.0));
        let steps = (0..100).take_while(|_| progress.goes_on(1.0)).count();
        assert_eq!(steps, usize::from(MAX_STEPS_WITHOUT) - 1);
        assert!(!Progress::new().goes_on(f64::NAN));
    }
}
