//! `intersect`.

use convex_support::{Scalar as _, Vector};
use gjk_raycast::laws::{self, Numbers, PairPlanes, Report};
use gjk_raycast::{Body, IntersectOptions, Intersection, SignedDistance, Status, intersection_certificate, intersects};

use super::pair::Bodies;
use super::{Ask, How, Query, Question, certificate, directions, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space};

/// The query as written.
pub(super) struct Intersect {
    bodies: Bodies,
}

impl Query for Intersect {
    const FIELDS: Names = &["a", "b"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self { bodies: Bodies::read(fields)? })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let (a, b) = self.bodies.build(how)?;
        Ok(Box::new(Pair::<V> { a, b }))
    }
}

struct Pair<V: Vector> {
    a: Solid<V>,
    b: Body<Solid<V>>,
}

impl<V: Space> Question for Pair<V> {
    type Solution = Intersection<V>;

    fn solve(&self) -> Result<Intersection<V>, Problem> {
        Ok(match &self.b {
            Body::Convex(b) => intersects(&self.a, b, IntersectOptions::new()),
            Body::HalfSpace(half_space) => {
                let zero = V::Scalar::ZERO;
                let SignedDistance { lower, upper, normal, iterations, .. } = half_space.signed_distance(&self.a);
                let (is_apart, overlap) = (lower > zero, upper <= zero);
                let status = if is_apart || overlap { Status::Converged } else { Status::Stalled };
                Intersection { overlap, axis: is_apart.then_some(normal), status, iterations }
            }
        })
    }

    fn certificate(&self, i: &Intersection<V>) -> Option<Answer> {
        self.b.convex().map(|b| certificate(intersection_certificate(&self.a, b, i)))
    }

    fn claims(&self, starts: &[Numbers], planes: PairPlanes<'_>) -> Option<Report> {
        Some(laws::pair_judged(&self.a, self.b.convex()?, &directions::<V>(starts), planes))
    }

    fn answer(&self, i: Intersection<V>) -> Result<Answer, Problem> {
        let Some(overlap) = i.decided() else {
            let message = format!("neither overlap nor a separating plane was found in {} iterations", i.iterations);
            return Err(Problem::new(Kind::NotConverged, message));
        };
        let mut answer = Answer::default().with("overlap", Field::Flag(overlap));
        if let Some(axis) = i.axis {
            answer = answer.with("axis", Field::vector(axis));
        }
        Ok(answer.with("status", status(i.status)).with("iterations", Field::Count(i.iterations)))
    }
}
