//! `distance`.

use convex_support::Vector;
use gjk_raycast::{DistanceOptions, Status, distance, distance_certificate};

use super::gradient::{self, Gradient};
use super::{Ask, How, Query, Question, certificate, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::shape::{Shape, Solid, Space};

/// The query as written.
pub(super) struct Distance {
    a: Shape,
    b: Shape,
    gradient: bool,
}

impl Query for Distance {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            a: Shape::read(&fields.within("a")?)?,
            b: Shape::read(&fields.within("b")?)?,
            gradient: gradient::is_wanted(fields)?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let mut options = DistanceOptions::new();
        if let Some(tolerance) = how.tolerance::<V>()? {
            options = options.with_tolerance(tolerance);
        }
        let (a, b) = (self.a.build("a", how.meshes)?, self.b.build("b", how.meshes)?);
        Ok(Box::new(Pair::<V> { a, b, gradient: self.gradient, options }))
    }
}

struct Pair<V: Vector> {
    a: Solid<V>,
    b: Solid<V>,
    gradient: bool,
    options: DistanceOptions<V>,
}

impl<V: Space> Question for Pair<V> {
    type Solution = (gjk_raycast::Distance<V>, Option<Gradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let answer = distance(&self.a, &self.b, self.options);
        let gradient = || match answer.closest_features(&self.a, &self.b) {
            Some(features) => {
                let gradient = features.gradient();
                Gradient::new(gradient.a, gradient.b, features.smoothness())
            }
            None => Gradient::at_floor(&self.a, &self.b),
        };
        Ok((answer, self.gradient.then(gradient)))
    }

    fn certificate(&self, (d, _): &Self::Solution) -> Option<Answer> {
        Some(certificate(distance_certificate(&self.a, &self.b, d)))
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
