//! The options of a margin, and how its iteration ended.

use crate::InvalidQuery;

/// The options of [`free_margin`](crate::free_margin).
///
/// ```
/// use ellip_margin::MarginOptions;
///
/// let quick = MarginOptions::default().with_tolerance(1e-3)?;
/// assert_eq!(
///     (quick.tolerance(), quick.max_iterations),
///     (1e-3, MarginOptions::default().max_iterations)
/// );
/// assert!(MarginOptions::default().with_tolerance(f64::NAN).is_err());
/// # Ok::<(), ellip_margin::InvalidQuery>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct MarginOptions {
    /// Positive and finite.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "checked"))]
    tolerance: f64,
    /// The largest number of steps; the default, 64, is several times the most that any pair has needed.
    pub max_iterations: usize,
    /// The form of the secular equation.
    pub method: Method,
}

/// The form of the secular equation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Method {
    /// As a polynomial where it keeps its digits, which is where both bodies have moderate aspects, and in the singular
    /// basis elsewhere.
    #[default]
    Automatic,
    /// In the basis of singular vectors that makes both bodies round at once: full accuracy at any condition, at
    /// several times the cost. `Automatic` agrees with it to 1e-14 of 1 + m, and in ν to 1e-12 as a rule, 1e-11 at
    /// worst.
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

    /// The relative error of ν to reach, as predicted from the last step and the order of the method. The
    /// default, 1e-15, leaves nothing but rounding; the margin's own error is about the square of this.
    #[must_use]
    pub const fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The same options with another [`tolerance`](Self::tolerance).
    ///
    /// # Errors
    /// [`InvalidQuery::Tolerance`] unless it is positive and finite.
    pub const fn with_tolerance(self, tolerance: f64) -> Result<Self, InvalidQuery> {
        match check(tolerance) {
            Ok(tolerance) => Ok(Self { tolerance, ..self }),
            Err(why) => Err(why),
        }
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

/// `tolerance`, if it is positive and finite.
pub(crate) const fn check(tolerance: f64) -> Result<f64, InvalidQuery> {
    if tolerance > 0.0 && tolerance < f64::INFINITY { Ok(tolerance) } else { Err(InvalidQuery::Tolerance(tolerance)) }
}

/// A tolerance read from data.
#[cfg(feature = "serde")]
fn checked<'de, D: serde::Deserializer<'de>>(data: D) -> Result<f64, D::Error> {
    let tolerance = serde::Deserialize::deserialize(data)?;
    check(tolerance).map_err(serde::de::Error::custom)
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
