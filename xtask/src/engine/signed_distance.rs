//! `signed_distance`.

use convex_support::{Scalar as _, Vector};
use gjk_raycast::laws::{self, Numbers, PairPlanes, Report};
use gjk_raycast::{Body, SignedDistanceOptions, Status};

use super::gradient::{self, Gradient};
use super::pair::Bodies;
use super::{Ask, How, Query, Question, directions, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space};

/// The query as written.
pub(super) struct SignedDistance {
    bodies: Bodies,
    gradient: bool,
}

impl Query for SignedDistance {
    const FIELDS: Names = &["a", "b", "gradient"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let bodies = Bodies::read(fields)?;
        Ok(Self { gradient: bodies.gradient(fields)?, bodies })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let options = options(how)?;
        let (a, b) = self.bodies.build(how)?;
        Ok(Box::new(Pair::<V> { a, b, gradient: self.gradient, options }))
    }
}

/// The options that a query gives.
pub(super) fn options<V: Vector>(how: &How<'_>) -> Result<SignedDistanceOptions<V>, Problem> {
    let options = SignedDistanceOptions::new();
    Ok(how.tolerance::<V>()?.map_or(options, |tolerance| options.with_tolerance(tolerance)))
}

struct Pair<V: Vector> {
    a: Solid<V>,
    b: Body<Solid<V>>,
    gradient: bool,
    options: SignedDistanceOptions<V>,
}

impl<V: Space> Question for Pair<V> {
    type Solution = (gjk_raycast::SignedDistance<V>, Option<Gradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let answer = self.b.signed_distance(&self.a, self.options);
        let gradient = self.b.convex().filter(|_| self.gradient).map(|b| {
            let features = answer.closest_features(&self.a, b);
            let gradient = features.gradient();
            Gradient::new(gradient.a, gradient.b, features.smoothness())
        });
        Ok((answer, gradient))
    }

    /// The second derivatives, and the same question with a start.
    fn beside(&self, (d, _): &Self::Solution) -> String {
        let hessian = self.b.convex().map(|b| {
            let features = d.closest_features(&self.a, b);
            (features.gradient(), features.smoothness(), features.hessian(V::ZERO, V::ZERO))
        });
        format!("{hessian:?} {:?}", self.b.signed_distance(&self.a, self.options.with_axis(d.normal)))
    }

    fn claims(&self, starts: &[Numbers], planes: PairPlanes<'_>) -> Option<Report> {
        Some(laws::pair_judged(&self.a, self.b.convex()?, &directions::<V>(starts), planes))
    }

    fn answer(&self, (d, gradient): Self::Solution) -> Result<Answer, Problem> {
        certain(&d, V::Scalar::ZERO)?;
        let answer = Answer::default()
            .with("signed_distance", Field::number(d.signed_distance))
            .with("overlap", Field::Flag(d.overlap))
            .with("normal", Field::vector(d.normal))
            .with("point_a", Field::vector(d.point_a))
            .with("point_b", Field::vector(d.point_b));
        Ok(gradient::with(answer, gradient)
            .with_finite("lower", d.lower)
            .with_finite("upper", d.upper)
            .with("status", status(d.status))
            .with("iterations", Field::Count(d.iterations)))
    }
}

/// Refuses a signed distance that is no number, or that the search gave up on before it was on one side of `level`.
///
/// One that is, is answered with its bracket, however wide, and with `status` to say so: ties, as of an ellipsoid of
/// revolution around a ball, are known to all digits from below long before they are from above.
pub(super) fn certain<V: Vector>(d: &gjk_raycast::SignedDistance<V>, level: V::Scalar) -> Result<(), Problem> {
    let decided = d.lower > level || d.upper <= level;
    if decided || d.status != Status::IterationLimit && d.signed_distance.as_f64().is_finite() {
        return Ok(());
    }
    let message = format!(
        "the signed distance is certain only to lie between {} and {} after {} iterations",
        d.lower, d.upper, d.iterations
    );
    Err(Problem::new(Kind::NotConverged, message))
}
