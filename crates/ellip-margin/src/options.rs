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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MarginOptions {
    /// The relative error of ν to reach, as foreseen from the last step and the order of the method. The default, 1e-15,
    /// leaves nothing but rounding; the margin's own error is about the square of this.
    pub tolerance: f64,
    /// The largest number of steps; the default, 64, is several times what any pair has been seen to need.
    pub max_iterations: usize,
    /// How the equation is set up.
    pub method: Method,
}

/// How the secular equation is set up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Method {
    /// As a polynomial where that keeps its digits, which is where both bodies have moderate aspects, and in
    /// the singular basis elsewhere.
    #[default]
    Automatic,
    /// In the basis of singular vectors that makes both bodies round at once: full accuracy at any condition, at
    /// several times the cost. `Automatic` agrees with it to 1e-14 of 1 + m, and in ν to 1e-12 as a rule, 1e-11 at worst.
    SingularBasis,
}

impl Default for MarginOptions {
    fn default() -> Self {
        Self::new()
    }
}

impl MarginOptions {
    /// The default options.
    #[must_use]
    pub const fn new() -> Self {
        Self { tolerance: 1e-15, max_iterations: 64, method: Method::Automatic }
    }

    /// The same options with another [`tolerance`](Self::tolerance).
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// The same options with another [`max_iterations`](Self::max_iterations).
    #[must_use]
    pub const fn with_max_iterations(self, max_iterations: usize) -> Self {
        Self { max_iterations, ..self }
    }

    /// The same options with another [`method`](Self::method).
    #[must_use]
    pub const fn with_method(self, method: Method) -> Self {
        Self { method, ..self }
    }
}

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Status {
    /// The tolerance was met.
    Converged,
    /// The limit of steps was reached first: the answer is the best so far.
    IterationLimit,
    /// Steps stopped making progress before the tolerance was met, or numbers left the range of floating point: the
    /// answer is the best so far.
    Stalled,
}
