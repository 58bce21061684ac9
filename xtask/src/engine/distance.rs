//! `distance` and `intersect`.

use convex_support::Vector;
use gjk_raycast::{Distance, DistanceOptions, IntersectOptions, Intersection, Status, distance, intersects};

use super::method::choose;
use super::{Question, status, tolerance};
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::shape::{Shape, Solid, Space};

pub(super) struct DistanceQuestion<V: Vector> {
    a: Solid<V>,
    b: Solid<V>,
    options: DistanceOptions<V>,
}

impl<V: Space> DistanceQuestion<V> {
    pub(super) fn new(
        [a, b]: [&Shape; 2],
        tol: Option<f64>,
        method: Option<&str>,
        meshes: &Meshes,
    ) -> Result<Self, Problem> {
        choose(method, &[("gjk", ())])?;
        let mut options = DistanceOptions::new();
        if let Some(tol) = tol {
            options = options.with_tolerance(tolerance::<V>(tol)?);
        }
        Ok(Self { a: a.build("a", meshes)?, b: b.build("b", meshes)?, options })
    }
}

impl<V: Space> Question for DistanceQuestion<V> {
    type Solution = Distance<V>;

    fn solve(&self) -> Result<Distance<V>, Problem> {
        Ok(distance(&self.a, &self.b, self.options))
    }

    fn answer(&self, d: Distance<V>) -> Result<Answer, Problem> {
        if d.status == Status::IterationLimit {
            let message = format!(
                "the distance is certain only to lie between {} and {} after {} iterations",
                d.lower, d.upper, d.iterations
            );
            return Err(Problem::new(Kind::NotConverged, message));
        }
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

pub(super) struct IntersectQuestion<V: Vector> {
    a: Solid<V>,
    b: Solid<V>,
}

impl<V: Space> IntersectQuestion<V> {
    pub(super) fn new([a, b]: [&Shape; 2], method: Option<&str>, meshes: &Meshes) -> Result<Self, Problem> {
        choose(method, &[("gjk", ())])?;
        Ok(Self { a: a.build("a", meshes)?, b: b.build("b", meshes)? })
    }
}

impl<V: Space> Question for IntersectQuestion<V> {
    type Solution = Intersection<V>;

    fn solve(&self) -> Result<Intersection<V>, Problem> {
        Ok(intersects(&self.a, &self.b, IntersectOptions::new()))
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
