//! The options of both problems, and how a computation ended.

use crate::error::{EnclosingError, InscribedError};

/// How a computation ended. The certified gap beside it says how good the answer is in every case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Status {
    /// The certified gap is at most the `epsilon` asked for.
    Converged,
    /// The iterations allowed were used up; the best ellipsoid found is returned with its gap.
    IterationLimit,
    /// Rounding allows no smaller gap; the ellipsoid is as good as `f64` can make it, and the gap says how good that
    /// is.
    Stalled,
}

/// Which algorithm computes the enclosing ellipsoid. All of them end with the same certificate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum EnclosingMethod {
    /// Newton's method on a small working set of points, grown by the worst violators of full scans. A handful of scans
    /// reaches rounding whatever the data.
    #[default]
    Newton,
    /// The first-order method of Khachiyan with the away steps of Todd and Yıldırım: one weight moves per iteration.
    /// Linear convergence; thousands of iterations are common.
    Khachiyan,
    /// The ellipsoid algorithm on the lifted problem, as Rimon and Boyd give it (corrected): iterations grow with
    /// log(1/ε), each costs one pass over all points.
    EllipsoidAlgorithm,
    /// The dual reduced Newton method of Sun and Freund on the working set; an interior-point path in place of the
    /// active set of [`Newton`](Self::Newton).
    DualReducedNewton,
}

/// What to do with points that span no volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FlatPolicy {
    /// An error: [`EnclosingError::Flat`](crate::EnclosingError::Flat).
    #[default]
    Error,
    /// The ellipsoid within the affine hull: a disc, a segment or a point, with semi-axes of length 0 across it.
    AffineHull,
}

/// Options of [`enclosing`](crate::enclosing()).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct EnclosingOptions {
    /// The certified gap on ln det X to reach (twice the gap on the log-volume), a positive number. Default 1e-9;
    /// rounding usually allows 1e-13.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::data::epsilon"))]
    pub epsilon: f64,
    /// The algorithm. Default [`EnclosingMethod::Newton`].
    pub method: EnclosingMethod,
    /// The most iterations of the algorithm. Default `None`, a number that suits the method: 2,000 Newton steps, one
    /// million moves of a weight, 200,000 cuts.
    pub max_iterations: Option<usize>,
    /// What to do with points that span no volume. Default: an error.
    pub flat: FlatPolicy,
    /// Points whose spread across some direction is at most this fraction of their extent count as flat. In any case, a
    /// spread within 32 units in the last place of the coordinates is flat, since it is rounding of the points. Not
    /// negative. Default 0.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::data::flat_tolerance"))]
    pub flat_tolerance: f64,
}

impl EnclosingOptions {
    /// The default options.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            epsilon: 1e-9,
            method: EnclosingMethod::Newton,
            max_iterations: None,
            flat: FlatPolicy::Error,
            flat_tolerance: 0.0,
        }
    }

    /// With this certified gap on ln det X to reach.
    #[must_use]
    pub const fn with_epsilon(self, epsilon: f64) -> Self {
        Self { epsilon, ..self }
    }

    /// With this algorithm.
    #[must_use]
    pub const fn with_method(self, method: EnclosingMethod) -> Self {
        Self { method, ..self }
    }

    /// With at most this many iterations.
    #[must_use]
    pub const fn with_max_iterations(self, max_iterations: usize) -> Self {
        Self { max_iterations: Some(max_iterations), ..self }
    }

    /// With this treatment of points that span no volume.
    #[must_use]
    pub const fn with_flat(self, flat: FlatPolicy) -> Self {
        Self { flat, ..self }
    }

    /// With points counted as flat up to this fraction of their extent.
    #[must_use]
    pub const fn with_flat_tolerance(self, flat_tolerance: f64) -> Self {
        Self { flat_tolerance, ..self }
    }

    /// Whether every number is in its range; NaN is in none.
    pub(crate) fn check(&self) -> Result<(), EnclosingError> {
        if !(self.epsilon > 0.0) {
            return Err(EnclosingError::InvalidEpsilon { value: self.epsilon });
        }
        if !(self.flat_tolerance >= 0.0) {
            return Err(EnclosingError::InvalidFlatTolerance { value: self.flat_tolerance });
        }
        Ok(())
    }
}

impl Default for EnclosingOptions {
    fn default() -> Self {
        Self::new()
    }
}

/// Options of [`inscribed`](crate::inscribed()).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct InscribedOptions {
    /// The certified gap on ln det X to reach (twice the gap on the log-volume), a positive number. Default 1e-9.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::data::epsilon"))]
    pub epsilon: f64,
    /// The most Newton steps. Default 200.
    pub max_iterations: usize,
}

impl InscribedOptions {
    /// The default options.
    #[must_use]
    pub const fn new() -> Self {
        Self { epsilon: 1e-9, max_iterations: 200 }
    }

    /// With this certified gap on ln det X to reach.
    #[must_use]
    pub const fn with_epsilon(self, epsilon: f64) -> Self {
        Self { epsilon, ..self }
    }

    /// With at most this many Newton steps.
    #[must_use]
    pub const fn with_max_iterations(self, max_iterations: usize) -> Self {
        Self { max_iterations, ..self }
    }

    /// Whether every number is in its range; NaN is in none.
    pub(crate) fn check(&self) -> Result<(), InscribedError> {
        if self.epsilon > 0.0 { Ok(()) } else { Err(InscribedError::InvalidEpsilon { value: self.epsilon }) }
    }
}

impl Default for InscribedOptions {
    fn default() -> Self {
        Self::new()
    }
}
