//! `distance`.

use convex_support::Vector;
use gjk_raycast::laws::{self, Numbers, PairPlanes, Report};
use gjk_raycast::{Body, DistanceOptions, Status, distance, distance_certificate};

use super::gradient::{self, Gradient};
use super::pair::Bodies;
use super::{Ask, How, Query, Question, certificate, directions, scalar, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space};

/// The query as written.
pub(super) struct Distance {
    bodies: Bodies,
    gradient: bool,
}

impl Query for Distance {
    const FIELDS: Names = &["a", "b", "gradient"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let bodies = Bodies::read(fields)?;
        Ok(Self { gradient: bodies.gradient(fields)?, bodies })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let mut options = DistanceOptions::new();
        if let Some(tolerance) = how.tolerance::<V>()? {
            options = options.with_tolerance(tolerance);
        }
        let (a, b) = self.bodies.build(how)?;
        Ok(Box::new(Pair::<V> { a, b, gradient: self.gradient, options }))
    }
}

struct Pair<V: Vector> {
    a: Solid<V>,
    b: Body<Solid<V>>,
    gradient: bool,
    options: DistanceOptions<V>,
}

impl<V: Space> Question for Pair<V> {
    type Solution = (gjk_raycast::Distance<V>, Option<Gradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let b = match &self.b {
            Body::Convex(b) => b,
            Body::HalfSpace(half_space) => return Ok((half_space.distance_from(&self.a), None)),
        };
        let answer = distance(&self.a, b, self.options);
        let gradient = || match answer.closest_features(&self.a, b) {
            Some(features) => {
                let gradient = features.gradient();
                Gradient::new(gradient.a, gradient.b, features.smoothness())
            }
            None => Gradient::at_floor(&self.a, b),
        };
        Ok((answer, self.gradient.then(gradient)))
    }

    fn certificate(&self, (d, _): &Self::Solution) -> Option<Answer> {
        self.b.convex().map(|b| certificate(distance_certificate(&self.a, b, d)))
    }

    /// The second derivatives, and the same question with a start and with a limit.
    fn beside(&self, (d, _): &Self::Solution) -> String {
        let Body::Convex(b) = &self.b else { return String::new() };
        let features = d.closest_features(&self.a, b);
        let hessian = features.map(|features| (features.gradient(), features.hessian(V::ZERO, V::ZERO)));
        let warm = d.normal.map(|normal| distance(&self.a, b, self.options.with_axis(normal)));
        let limited = distance(&self.a, b, self.options.with_limit(d.lower * scalar::<V>(0.5)));
        format!("{hessian:?} {warm:?} {limited:?}")
    }

    fn claims(&self, starts: &[Numbers], planes: PairPlanes<'_>) -> Option<Report> {
        Some(laws::pair_judged(&self.a, self.b.convex()?, &directions::<V>(starts), planes))
    }

    fn answer(&self, (d, gradient): Self::Solution) -> Result<Answer, Problem> {
        certain(&d)?;
        let mut answer =
            Answer::default().with("distance", Field::number(d.distance)).with("overlap", Field::Flag(d.overlap));
        if !d.overlap {
            answer = answer
                .with("point_a", Field::vector(d.point_a))
                .with("point_b", Field::vector(d.point_b))
                .with("normal", Field::maybe_vector(d.normal));
        }
        let answer = gradient::with(answer, gradient);
        Ok(answer
            .with_finite("lower", d.lower)
            .with_finite("upper", d.upper)
            .with("status", status(d.status))
            .with("iterations", Field::Count(d.iterations)))
    }
}

/// Refuses a distance that the search gave up on.
pub(super) fn certain<V: Vector>(d: &gjk_raycast::Distance<V>) -> Result<(), Problem> {
    if d.status != Status::IterationLimit {
        return Ok(());
    }
    let message = format!(
        "the distance is certain only to lie between {} and {} after {} iterations",
        d.lower, d.upper, d.iterations
    );
    Err(Problem::new(Kind::NotConverged, message))
}
