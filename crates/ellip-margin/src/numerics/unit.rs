//! A unit of length in which no number leaves the range.

/// The greatest power of two that is at most `size`, or the nearest to it whose inverse is a normal number.
///
/// Lengths divided by it keep all their bits, so that results computed from them do not depend on the original unit.
#[inline]
pub(crate) fn power_of_two_near(size: f64) -> f64 {
    const BIAS: u64 = 1023;
    let exponent = size.abs().to_bits() >> (f64::MANTISSA_DIGITS - 1);
    f64::from_bits(exponent.clamp(BIAS - 1000, BIAS + 1000) << (f64::MANTISSA_DIGITS - 1))
}

#[cfg(test)]
mod tests {
    use super::power_of_two_near;

    #[test]
    fn powers_of_two() {
        let cases = [(1.0, 1.0), (1.9, 1.0), (3e-5, 2f64.powi(-16)), (-5.0, 4.0), (f64::MAX, 2f64.powi(1000))];
        for (size, unit) in cases {
            assert_eq!(power_of_two_near(size), unit, "near {size}");
        }
        assert_eq!(power_of_two_near(0.0), 2f64.powi(-1000), "none is near 0, and its inverse is a normal number");
    }
}
