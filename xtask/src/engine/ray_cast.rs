//! `ray_cast`.

use convex_support::{Point, Vector};
use gjk_raycast::laws::{self, Numbers, PairPlanes, Report};
use gjk_raycast::{
    CastMethod, DistanceOptions, Ray, RayCastOptions, RayHit, distance, iterative_ray_cast, ray_cast,
    ray_cast_certificate,
};

use super::cast::{self, RaySpec, problem};
use super::{Ask, How, Query, Question, certificate, directions, scalar};
use crate::wire::answer::Answer;
use crate::wire::error::Problem;
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::{Shape, Solid, Space};

/// The query as written.
pub(super) struct RayCast {
    target: Shape,
    ray: RaySpec,
}

#[derive(Clone, Copy)]
enum Method {
    /// The crate's default: planes by a portal, or by GJK where that is in doubt.
    Gjk,
    /// Algorithm 1 on the closest points of GJK distance.
    Iterative,
}

impl Query for RayCast {
    const FIELDS: Names = &["target", "source", "direction", "min_lambda", "max_lambda"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self { target: Shape::read(fields.within("target")?)?, ray: RaySpec::read(fields)? })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        Ok(Box::new(Cast::<V> {
            target: self.target.build("target", how.meshes)?,
            ray: self.ray.ray(),
            options: self.ray.options(how)?,
            method: how.method(&[("gjk", Method::Gjk), ("iterative", Method::Iterative)])?,
        }))
    }
}

struct Cast<V: Vector> {
    target: Solid<V>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
    method: Method,
}

impl<V: Space> Question for Cast<V> {
    type Solution = gjk_raycast::RayCast<V>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        match self.method {
            Method::Gjk => ray_cast(&self.target, self.ray, self.options),
            Method::Iterative => {
                // Algorithm 1 goes by the plane through the closest point. That of the normal is proved to rounding,
                // where the point itself may be off along it by the root of that.
                let to_point = |x: Point<V>| {
                    let d = distance(&self.target, &x, DistanceOptions::new());
                    d.normal.map_or(d.point_a, |normal| x.at() + normal * d.distance)
                };
                let closest = |x: V| Point::new(x).ok().map(to_point);
                iterative_ray_cast(closest, self.ray, self.options)
            }
        }
        .map_err(problem)
    }

    fn certificate(&self, cast: &Self::Solution) -> Option<Answer> {
        Some(certificate(ray_cast_certificate(&self.target, self.ray, cast)))
    }

    /// The derivatives, and a batch around the ray.
    fn beside(&self, cast: &Self::Solution) -> String {
        let derivatives = cast.outcome.hit().and_then(|hit| {
            let features = hit.closest_features(&self.target, self.ray)?;
            Some((features.smoothness(), hit.refined(&features).gradient(self.ray)))
        });
        let turned = |k: f64| self.ray.direction + self.ray.source * scalar::<V>(k / 64.0);
        let rays = [0.0, -1.0, 2.0].map(|k| Ray { direction: turned(k), ..self.ray });
        let options = self.options.with_method(CastMethod::Gjk);
        #[cfg(feature = "parallel")]
        let batch = gjk_raycast::par_ray_casts(&self.target, &rays, options);
        #[cfg(not(feature = "parallel"))]
        let batch = gjk_raycast::ray_casts(&self.target, &rays, options).collect::<Vec<_>>();
        format!("{derivatives:?} {batch:?}")
    }

    fn claims(&self, starts: &[Numbers], planes: PairPlanes<'_>) -> Option<Report> {
        Some(laws::ray_judged(&self.target, self.ray, self.options, &directions::<V>(starts), planes.a))
    }

    fn answer(&self, cast: Self::Solution) -> Result<Answer, Problem> {
        let show = |hit: RayHit<V>| (hit.lambda, hit.point, hit.normal);
        cast::answer("lambda", cast.outcome, show, [cast.lower, cast.upper], cast.status, cast.iterations)
    }
}
