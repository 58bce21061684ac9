//! `intersect`.

use convex_support::Vector;
use gjk_raycast::{IntersectOptions, Intersection, intersection_certificate, intersects};

use super::{Ask, How, Query, Question, certificate, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::shape::{Shape, Solid, Space};

/// The query as written.
pub(super) struct Intersect {
    a: Shape,
    b: Shape,
}

impl Query for Intersect {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self { a: Shape::read(&fields.within("a")?)?, b: Shape::read(&fields.within("b")?)? })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        Ok(Box::new(Pair::<V> { a: self.a.build("a", how.meshes)?, b: self.b.build("b", how.meshes)? }))
    }
}

struct Pair<V: Vector> {
    a: Solid<V>,
    b: Solid<V>,
}

impl<V: Space> Question for Pair<V> {
    type Solution = Intersection<V>;

    fn solve(&self) -> Result<Intersection<V>, Problem> {
        Ok(intersects(&self.a, &self.b, IntersectOptions::new()))
    }

    fn certificate(&self, i: &Intersection<V>) -> Option<Answer> {
        Some(certificate(intersection_certificate(&self.a, &self.b, i)))
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
