//! `signed_distance`.

use convex_support::{Scalar as _, Vector};
use gjk_raycast::{SignedDistanceOptions, Status, signed_distance};

use super::gradient::{self, Gradient};
use super::{Ask, How, Query, Question, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::shape::{Shape, Solid, Space};

/// The query as written.
pub(super) struct SignedDistance {
    a: Shape,
    b: Shape,
    gradient: bool,
}

impl Query for SignedDistance {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            a: Shape::read(&fields.within("a")?)?,
            b: Shape::read(&fields.within("b")?)?,
            gradient: gradient::is_wanted(fields)?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let options = options(how)?;
        let (a, b) = (self.a.build("a", how.meshes)?, self.b.build("b", how.meshes)?);
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
    b: Solid<V>,
    gradient: bool,
    options: SignedDistanceOptions<V>,
}

impl<V: Space> Question for Pair<V> {
    type Solution = (gjk_raycast::SignedDistance<V>, Option<Gradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let answer = signed_distance(&self.a, &self.b, self.options);
        let gradient = || {
            let features = answer.closest_features(&self.a, &self.b);
            let gradient = features.gradient();
            Gradient::new(gradient.a, gradient.b, features.smoothness())
        };
        Ok((answer, self.gradient.then(gradient)))
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
/// One that is, is answered with its bracket, however wide, and with `status` to say so: ties, as of an ellipsoid of revolution
/// around a ball, are known to all digits from below long before they are from above.
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
