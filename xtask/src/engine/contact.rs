//! `contact`.

use convex_support::Vector;
use gjk_raycast::laws::{self, Numbers, PairPlanes, Report};
use gjk_raycast::{Body, ContactPoint, SignedDistanceOptions, contact_after};

use super::pair::Bodies;
use super::signed_distance::{certain, options};
use super::{Ask, How, Query, Question, directions, scalar, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::Problem;
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space};

/// The query as written.
pub(super) struct Contact {
    bodies: Bodies,
    within: f64,
}

impl Query for Contact {
    const FIELDS: Names = &["a", "b", "within"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self { bodies: Bodies::read(fields)?, within: fields.not_negative("within")?.unwrap_or(0.0) })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let (a, b) = self.bodies.build(how)?;
        Ok(Box::new(Pair::<V> { a, b, within: scalar::<V>(self.within), options: options(how)? }))
    }
}

struct Pair<V: Vector> {
    a: Solid<V>,
    b: Body<Solid<V>>,
    within: V::Scalar,
    options: SignedDistanceOptions<V>,
}

impl<V: Space> Question for Pair<V> {
    type Solution = Option<gjk_raycast::Contact<V>>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        Ok(self.b.contact(&self.a, self.within, self.options))
    }

    /// The same contact a moment later.
    fn beside(&self, found: &Self::Solution) -> String {
        let (Some(last), Some(b)) = (found, self.b.convex()) else { return String::new() };
        format!("{:?}", contact_after(last, &self.a, b, self.within, self.options))
    }

    fn claims(&self, starts: &[Numbers], planes: PairPlanes<'_>) -> Option<Report> {
        Some(laws::contact_judged(&self.a, self.b.convex()?, self.within, &directions::<V>(starts), planes))
    }

    fn answer(&self, found: Self::Solution) -> Result<Answer, Problem> {
        let (manifold, distance) = match found {
            Some(contact) => (Field::Answer(manifold(&contact)), contact.distance),
            // That there is none is known from the signed distance, which `contact` asks for just so.
            None => (Field::Null, self.b.signed_distance(&self.a, self.options.with_limit(self.within))),
        };
        certain(&distance, self.within)?;
        Ok(Answer::default()
            .with("contact", manifold)
            .with_finite("lower", distance.lower)
            .with_finite("upper", distance.upper)
            .with("status", status(distance.status))
            .with("iterations", Field::Count(distance.iterations)))
    }
}

/// What the format says of a contact.
fn manifold<V: Space>(contact: &gjk_raycast::Contact<V>) -> Answer {
    let point = |point: &ContactPoint<V>| {
        Answer::default()
            .with("point_a", Field::vector(point.point_a))
            .with("point_b", Field::vector(point.point_b))
            .with("signed_distance", Field::number(point.signed_distance))
            .with("feature_a", Field::Count(point.feature_a as usize))
            .with("feature_b", Field::Count(point.feature_b as usize))
    };
    Answer::default()
        .with("normal", Field::vector(contact.normal))
        .with("signed_distance", Field::number(contact.distance.signed_distance))
        .with("points", Field::Answers(contact.points().iter().map(point).collect()))
}
