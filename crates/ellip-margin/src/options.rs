//! How a margin is asked for, and how the answer ended.

/// What [`free_margin`](crate::free_margin) may spend.
///
/// ```
/// use ellip_margin::MarginOptions;
///
/// let quick = MarginOptions::default().with_tolerance(1e-3);
/// assert_eq!(quick.max_iterations, MarginOptions::default().max_iterations);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MarginOptions {
    /// The iteration ends with the step that changes ν by less than this fraction of itself. Newton's method squares
    /// the error: 1e-8, the default, leaves nothing but rounding.
    pub tolerance: f64,
    /// The largest number of steps; the default, 64, is several times what any pair has been seen to need.
    pub max_iterations: u32,
}

impl Default for MarginOptions {
    fn default() -> Self {
        Self { tolerance: 1e-8, max_iterations: 64 }
    }
}

impl MarginOptions {
    /// The same options with another [`tolerance`](Self::tolerance).
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// The same options with another [`max_iterations`](Self::max_iterations).
    #[must_use]
    pub const fn with_max_iterations(self, max_iterations: u32) -> Self {
        Self { max_iterations, ..self }
    }
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// The tolerance was met.
    Converged,
    /// The limit of steps was reached first: the answer is the best so far.
    IterationLimit,
    /// Steps stopped making progress before the tolerance was met, or numbers left the range of floating point: the
    /// answer is the best so far.
    Stalled,
}
