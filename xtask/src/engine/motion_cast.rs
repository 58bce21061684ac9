//! `motion_cast`.

use convex_support::Vector;
use gjk_raycast::laws::{self, Numbers, PairPlanes, Report};
use gjk_raycast::{Body, Impact, MotionCastOptions, RigidMotion};

use super::cast::{self, Limits, problem};
use super::gradient::{self, Gradient};
use super::pair::Bodies;
use super::{Ask, How, Query, Question, directions};
use crate::wire::answer::Answer;
use crate::wire::error::Problem;
use crate::wire::fields::Fields;
use crate::wire::motion::Motion;
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space};

/// The query as written.
pub(super) struct MotionCast {
    bodies: Bodies,
    motion_a: Motion,
    motion_b: Motion,
    limits: Limits,
    gradient: bool,
}

impl Query for MotionCast {
    const FIELDS: Names =
        &["a", "b", "motion_a", "motion_b", "max_time", "target_distance", "start_in_contact", "gradient"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let bodies = Bodies::read(fields)?;
        Ok(Self {
            motion_a: Motion::read_or_rest(fields, "motion_a")?,
            motion_b: Motion::read_or_rest(fields, "motion_b")?,
            limits: Limits::read_with_end(fields)?,
            gradient: bodies.gradient(fields)?,
            bodies,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let (a, b) = self.bodies.build(how)?;
        let (motion_a, motion_b) = (self.motion_a.build(), self.motion_b.build());
        let options = self.limits.motion(how, "")?;
        Ok(Box::new(Cast::<V> { a, b, motion_a, motion_b, gradient: self.gradient, options }))
    }
}

struct Cast<V: Vector> {
    a: Solid<V>,
    b: Body<Solid<V>>,
    motion_a: RigidMotion<V>,
    motion_b: RigidMotion<V>,
    gradient: bool,
    options: MotionCastOptions<V>,
}

impl<V: Space> Question for Cast<V> {
    type Solution = (gjk_raycast::MotionCast<V>, Option<Gradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let cast = self.b.motion_cast_of_both(&self.a, self.motion_a, self.motion_b, self.options).map_err(problem)?;
        let hit = if self.gradient { cast.outcome.hit() } else { None };
        Ok((
            cast,
            hit.and_then(|hit| {
                Some(Gradient::of_impact(hit, (&self.a, &self.motion_a), (self.b.convex()?, &self.motion_b)))
            }),
        ))
    }

    /// The derivatives by the motions too.
    fn beside(&self, (cast, _): &Self::Solution) -> String {
        let derivatives = cast.outcome.hit().zip(self.b.convex()).and_then(|(hit, b)| {
            let features = hit.closest_features(&self.a, &self.motion_a, b, &self.motion_b)?;
            let gradient = hit.refined(&features).gradient(&self.motion_a, &self.motion_b)?;
            let by_motion = self.motion_a.gradient(hit.time, gradient.pose_a);
            Some((gradient, by_motion))
        });
        format!("{derivatives:?}")
    }

    fn claims(&self, starts: &[Numbers], _: PairPlanes<'_>) -> Option<Report> {
        let (a, b) = (
            (&self.a as laws::AnyShape<'_, V>, self.motion_a),
            (self.b.convex()? as laws::AnyShape<'_, V>, self.motion_b),
        );
        Some(laws::motion_cast_judged(a, b, self.options, &directions::<V>(starts)))
    }

    fn answer(&self, (cast, gradient): Self::Solution) -> Result<Answer, Problem> {
        let show = |hit: Impact<V>| (hit.time, hit.point, hit.normal);
        let answer = cast::answer("time", cast.outcome, show, [cast.lower, cast.upper], cast.status, cast.iterations)?;
        Ok(gradient::with(answer, gradient))
    }
}
