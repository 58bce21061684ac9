//! `linear_cast`.

use convex_support::Vector;
use gjk_raycast::{LinearCastOptions, LinearHit, Motion, linear_cast};

use super::cast::{self, problem};
use super::{Ask, How, Query, Question, scalar};
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
}

impl Query for LinearCast {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            a: Shape::read(&fields.within("a")?)?,
            b: Shape::read(&fields.within("b")?)?,
            velocity_a: fields.vector_or_zero("velocity_a")?,
            velocity_b: fields.vector_or_zero("velocity_b")?,
            max_time: fields.maybe("max_time")?,
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
            options,
        }))
    }
}

struct Cast<V: Vector> {
    a: Solid<V>,
    b: Solid<V>,
    motion: Motion<V>,
    options: LinearCastOptions<V>,
}

impl<V: Space> Question for Cast<V> {
    type Solution = gjk_raycast::LinearCast<V>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        linear_cast(&self.a, &self.b, self.motion, self.options).map_err(problem)
    }

    fn answer(&self, cast: Self::Solution) -> Result<Answer, Problem> {
        let show = |hit: LinearHit<V>| (hit.time, hit.point, hit.normal);
        cast::answer("time", cast.outcome, show, [cast.lower, cast.upper], cast.status, cast.iterations)
    }
}
