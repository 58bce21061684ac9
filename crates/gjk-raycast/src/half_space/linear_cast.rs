//! When a shape that moves at constant velocity meets a half-space.

use convex_support::{Scalar, SupportMap, Vector};
use num_traits::Float as _;

use super::HalfSpace;
use super::plane::Lowest;
use super::ray_cast::Landing;
use crate::{Impact, LinearCast, LinearCastOptions, Miss, Motion, Outcome, RayCastError, StartInContact, Status};

impl<V: Vector> HalfSpace<V> {
    /// When a moving shape, `a`, first touches the half-space, `b`: the ray of its lowest point.
    ///
    /// # Errors
    /// As of [`linear_cast`](crate::linear_cast()).
    pub fn linear_cast<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<V>,
        options: LinearCastOptions<V>,
    ) -> Result<LinearCast<V>, RayCastError> {
        motion.check(&options)?;
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        let plane = self.plane();
        let Lowest { height, point } = plane.lowest(shape, options.target_distance.max(zero));
        let sinking = plane.sinking([motion.velocity_a, -motion.velocity_b]);
        let goes_deeper = options.start_in_contact == StartInContact::IfDeeper;
        if goes_deeper && height.least() <= zero && !(sinking.most() > zero) {
            let outcome = Outcome::Miss(Miss { axis: plane.unit });
            let (lower, upper, status) = (infinity, infinity, Status::Converged);
            return Ok(LinearCast { outcome, lower, upper, status, iterations: 1 });
        }
        let Landing { outcome, lower, upper, status } = plane.crossing(height, sinking, options.max_time);
        let has_normal = height.most() >= zero || goes_deeper;
        let outcome = match outcome {
            Outcome::Hit(time) => Outcome::Hit(Impact {
                time,
                // Of a target distance, the point of the half-space below.
                point: point + motion.velocity_a * time,
                normal: (time > zero || has_normal).then_some(plane.unit),
            }),
            Outcome::Miss(miss) => Outcome::Miss(miss),
            Outcome::Undecided => Outcome::Undecided,
        };
        Ok(LinearCast { outcome, lower, upper, status, iterations: 1 })
    }
}
