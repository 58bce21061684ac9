//! `motion_clearance`.

use convex_support::{Scalar as _, Vector};
use gjk_raycast::{Body, MotionClearanceOptions, RigidMotion};

use super::cast::problem;
use super::pair::Bodies;
use super::{Ask, How, Query, Question, scalar, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::motion::Motion;
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space};

/// The query as written.
pub(super) struct MotionClearance {
    bodies: Bodies,
    motion_a: Motion,
    motion_b: Motion,
    max_time: f64,
}

impl Query for MotionClearance {
    const FIELDS: Names = &["a", "b", "motion_a", "motion_b", "max_time"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let max_time = fields.get("max_time")?;
        Ok(Self {
            bodies: Bodies::read(fields)?,
            motion_a: Motion::read_or_rest(fields, "motion_a")?,
            motion_b: Motion::read_or_rest(fields, "motion_b")?,
            max_time: fields.not_negative("max_time")?.unwrap_or(max_time),
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let (a, b) = self.bodies.build(how)?;
        let (motion_a, motion_b) = (self.motion_a.build(), self.motion_b.build());
        let mut options = MotionClearanceOptions::new().with_max_time(scalar::<V>(self.max_time));
        options.tolerance = how.tolerance::<V>()?.unwrap_or(options.tolerance);
        Ok(Box::new(Pair::<V> { a, b, motion_a, motion_b, options }))
    }
}

struct Pair<V: Vector> {
    a: Solid<V>,
    b: Body<Solid<V>>,
    motion_a: RigidMotion<V>,
    motion_b: RigidMotion<V>,
    options: MotionClearanceOptions<V>,
}

impl<V: Space> Question for Pair<V> {
    type Solution = gjk_raycast::MotionClearance<V>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        self.b.motion_clearance_of_both(&self.a, self.motion_a, self.motion_b, self.options).map_err(problem)
    }

    fn answer(&self, least: Self::Solution) -> Result<Answer, Problem> {
        if !least.upper.as_f64().is_finite() {
            return Err(Problem::new(Kind::NotConverged, "the distance is not known at any time"));
        }
        let answer =
            Answer::default().with("distance", Field::number(least.distance)).with("time", Field::number(least.time));
        Ok(with_points(answer, &least).with("iterations", Field::Count(least.iterations)))
    }
}

/// With what a least distance says beside where and when it is: closest points, normal, bracket and status.
pub(super) fn with_points<V: Space>(answer: Answer, least: &gjk_raycast::MotionClearance<V>) -> Answer {
    answer
        .with("point_a", Field::vector(least.point_a))
        .with("point_b", Field::vector(least.point_b))
        .with("normal", Field::maybe_vector(least.normal))
        .with_finite("lower", least.lower)
        .with_finite("upper", least.upper)
        .with("status", status(least.status))
}
