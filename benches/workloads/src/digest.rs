//! A fingerprint of a workload: equal digests mean equal inputs, down to the last bit.

/// The 64-bit FNV-1a hash of the numbers as little-endian `f64`.
#[must_use]
pub fn fnv1a(values: &[f64]) -> u64 {
    values
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}
