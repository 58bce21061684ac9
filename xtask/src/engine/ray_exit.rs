//! `ray_exit`.

use convex_support::Vector;
use gjk_raycast::laws::{self, Numbers, PairPlanes, Report};
use gjk_raycast::{Ray, RayCastOptions, RayHit, ray_exit};

use super::cast::{self, RaySpec, problem};
use super::{Ask, How, Query, Question, directions};
use crate::wire::answer::Answer;
use crate::wire::error::Problem;
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::{Shape, Solid, Space};

/// The query as written.
pub(super) struct RayExit {
    target: Shape,
    ray: RaySpec,
}

impl Query for RayExit {
    const FIELDS: Names = &["target", "source", "direction", "min_lambda", "max_lambda"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self { target: Shape::read(fields.within("target")?)?, ray: RaySpec::read(fields)? })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let target = self.target.build("target", how.meshes)?;
        Ok(Box::new(Exit::<V> { target, ray: self.ray.ray(), options: self.ray.options(how)? }))
    }
}

struct Exit<V: Vector> {
    target: Solid<V>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
}

impl<V: Space> Question for Exit<V> {
    type Solution = gjk_raycast::RayExit<V>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        ray_exit(&self.target, self.ray, self.options).map_err(problem)
    }

    fn claims(&self, starts: &[Numbers], planes: PairPlanes<'_>) -> Option<Report> {
        Some(laws::ray_judged(&self.target, self.ray, self.options, &directions::<V>(starts), planes.a))
    }

    fn answer(&self, exit: Self::Solution) -> Result<Answer, Problem> {
        let show = |hit: RayHit<V>| (hit.lambda, hit.point, hit.normal);
        cast::answer("lambda", exit.outcome, show, [exit.lower, exit.upper], exit.status, exit.iterations)
    }
}
