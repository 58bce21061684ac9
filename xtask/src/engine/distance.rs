//! `distance`.

use convex_support::Vector;
use gjk_raycast::{DistanceOptions, Status, distance};

use super::{Ask, How, Query, Question, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::shape::{Shape, Solid, Space};

/// The query as written.
pub(super) struct Distance {
    a: Shape,
    b: Shape,
}

impl Query for Distance {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self { a: Shape::read(&fields.within("a")?)?, b: Shape::read(&fields.within("b")?)? })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let mut options = DistanceOptions::new();
        if let Some(tolerance) = how.tolerance::<V>()? {
            options = options.with_tolerance(tolerance);
        }
        Ok(Box::new(Pair::<V> { a: self.a.build("a", how.meshes)?, b: self.b.build("b", how.meshes)?, options }))
    }
}

struct Pair<V: Vector> {
    a: Solid<V>,
    b: Solid<V>,
    options: DistanceOptions<V>,
}

impl<V: Space> Question for Pair<V> {
    type Solution = gjk_raycast::Distance<V>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        Ok(distance(&self.a, &self.b, self.options))
    }

    fn answer(&self, d: Self::Solution) -> Result<Answer, Problem> {
        certain(&d)?;
        let mut answer =
            Answer::default().with("distance", Field::number(d.distance)).with("overlap", Field::Flag(d.overlap));
        if !d.overlap {
            answer = answer
                .with("point_a", Field::vector(d.point_a))
                .with("point_b", Field::vector(d.point_b))
                .with("normal", Field::maybe_vector(d.normal));
        }
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
