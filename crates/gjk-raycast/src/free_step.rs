//! How far a body may go before its distance from another has to be asked for again.

use convex_support::numerics::bound::raised;
use convex_support::{Core, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::Distance;

/// The changes of a body's pose that certainly leave it farther from another body than a margin, without another
/// query: those in which no point of it goes farther than [`room`](Self::room).
///
/// [`Distance::free_step`] makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FreeStep<S> {
    /// How far every point may go: the lower bound of the distance, less the margin; negative if there is no room.
    pub room: S,
    /// The largest distance of the points of the body from the pivot.
    pub reach: S,
}

impl<V: Vector> Distance<V> {
    /// The changes of the pose of `a` that leave it farther from `b` than a margin.
    ///
    /// A change turns `a` by an angle about any axis through the pivot, and moves it. No point goes farther than the
    /// path of the pivot plus the angle times the point's distance from it. Along the normal of the plane that
    /// separates the bodies, no point comes nearer by more. So one distance serves until the body has gone as far as
    /// its room: most steps of a controller need no new query.
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
    /// If `b` moves too, subtract its path from the same room. The answer must be that of these bodies, with `a` in its
    /// pose of the query. If [`limit`](crate::DistanceOptions::limit) ended the query, the room is that of the lower
    /// bound found by then.
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
    /// Whether the body stays farther away than the margin if its pivot moves by this length, and it turns about the
    /// pivot by an angle. NaN is not allowed.
    #[must_use]
    pub fn allows(&self, way: S, angle: S) -> bool {
        raised(way.abs() + self.reach * angle.abs()) < self.room
    }

    /// How far the pivot may go if the body turns by an angle; negative if it may not turn so far.
    #[must_use]
    pub fn way(&self, angle: S) -> S {
        self.room - raised(self.reach * angle.abs())
    }
}
