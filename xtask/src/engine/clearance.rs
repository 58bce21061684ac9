//! `clearance`.

use convex_support::{Ellipsoid, Vector};
use ellip_margin::{ClearanceResult, MarginOptions, clearance, free_margins};

use super::margin::{certain, options};
use super::{Ask, How, Query, Question, scalar};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::{EllipsoidSpec, Space};

/// The query as written.
pub(super) struct Clearance {
    links: Vec<EllipsoidSpec>,
    obstacles: Vec<EllipsoidSpec>,
}

#[derive(Clone, Copy)]
enum Method {
    /// A tree of the obstacles, and only the pairs that can be the least.
    Culled,
    /// Every pair.
    AllPairs,
}

impl Query for Clearance {
    const FIELDS: Names = &["links", "obstacles"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let all = |key| fields.each(key)?.into_iter().map(EllipsoidSpec::read).collect::<Result<_, _>>();
        Ok(Self { links: all("links")?, obstacles: all("obstacles")? })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        let build = |name: &str, of: &[EllipsoidSpec]| -> Result<Vec<Ellipsoid<V>>, Problem> {
            of.iter().enumerate().map(|(i, spec)| spec.build(&format!("{name}[{i}]"))).collect()
        };
        Ok(Box::new(Crowd::<V> {
            links: build("links", &self.links)?,
            obstacles: build("obstacles", &self.obstacles)?,
            options: options(how.tol)?,
            method: how.method(&[("culled", Method::Culled), ("all_pairs", Method::AllPairs)])?,
        }))
    }
}

/// All links against all obstacles.
struct Crowd<V: Vector> {
    links: Vec<Ellipsoid<V>>,
    obstacles: Vec<Ellipsoid<V>>,
    options: MarginOptions,
    method: Method,
}

impl<V: Space> Question for Crowd<V> {
    type Solution = ClearanceResult<V>;

    fn solve(&self) -> Result<ClearanceResult<V>, Problem> {
        match self.method {
            Method::Culled => ellip_margin::Clearance::new(&self.obstacles, self.options)
                .and_then(|mut clearance| clearance.step(&self.links)),
            Method::AllPairs => clearance(&self.links, &self.obstacles, self.options),
        }
        .map_err(|why| Problem::new(Kind::InvalidShape, why.to_string()))
    }

    /// A second step, the pairs near the least, and all margins of the first obstacle in a batch.
    fn beside(&self, least: &ClearanceResult<V>) -> String {
        let near = ellip_margin::Clearance::new(&self.obstacles, self.options).map(|mut clearance| {
            let _ = clearance.step(&self.links);
            (clearance.step(&self.links), clearance.within(&self.links, least.margin.margin * scalar::<V>(2.0)))
        });
        format!("{near:?} {:?}", free_margins(&self.links, &self.obstacles[..1], self.options))
    }

    fn answer(&self, least: ClearanceResult<V>) -> Result<Answer, Problem> {
        certain(least.margin.status, least.margin.iterations)?;
        Ok(Answer::default()
            .with("min_margin", Field::number(least.margin.margin))
            .with("link", Field::Count(least.link))
            .with("obstacle", Field::Count(least.obstacle))
            .with("pairs_evaluated", Field::Count(least.pairs_evaluated)))
    }
}
