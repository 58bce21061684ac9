//! A shape swept by a ball.

use crate::error::{InvalidShape, non_negative};
use num_traits::Float as _;

use crate::line_crossing::crossed_by_line::closely;
use crate::numerics::twofold::two_sum;
use crate::support::{ScalarOf, support_of_parts};
use crate::{
    CertainCrossing, Close, CloseLine, Core, CrossedByLine, Feature, Hint, LineCrossing, LineQuery, Parallelotope,
    Rounding, SupportMap,
};

/// The Minkowski sum of a shape and a ball: the shape grown by a radius, its edges and corners rounded.
///
/// The radius is kept apart from the core, so that rounding costs the algorithms nothing.
///
/// ```
/// use convex_support::{Rounded, SupportMap, Triangle, glam::DVec2};
///
/// let triangle = Triangle::new([DVec2::ZERO, DVec2::X, DVec2::Y])?;
/// assert_eq!(Rounded::new(triangle, 0.5)?.support(DVec2::X), DVec2::new(1.5, 0.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[doc(alias("inflate", "offset", "margin", "skin", "padding"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded<S: SupportMap> {
    shape: S,
    radius: ScalarOf<S>,
}

impl<S: SupportMap> Rounded<S> {
    /// The shape swept by a ball of the given radius, which may be 0.
    ///
    /// # Errors
    /// [`InvalidShape`] if the radius is negative or not finite.
    pub fn new(shape: S, radius: ScalarOf<S>) -> Result<Self, InvalidShape> {
        Ok(Self { shape, radius: non_negative("radius", radius)? })
    }

    /// The shape before it is rounded.
    #[must_use]
    pub const fn shape(&self) -> &S {
        &self.shape
    }

    /// The radius of the ball that is added to the shape, which may have a [radius](Core::radius) of its own.
    #[must_use]
    pub fn radius(&self) -> ScalarOf<S> {
        self.radius
    }
}

impl<S: SupportMap> SupportMap for Rounded<S> {
    type Vector = S::Vector;

    #[inline]
    fn support(&self, direction: S::Vector) -> S::Vector {
        support_of_parts(self, direction)
    }

    #[inline(always)]
    fn core(&self) -> Core<S::Vector> {
        self.shape.core().rounded(self.radius)
    }

    #[inline(always)]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        self.shape.core_support(direction, hint)
    }

    #[inline(always)]
    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        self.shape.core_support_hessian(direction, changes)
    }

    #[inline(always)]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        self.shape.core_closest_point(x)
    }

    /// The rounding of the shape; the sum of the radii is rounded, unless one is zero.
    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<S::Vector>) -> Option<CertainCrossing<S::Vector>> {
        if line.is_close {
            return closely(self, line);
        }
        self.shape.certain_crossing(line.sweeping(self.radius))
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        self.shape.close_crossing(&line.sweeping(self.radius))
    }

    fn core_support_feature(&self, direction: S::Vector, slab: ScalarOf<S>, feature: &mut Feature<S::Vector>) {
        self.shape.core_support_feature(direction, slab, feature);
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<S::Vector>> {
        self.shape.core_parallelotope()
    }

    /// The rounding of the shape; the sum of the radii is rounded.
    fn rounding(&self) -> Rounding<S::Vector> {
        let [_, lost] = two_sum(self.shape.core().radius, self.radius);
        self.shape.rounding().with_radius_error(lost.abs())
    }
}

impl<S: CrossedByLine> CrossedByLine for Rounded<S> {
    #[inline(always)]
    fn core_line_crossing(
        &self,
        source: S::Vector,
        direction: S::Vector,
        radius: ScalarOf<S>,
    ) -> LineCrossing<S::Vector> {
        self.shape.core_line_crossing(source, direction, radius)
    }
}
