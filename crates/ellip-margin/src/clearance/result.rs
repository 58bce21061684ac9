//! The answers of a clearance.

use convex_support::Vector;

use crate::Margin;

/// The least margin over all pairs of a link and an obstacle, and the numbers of pairs that were left out.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub struct ClearanceResult<V: Vector> {
    /// The margin of the pair with the least one, E₁ being the link; among equal ones the first by link, then obstacle.
    pub margin: Margin<V>,
    /// The index of its link.
    pub link: usize,
    /// The index of its obstacle.
    pub obstacle: usize,
    /// The number of pairs that were solved.
    pub pairs_evaluated: usize,
    /// The numbers of the other pairs, by the reason why they cannot be the least.
    pub left_out: LeftOut,
}

/// Pairs that needed no margin, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LeftOut {
    /// The link has moved too little since its margins were last bounded.
    pub by_motion: usize,
    /// A box around the obstacle, or around a group of them, is too far from the link in the norm of the link.
    pub by_box: usize,
    /// A ball around the obstacle is too far from the ball around the grown link.
    pub by_sphere: usize,
    /// A plane across the line of centres separates the obstacle from the grown link.
    pub by_plane: usize,
    /// A plane across the normal at which the link was nearest to the obstacle when the two were last solved separates
    /// them.
    pub by_normal: usize,
}

impl LeftOut {
    /// All of them.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.by_motion + self.by_box + self.by_sphere + self.by_plane + self.by_normal
    }
}

/// A pair within a threshold; see [`Clearance::within`](super::Clearance::within).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub struct NearPair<V: Vector> {
    /// The margin, E₁ being the link.
    pub margin: Margin<V>,
    /// The index of the link.
    pub link: usize,
    /// The index of the obstacle.
    pub obstacle: usize,
}
