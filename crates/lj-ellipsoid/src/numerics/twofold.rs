//! Sums of products in twice the working precision.
//!
//! Small differences of large products decide the shape of a thin body. They are computed as if in a format of 106 bits
//! and rounded once.
//!
//! # References
//! T. J. Dekker, *A floating-point technique for extending the available precision*, Numer. Math. 18 (1971).
//! T. Ogita, S. M. Rump, S. Oishi, *Accurate sum and dot product*, SIAM J. Sci. Comput. 26 (2005), algorithm Dot2.

use std::ops::RangeInclusive;

use crate::numerics::linalg::UNIT_ROUNDOFF;

/// Σxᵢyᵢ with an error of at most u·|Σxᵢyᵢ| + (k·u)²·Σ|xᵢyᵢ| for k terms, if no product leaves the range of `f64`;
/// otherwise it is the plain sum.
pub(crate) fn dot(terms: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let mut sum = Sum::default();
    terms.into_iter().for_each(|(x, y)| sum.add_product(x, y));
    sum.total()
}

/// [`dot`] and a bound on its error that holds in the whole range of `f64`: products that underflow lose less than the
/// smallest normal number each, and if the correction overflowed the bound is that of the plain sum.
pub(crate) fn dot_with_error(terms: impl IntoIterator<Item = (f64, f64)>) -> (f64, f64) {
    let (mut sum, mut size, mut count) = (Sum::default(), 0.0, 0.0);
    for (x, y) in terms {
        sum.add_product(x, y);
        size += (x * y).abs();
        count += 1.0;
    }
    let (total, lost) = (sum.total(), count * UNIT_ROUNDOFF);
    // Twice the proved bound, for the rounding of the bound itself.
    let of_terms = if sum.is_corrected() { lost * lost } else { lost };
    (total, 2.0 * (UNIT_ROUNDOFF * total.abs() + of_terms * size + count * f64::MIN_POSITIVE))
}

/// Whether Σxᵢyᵢ ≤ 0, exactly: if the bound on the error does not decide, the products are summed without error. False
/// also if a product leaves the range in which its error is a number.
pub(crate) fn is_at_most_zero(terms: impl Iterator<Item = (f64, f64)> + Clone) -> bool {
    const EXACT: RangeInclusive<f64> = 1e-280..=1e280;
    let (total, error) = dot_with_error(terms.clone());
    if total.abs() > error {
        return total < 0.0;
    }
    // Numbers of ascending size that do not overlap (Shewchuk's expansion): the last that is not zero has the sign of
    // the sum.
    let mut expansion: Vec<f64> = Vec::new();
    for (x, y) in terms.filter(|(x, y)| *x != 0.0 && *y != 0.0) {
        let (product, lost) = two_product(x, y);
        if !(EXACT.contains(&product.abs()) && EXACT.contains(&x.abs()) && EXACT.contains(&y.abs())) {
            return false;
        }
        for mut sum in [lost, product] {
            for part in &mut expansion {
                (sum, *part) = two_sum(sum, *part);
            }
            expansion.push(sum);
        }
    }
    expansion.iter().rfind(|x| **x != 0.0).is_none_or(|x| *x < 0.0)
}

/// A sum in twice the precision: the rounded sum, and the sum of the errors of its additions and products.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum {
    sum: f64,
    rest: f64,
}

impl Sum {
    pub(crate) fn add(&mut self, x: f64) {
        let (next, lost) = two_sum(self.sum, x);
        self.sum = next;
        self.rest += lost;
    }

    pub(crate) fn add_product(&mut self, x: f64, y: f64) {
        let (product, lost) = two_product(x, y);
        self.add(product);
        self.rest += lost;
    }

    /// The sum rounded once.
    pub(crate) fn total(&self) -> f64 {
        // Splitting a factor above 2⁹⁹⁶ overflows: then there is no correction.
        if self.is_corrected() { self.sum + self.rest } else { self.sum }
    }

    fn is_corrected(&self) -> bool {
        !self.rest.is_nan()
    }
}

/// a + b as the rounded sum and its error, which is a number too (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let from_b = sum - a;
    (sum, (a - (sum - from_b)) + (b - from_b))
}

/// a·b as the rounded product and its error, which is a number too if nothing underflows (Dekker).
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    (product, a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low))
}

/// a as the sum of two numbers of at most 26 bits each (Veltkamp).
fn split(a: f64) -> (f64, f64) {
    let scaled = 134_217_729.0 * a; // 2²⁷ + 1
    let high = scaled - (scaled - a);
    (high, a - high)
}

#[cfg(test)]
mod tests {
    use super::{dot, is_at_most_zero};

    #[test]
    fn cancellation_leaves_the_small_difference() {
        // (1 + 2⁻³⁰)² − 1 − 2⁻²⁹ = 2⁻⁶⁰, which plain arithmetic loses.
        let a = 1.0 + 2f64.powi(-30);
        assert_eq!(dot([(a, a), (-1.0, 1.0), (-1.0, 2f64.powi(-29))]), 2f64.powi(-60));
        assert_eq!(a * a - 1.0 - 2f64.powi(-29), 0.0);
    }

    #[test]
    fn signs_are_exact() {
        // (1 + ε)(1 − ε) − 1 = −ε², and with 2ε² more it is ε².
        let e = 2f64.powi(-52);
        let square = [(1.0 + e, 1.0 - e), (-1.0, 1.0)];
        assert!(is_at_most_zero(square.into_iter()));
        assert!(!is_at_most_zero(square.into_iter().chain([(e, 2.0 * e)])));
        assert!(is_at_most_zero(square.into_iter().chain([(e, e)])), "zero");
        assert!(!is_at_most_zero([(f64::NAN, 1.0)].into_iter()));
    }

    #[test]
    fn far_numbers_are_still_summed() {
        assert_eq!(dot([(1e300, 1.0), (-1e300, 1.0), (1.0, 3.0)]), 3.0);
        assert_eq!(dot([(1e308, 1.0)]), 1e308);
        assert!(dot([(f64::NAN, 1.0)]).is_nan(), "NaN stays NaN");
    }
}
