//! `motion_clearance`.

use convex_support::{Posed, Scalar as _, SupportMap, Vector};
use gjk_raycast::{Body, MotionCastOptions, MotionClearanceOptions, RigidMotion, Trajectory};

use super::cast::problem;
use super::pair::Bodies;
use super::{Ask, How, Query, Question, meeting, scalar, status};
use crate::wire::answer::{Answer, Field, Number};
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

    fn prove(&self) -> Result<(Self::Solution, Option<Answer>), Problem> {
        let least = self.solve()?;
        let certificate = self.certificate_of(&least)?;
        Ok((least, certificate))
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

impl<V: Space> Pair<V> {
    /// What proves a least distance: the intervals of a cast to its lower bound, and points of the bodies at its time;
    /// of a contact the bracket of its time, and points at the end of that.
    fn certificate_of(&self, least: &gjk_raycast::MotionClearance<V>) -> Result<Option<Answer>, Problem> {
        if !least.upper.as_f64().is_finite() {
            return Ok(None);
        }
        let zero = V::Scalar::ZERO;
        let (meets, mut until, mut free) = (least.upper == zero, zero, Vec::new());
        let options = MotionCastOptions::new().with_max_time(self.options.max_time).with_target_distance(least.lower);
        let mut show = |times: [V::Scalar; 2], normals| {
            until = times[1];
            free.push(free_part(Answer::default(), times, normals));
        };
        let cast = if meets || least.lower > zero {
            let cast = self.b.motion_cast_of_both_with(&self.a, self.motion_a, self.motion_b, options, &mut show);
            Some(cast.map_err(problem)?)
        } else {
            None
        };
        let (at, met) = match cast.filter(|_| meets) {
            Some(cast) => (cast.upper, Some([until, cast.upper])),
            None => (least.time, None),
        };
        let points = match &self.b {
            Body::Convex(b) if at.as_f64().is_finite() => {
                meeting(&placed(&self.a, &self.motion_a, at)?, &placed(b, &self.motion_b, at)?)
            }
            _ => Answer::default(),
        };
        Ok(Some(of_met(points, met).with("free", Field::Answers(free))))
    }
}

/// A shape where its motion has it at a time.
fn placed<V: Space>(
    shape: &Solid<V>,
    motion: &RigidMotion<V>,
    time: V::Scalar,
) -> Result<impl SupportMap<Vector = V>, Problem> {
    let place = motion.displacement(time);
    Posed::from_matrix(shape, place.rotation(), place.of(V::ZERO))
        .map_err(|why| Problem::new(Kind::NotConverged, why.to_string()))
}

/// A part of a proof: what keeps two bodies apart between two times.
pub(super) fn free_part<V: Space>(of: Answer, times: [V::Scalar; 2], normals: [V; 2]) -> Answer {
    of.with("times", Field::Numbers(times.map(Number::of).to_vec())).with("normals", Field::vectors(normals))
}

/// With the bracket of a contact, if there is one.
pub(super) fn of_met<S: convex_support::Scalar>(points: Answer, met: Option<[S; 2]>) -> Answer {
    match met {
        Some([lower, upper]) => {
            let bracket = Answer::default().with("lower", Field::number(lower)).with("upper", Field::number(upper));
            points.with("met", Field::Answer(bracket))
        }
        None => points,
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
