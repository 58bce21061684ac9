//! Sums of products in twice the working precision.
//!
//! What a thin body is made of are small differences of large products, and they decide its shape. They are computed as if in
//! a format of 106 bits and rounded once.
//!
//! # References
//! T. J. Dekker, *A floating-point technique for extending the available precision*, Numer. Math. 18 (1971).
//! T. Ogita, S. M. Rump, S. Oishi, *Accurate sum and dot product*, SIAM J. Sci. Comput. 26 (2005), algorithm Dot2.

/// Σxᵢyᵢ with an error of at most u·|Σxᵢyᵢ| + (k·u)²·Σ|xᵢyᵢ| for k terms, where no product leaves the range of `f64`; there
/// it is the plain sum.
pub(crate) fn dot(terms: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let (mut sum, mut rest) = (0.0, 0.0);
    for (x, y) in terms {
        let (product, product_error) = two_product(x, y);
        let (next, sum_error) = two_sum(sum, product);
        sum = next;
        rest += product_error + sum_error;
    }
    let total = sum + rest;
    // Splitting a factor above 2⁹⁹⁶ overflows: what is lost is the correction.
    if total.is_nan() { sum } else { total }
}

/// a + b as the rounded sum and its error, which is a number too (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let from_b = sum - a;
    (sum, (a - (sum - from_b)) + (b - from_b))
}

/// a·b as the rounded product and its error, which is a number too where nothing underflows (Dekker).
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
    use super::dot;

    #[test]
    fn cancellation_leaves_the_small_difference() {
        // (1 + 2⁻³⁰)² − 1 − 2⁻²⁹ = 2⁻⁶⁰, of which plain arithmetic sees nothing.
        let a = 1.0 + 2f64.powi(-30);
        assert_eq!(dot([(a, a), (-1.0, 1.0), (-1.0, 2f64.powi(-29))]), 2f64.powi(-60));
        assert_eq!(a * a - 1.0 - 2f64.powi(-29), 0.0);
    }

    #[test]
    fn far_numbers_are_still_summed() {
        assert_eq!(dot([(1e300, 1.0), (-1e300, 1.0), (1.0, 3.0)]), 3.0);
        assert_eq!(dot([(1e308, 1.0)]), 1e308);
        assert!(dot([(f64::NAN, 1.0)]).is_nan(), "NaN stays NaN");
    }
}
