//! The weights and multipliers that prove a gap.

/// The weight of a point, or the multiplier of a half-space, in the certificate of a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Weight {
    /// The index of the point or half-space.
    pub index: usize,
    /// Its weight, positive; the weights sum to one up to rounding.
    pub weight: f64,
}
