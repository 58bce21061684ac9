//! What `ray_cast`, `linear_cast` and `motion_cast` share.

use convex_support::Scalar;
use gjk_raycast::{Outcome, RayCastError, Status};

use super::status as shown;
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::shape::Space;

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
        }
        Outcome::Miss(miss) => Answer::default().with("hit", Field::Flag(false)).with("axis", Field::vector(miss.axis)),
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
