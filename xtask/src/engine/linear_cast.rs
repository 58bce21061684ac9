//! `linear_cast`.

use convex_support::Vector;
use gjk_raycast::laws::{self, Numbers, PairPlanes, Report};
use gjk_raycast::{Body, Impact, LinearCastOptions, Motion, linear_cast, linear_cast_certificate};

use super::cast::{self, Limits, problem};
use super::gradient::{self, Gradient};
use super::pair::Bodies;
use super::{Ask, How, Query, Question, certificate, directions};
use crate::wire::answer::Answer;
use crate::wire::error::Problem;
use crate::wire::fields::{Coordinates, Fields};
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space, vector};

/// The query as written.
pub(super) struct LinearCast {
    bodies: Bodies,
    velocity_a: Coordinates,
    velocity_b: Coordinates,
    limits: Limits,
    gradient: bool,
}

impl Query for LinearCast {
    const FIELDS: Names =
        &["a", "b", "velocity_a", "velocity_b", "max_time", "target_distance", "start_in_contact", "gradient"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let bodies = Bodies::read(fields)?;
        Ok(Self {
            velocity_a: fields.vector_or_zero("velocity_a")?,
            velocity_b: fields.vector_or_zero("velocity_b")?,
            limits: Limits::read(fields)?,
            gradient: bodies.gradient(fields)?,
            bodies,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let (a, b) = self.bodies.build(how)?;
        let motion = Motion { velocity_a: vector(&self.velocity_a), velocity_b: vector(&self.velocity_b) };
        Ok(Box::new(Cast::<V> { a, b, motion, gradient: self.gradient, options: self.limits.linear(how)? }))
    }
}

struct Cast<V: Vector> {
    a: Solid<V>,
    b: Body<Solid<V>>,
    motion: Motion<V>,
    gradient: bool,
    options: LinearCastOptions<V>,
}

impl<V: Space> Question for Cast<V> {
    type Solution = (gjk_raycast::LinearCast<V>, Option<Gradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let cast = match &self.b {
            Body::Convex(b) => linear_cast(&self.a, b, self.motion, self.options),
            Body::HalfSpace(half_space) => half_space.linear_cast(&self.a, self.motion, self.options),
        }
        .map_err(problem)?;
        let [motion_a, motion_b] = self.motion.translations();
        let hit = if self.gradient { cast.outcome.hit() } else { None };
        Ok((
            cast,
            hit.and_then(|hit| Some(Gradient::of_impact(hit, (&self.a, &motion_a), (self.b.convex()?, &motion_b)))),
        ))
    }

    fn certificate(&self, (cast, _): &Self::Solution) -> Option<Answer> {
        self.b.convex().map(|b| certificate(linear_cast_certificate(&self.a, b, self.motion, cast)))
    }

    /// The derivatives by the velocities too.
    fn beside(&self, (cast, _): &Self::Solution) -> String {
        let derivatives = cast.outcome.hit().zip(self.b.convex()).and_then(|(hit, b)| {
            let [motion_a, motion_b] = self.motion.translations();
            let features = hit.closest_features(&self.a, &motion_a, b, &motion_b)?;
            Some(hit.refined(&features).gradient(&motion_a, &motion_b))
        });
        format!("{derivatives:?}")
    }

    fn claims(&self, starts: &[Numbers], planes: PairPlanes<'_>) -> Option<Report> {
        let (b, starts) = (self.b.convex()?, directions::<V>(starts));
        Some(laws::linear_cast_judged(&self.a, b, self.motion, self.options, &starts, planes))
    }

    fn answer(&self, (cast, gradient): Self::Solution) -> Result<Answer, Problem> {
        let show = |hit: Impact<V>| (hit.time, hit.point, hit.normal);
        let answer = cast::answer("time", cast.outcome, show, [cast.lower, cast.upper], cast.status, cast.iterations)?;
        Ok(gradient::with(answer, gradient))
    }
}
