//! What the queries of casts share.

use convex_support::{Scalar, Vector};
use gjk_raycast::{
    LinearCastOptions, MotionCastOptions, Outcome, Ray, RayCastError, RayCastOptions, StartInContact, Status,
};

use super::{How, scalar, status as shown};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::{Coordinates, Fields};
use crate::wire::shape::{Space, vector};

/// A ray and its ends, as written.
#[derive(Debug)]
pub(super) struct RaySpec {
    source: Coordinates,
    direction: Coordinates,
    min_lambda: Option<f64>,
    max_lambda: Option<f64>,
}

impl RaySpec {
    pub(super) fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            source: fields.vector("source")?,
            direction: fields.vector("direction")?,
            min_lambda: fields.maybe("min_lambda")?,
            max_lambda: fields.maybe("max_lambda")?,
        })
    }

    /// The ray in a space.
    pub(super) fn ray<V: Space>(&self) -> Ray<V> {
        Ray { source: vector(&self.source), direction: vector(&self.direction) }
    }

    pub(super) fn options<V: Vector>(&self, how: &How<'_>) -> Result<RayCastOptions<V>, Problem> {
        let mut options = RayCastOptions::new();
        options.min_lambda = self.min_lambda.map_or(options.min_lambda, scalar::<V>);
        options.max_lambda = self.max_lambda.map_or(options.max_lambda, scalar::<V>);
        options.tolerance = how.tolerance::<V>()?.unwrap_or(options.tolerance);
        Ok(options)
    }
}

/// When a cast of bodies begins to count and ends, as written.
pub(super) struct Limits {
    max_time: Option<f64>,
    target_distance: Option<f64>,
    start_in_contact: StartInContact,
}

impl Limits {
    /// Of bodies that move straight.
    pub(super) fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let starts = [("report", StartInContact::Report), ("if_deeper", StartInContact::IfDeeper)];
        Ok(Self {
            max_time: fields.maybe("max_time")?,
            target_distance: fields.not_negative("target_distance")?,
            start_in_contact: fields.named_or_default("start_in_contact", starts)?,
        })
    }

    /// Of bodies that turn: the motion must have an end.
    pub(super) fn read_with_end(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self { max_time: Some(fields.above_zero("max_time")?), ..Self::read(fields)? })
    }

    pub(super) fn linear<V: Vector>(&self, how: &How<'_>) -> Result<LinearCastOptions<V>, Problem> {
        let mut options = LinearCastOptions::new().with_start_in_contact(self.start_in_contact);
        options.max_time = self.max_time.map_or(options.max_time, scalar::<V>);
        options.target_distance = self.target_distance.map_or(options.target_distance, scalar::<V>);
        options.tolerance = how.tolerance::<V>()?.unwrap_or(options.tolerance);
        Ok(options)
    }

    /// The options of a motion cast; `place` is where the query says them, with a dot behind it, for errors.
    pub(super) fn motion<V: Vector>(&self, how: &How<'_>, place: &str) -> Result<MotionCastOptions<V>, Problem> {
        let LinearCastOptions { max_time, target_distance, start_in_contact, tolerance, .. } = self.linear::<V>(how)?;
        if !max_time.as_f64().is_finite() {
            let message = format!("{place}max_time is not finite in the precision asked for");
            return Err(Problem::new(Kind::NonFinite, message));
        }
        let options = MotionCastOptions::new().with_max_time(max_time).with_target_distance(target_distance);
        Ok(options.with_start_in_contact(start_in_contact).with_tolerance(tolerance))
    }
}

/// The answer to a cast: where it hits, or the axis that proves the miss.
///
/// `name` is what the format calls the hit's scalar; `spot` gives it with the point and the normal.
pub(super) fn answer<V: Space, H>(
    name: &'static str,
    outcome: Outcome<H, V>,
    spot: impl FnOnce(H) -> (V::Scalar, V, Option<V>),
    [lower, upper]: [V::Scalar; 2],
    status: Status,
    iterations: usize,
) -> Result<Answer, Problem> {
    let answer = match outcome {
        Outcome::Hit(hit) => {
            let (scalar, point, normal) = spot(hit);
            Answer::default()
                .with("hit", Field::Flag(true))
                .with(name, Field::number(scalar))
                .with("point", Field::vector(point))
                .with("normal", Field::maybe_vector(normal))
                .with_finite("lower", lower)
                .with_finite("upper", upper)
                .with_certain([lower, upper])
        }
        Outcome::Miss(miss) => Answer::default()
            .with("hit", Field::Flag(false))
            .with("axis", Field::vector(miss.axis))
            .with("certain", Field::Flag(true)),
        Outcome::Undecided => return Err(undecided(name, [lower, upper], status, iterations)),
    };
    Ok(answer.with("status", shown(status)).with("iterations", Field::Count(iterations)))
}

/// A cast that ended between hit and miss.
fn undecided<S: Scalar>(name: &str, [lower, upper]: [S; 2], status: Status, iterations: usize) -> Problem {
    let how = match status {
        Status::IterationLimit => "the limit was reached",
        _ => "rounding allowed no further progress",
    };
    let message = format!(
        "neither hit nor miss is certain after {iterations} iterations, where {how}; {name} is between {lower} and {upper}"
    );
    Problem::new(Kind::NotConverged, message)
}

pub(super) fn problem(why: RayCastError) -> Problem {
    match why {
        RayCastError::ZeroDirection => {
            Problem::new(Kind::ZeroDirection, "direction is the zero vector in this precision")
        }
        RayCastError::NonFinite { parameter, index } => {
            Problem::new(Kind::NonFinite, format!("{parameter}[{index}] is not finite in the precision asked for"))
        }
        _ => Problem::new(Kind::NotConverged, why.to_string()),
    }
}
