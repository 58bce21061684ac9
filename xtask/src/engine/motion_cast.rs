//! `motion_cast`.

use convex_support::{Scalar as _, Vector};
use gjk_raycast::{MotionCastOptions, MotionHit, RigidMotion, motion_cast};

use super::cast::{self, problem};
use super::gradient::{self, Gradient};
use super::{Ask, How, Query, Question, scalar};
use crate::wire::answer::Answer;
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::motion::Motion;
use crate::wire::shape::{Shape, Solid, Space};

/// The query as written.
pub(super) struct MotionCast {
    a: Shape,
    b: Shape,
    motion_a: Motion,
    motion_b: Motion,
    max_time: f64,
    gradient: bool,
}

impl Query for MotionCast {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            a: Shape::read(&fields.within("a")?)?,
            b: Shape::read(&fields.within("b")?)?,
            motion_a: Motion::read_or_rest(fields, "motion_a")?,
            motion_b: Motion::read_or_rest(fields, "motion_b")?,
            max_time: fields.above_zero("max_time")?,
            gradient: gradient::is_wanted(fields)?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        Ok(Box::new(Cast::<V> {
            a: self.a.build("a", how.meshes)?,
            b: self.b.build("b", how.meshes)?,
            motion_a: self.motion_a.build(),
            motion_b: self.motion_b.build(),
            gradient: self.gradient,
            options: options(how, self.max_time, "max_time")?,
        }))
    }
}

/// The options that a query gives; `place` is where it says the end of the motion, for errors.
pub(super) fn options<V: Vector>(how: &How<'_>, max_time: f64, place: &str) -> Result<MotionCastOptions<V>, Problem> {
    let max_time = scalar::<V>(max_time);
    if !max_time.as_f64().is_finite() {
        return Err(Problem::new(Kind::NonFinite, format!("{place} is not finite in the precision asked for")));
    }
    let options = MotionCastOptions::new().with_max_time(max_time);
    Ok(how.tolerance::<V>()?.map_or(options, |tolerance| options.with_tolerance(tolerance)))
}

struct Cast<V: Vector> {
    a: Solid<V>,
    b: Solid<V>,
    motion_a: RigidMotion<V>,
    motion_b: RigidMotion<V>,
    gradient: bool,
    options: MotionCastOptions<V>,
}

impl<V: Space> Question for Cast<V> {
    type Solution = (gjk_raycast::MotionCast<V>, Option<Gradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let cast = motion_cast(&self.a, self.motion_a, &self.b, self.motion_b, self.options).map_err(problem)?;
        let hit = if self.gradient { cast.outcome.hit() } else { None };
        Ok((cast, hit.map(|hit| self.gradient_of(hit))))
    }

    fn answer(&self, (cast, gradient): Self::Solution) -> Result<Answer, Problem> {
        let show = |hit: MotionHit<V>| (hit.time, hit.point, hit.normal);
        let answer = cast::answer("time", cast.outcome, show, [cast.lower, cast.upper], cast.status, cast.iterations)?;
        Ok(gradient::with(answer, gradient))
    }
}

impl<V: Space> Cast<V> {
    /// The derivatives of the time of a hit.
    fn gradient_of(&self, hit: MotionHit<V>) -> Gradient<V> {
        let features = hit.closest_features(&self.a, &self.motion_a, &self.b, &self.motion_b);
        let smooth = features.and_then(|features| {
            let gradient = hit.refined(&features).gradient(&self.motion_a, &self.motion_b)?;
            Some(Gradient::new(gradient.pose_a, gradient.pose_b, features.smoothness()))
        });
        smooth.unwrap_or_else(|| Gradient::at_floor(&self.a, &self.b))
    }
}
