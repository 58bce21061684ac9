//! The configuration space obstacle of two shapes.

use super::MinkowskiSum;
use super::reflected::Reflected;
use crate::forward::{forward, forward_line_crossing};
use crate::{CrossedByLine, SupportMap};

/// The set of all differences of a point of one shape and a point of another: their configuration space obstacle
/// (CSO).
///
/// In symbols, it is `A − B = { a − b : a ∈ A, b ∈ B }`. Two shapes meet exactly if their difference contains zero;
/// their distance is its distance from zero; and the translations of `B` that make it touch `A` are the boundary of
/// the difference. So one moving shape against another becomes one ray against their difference.
///
/// ```
/// use convex_support::{Ball, Cuboid, Difference, glam::DVec3, support_value};
///
/// let cso = Difference::new(Cuboid::new(DVec3::ONE)?, Ball::new(0.5)?);
/// assert_eq!(support_value(&cso, DVec3::X), 1.5);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[doc(alias("minkowski_difference", "configuration_space_obstacle", "cso"))]
#[doc = include_str!("../../doc/cso.svg")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference<A: SupportMap, B>(MinkowskiSum<A, Reflected<B>>);

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> Difference<A, B> {
    /// The difference of the two shapes.
    pub fn new(a: A, b: B) -> Self {
        Self(MinkowskiSum::new(a, Reflected(b)))
    }

    /// The first shape.
    #[must_use]
    pub const fn a(&self) -> &A {
        self.0.a()
    }

    /// The second shape.
    #[must_use]
    pub const fn b(&self) -> &B {
        &self.0.b().0
    }
}

forward!([A: SupportMap, B: SupportMap<Vector = A::Vector>] Difference<A, B> as A::Vector, |difference| difference.0);
forward_line_crossing!(
    [A: CrossedByLine, B: CrossedByLine<Vector = A::Vector>] Difference<A, B> as A::Vector, |difference| difference.0
);
