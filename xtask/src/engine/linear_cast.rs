//! `linear_cast`.

use convex_support::Vector;
use gjk_raycast::{LinearCastOptions, LinearHit, Motion, linear_cast, linear_cast_certificate};

use super::cast::{self, problem};
use super::gradient::{self, Gradient};
use super::{Ask, How, Query, Question, certificate, scalar};
use crate::wire::answer::Answer;
use crate::wire::error::Problem;
use crate::wire::fields::{Coordinates, Fields};
use crate::wire::shape::{Shape, Solid, Space, vector};

/// The query as written.
pub(super) struct LinearCast {
    a: Shape,
    b: Shape,
    velocity_a: Coordinates,
    velocity_b: Coordinates,
    max_time: Option<f64>,
    gradient: bool,
}

impl Query for LinearCast {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            a: Shape::read(&fields.within("a")?)?,
            b: Shape::read(&fields.within("b")?)?,
            velocity_a: fields.vector_or_zero("velocity_a")?,
            velocity_b: fields.vector_or_zero("velocity_b")?,
            max_time: fields.maybe("max_time")?,
            gradient: gradient::is_wanted(fields)?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let mut options = LinearCastOptions::new();
        if let Some(max_time) = self.max_time {
            options = options.with_max_time(scalar::<V>(max_time));
        }
        if let Some(tolerance) = how.tolerance::<V>()? {
            options = options.with_tolerance(tolerance);
        }
        Ok(Box::new(Cast::<V> {
            a: self.a.build("a", how.meshes)?,
            b: self.b.build("b", how.meshes)?,
            motion: Motion { velocity_a: vector(&self.velocity_a), velocity_b: vector(&self.velocity_b) },
            gradient: self.gradient,
            options,
        }))
    }
}

struct Cast<V: Vector> {
    a: Solid<V>,
    b: Solid<V>,
    motion: Motion<V>,
    gradient: bool,
    options: LinearCastOptions<V>,
}

impl<V: Space> Question for Cast<V> {
    type Solution = (gjk_raycast::LinearCast<V>, Option<Gradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let cast = linear_cast(&self.a, &self.b, self.motion, self.options).map_err(problem)?;
        let hit = if self.gradient { cast.outcome.hit() } else { None };
        Ok((cast, hit.map(|hit| self.gradient_of(hit))))
    }

    fn certificate(&self, (cast, _): &Self::Solution) -> Option<Answer> {
        Some(certificate(linear_cast_certificate(&self.a, &self.b, self.motion, cast)))
    }

    fn answer(&self, (cast, gradient): Self::Solution) -> Result<Answer, Problem> {
        let show = |hit: LinearHit<V>| (hit.time, hit.point, hit.normal);
        let answer = cast::answer("time", cast.outcome, show, [cast.lower, cast.upper], cast.status, cast.iterations)?;
        Ok(gradient::with(answer, gradient))
    }
}

impl<V: Space> Cast<V> {
    /// The derivatives of the time of a hit.
    fn gradient_of(&self, hit: LinearHit<V>) -> Gradient<V> {
        let features = hit.closest_features(&self.a, &self.b, self.motion);
        let smooth = features.and_then(|features| {
            let gradient = hit.refined(&features).gradient(self.motion)?;
            Some(Gradient::new(gradient.pose_a, gradient.pose_b, features.smoothness()))
        });
        smooth.unwrap_or_else(|| Gradient::at_floor(&self.a, &self.b))
    }
}
