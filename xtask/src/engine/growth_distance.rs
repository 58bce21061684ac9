//! `growth_distance`.

use convex_support::{Scalar as _, Vector};
use gjk_raycast::{GrowthError, GrowthOptions, growth_distance, growth_distance_certificate};

use super::{Ask, How, Query, Question, certificate, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::{Coordinates, Fields};
use crate::wire::names::Names;
use crate::wire::shape::{Shape, Solid, Space, vector};

/// The query as written.
pub(super) struct GrowthDistance {
    shapes: [Shape; 2],
    centers: [Coordinates; 2],
}

impl Query for GrowthDistance {
    const FIELDS: Names = &["a", "b", "center_a", "center_b"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let shapes = [Shape::read(fields.within("a")?)?, Shape::read(fields.within("b")?)?];
        Ok(Self { shapes, centers: [fields.vector("center_a")?, fields.vector("center_b")?] })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let [a, b] = &self.shapes;
        let options = GrowthOptions::new();
        let options = how.tolerance::<V>()?.map_or(options, |tolerance| options.with_tolerance(tolerance));
        let shapes = [a.build("a", how.meshes)?, b.build("b", how.meshes)?];
        Ok(Box::new(Growth::<V> { shapes, centers: self.centers.each_ref().map(vector), options }))
    }
}

struct Growth<V: Vector> {
    shapes: [Solid<V>; 2],
    centers: [V; 2],
    options: GrowthOptions<V>,
}

impl<V: Space> Question for Growth<V> {
    type Solution = gjk_raycast::GrowthDistance<V>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let ([a, b], [center_a, center_b]) = (&self.shapes, self.centers);
        growth_distance(a, center_a, b, center_b, self.options).map_err(|why| {
            let kind = if let GrowthError::CenterOutside { .. } = why { Kind::CenterOutside } else { Kind::NonFinite };
            Problem::new(kind, why.to_string())
        })
    }

    fn certificate(&self, growth: &Self::Solution) -> Option<Answer> {
        let ([a, b], [center_a, center_b]) = (&self.shapes, self.centers);
        Some(certificate(growth_distance_certificate(a, center_a, b, center_b, growth)))
    }

    /// The derivatives.
    fn beside(&self, growth: &Self::Solution) -> String {
        format!("{:?}", growth.gradient(self.centers))
    }

    fn answer(&self, growth: Self::Solution) -> Result<Answer, Problem> {
        if !growth.upper.as_f64().is_finite() {
            let message = format!("no scale is known to be enough, and none less than {} is", growth.lower);
            return Err(Problem::new(Kind::NotConverged, message));
        }
        Ok(Answer::default()
            .with("scale", Field::number(growth.scale))
            .with("point", Field::vector(growth.point))
            .with("normal", Field::maybe_vector(growth.normal))
            .with("lower", Field::number(growth.lower))
            .with("upper", Field::number(growth.upper))
            .with("status", status(growth.status))
            .with("iterations", Field::Count(growth.iterations)))
    }
}
