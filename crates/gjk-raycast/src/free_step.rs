//! How far a body may go before its distance from another has to be asked for again.

use convex_support::numerics::bound::raised;
use convex_support::{Core, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::Distance;

/// Which changes of a body's pose certainly leave it farther from another body than a margin, without a further
/// question: those in which no point of it goes farther than [`room`](Self::room).
///
/// It is found by [`Distance::free_step`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FreeStep<S> {
    /// How far every point may go: the lower bound of the distance, less the margin; negative where there is no room.
    pub room: S,
    /// How far the points of the body are from the pivot, at most.
    pub reach: S,
}

impl<V: Vector> Distance<V> {
    /// For which changes of the pose of `a` it stays farther from `b` than a margin.
    ///
    /// A change turns `a` by an angle about any axis through the pivot, and moves it: no point goes farther than the
    /// way of the pivot and the angle times the point's distance from it. Along the normal of the plane that separates
    /// the bodies, nothing comes nearer by more. So one distance serves until a body has gone as far as it tells: a
    /// controller that asks at each of its steps mostly need not.
    ///
    /// ```
    /// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
    /// use gjk_raycast::{DistanceOptions, distance};
    ///
    /// let tool = Posed::translated(Cuboid::new(DVec3::new(0.3, 0.4, 1.2))?, DVec3::X * 5.0)?;
    /// let worker = Ball::new(1.0)?;
    /// let apart = distance(&tool, &worker, DistanceOptions::default()); // 3.7
    /// let step = apart.free_step(&tool, DVec3::X * 5.0, 0.5);
    /// // The tool reaches 1.3 from its middle. It may turn by one radian and go on by 1.8 …
    /// assert!(step.allows(1.8, 1.0));
    /// // … but not by 2, for all that is known.
    /// assert!(!step.allows(2.0, 1.0));
    /// assert!((step.way(1.0) - 1.9).abs() < 1e-12);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    ///
    /// If `b` moves too, its ways come off the same room. The answer must be that of these bodies, and `a` as it was
    /// asked about. If [`limit`](crate::DistanceOptions::limit) ended the question, the room is what was known by then.
    pub fn free_step<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        a: &A,
        pivot: V,
        margin: V::Scalar,
    ) -> FreeStep<V::Scalar> {
        let Core { origin, radius, extent, error, .. } = a.core();
        let (arm, epsilon) = ((origin - pivot).norm(), V::Scalar::EPSILON);
        let rounded = (origin.abs().max_element() + pivot.abs().max_element()) * epsilon * Scalar::from_f64(2.0);
        let room = self.lower - margin;
        // The difference is rounded once.
        FreeStep { room: room - raised(room.abs() * epsilon), reach: raised(arm + extent + radius + error + rounded) }
    }
}

impl<S: Scalar> FreeStep<S> {
    /// Whether the body stays farther away than the margin if its pivot goes by so much, and it turns about that by an
    /// angle. NaN is not allowed.
    #[must_use]
    pub fn allows(&self, way: S, angle: S) -> bool {
        raised(way.abs() + self.reach * angle.abs()) < self.room
    }

    /// How far the pivot may go if the body turns by an angle: negative where it may not turn so far.
    #[must_use]
    pub fn way(&self, angle: S) -> S {
        self.room - raised(self.reach * angle.abs())
    }
}
