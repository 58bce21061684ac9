//! `ray_cast`.

use convex_support::{Point, Vector};
use gjk_raycast::{DistanceOptions, Ray, RayCast, RayCastOptions, RayHit, distance, iterative_ray_cast, ray_cast};

use super::cast::{self, problem};
use super::method::choose;
use super::{Question, scalar, tolerance};
use crate::mesh::Meshes;
use crate::wire::answer::Answer;
use crate::wire::error::Problem;
use crate::wire::reader::Coordinates;
use crate::wire::shape::{Shape, Solid, Space, vector};

#[derive(Clone, Copy)]
enum Method {
    /// GJK ray cast, Algorithm 3.
    Gjk,
    /// Algorithm 1 on the closest points of GJK distance.
    Iterative,
}

const METHODS: &[(&str, Method)] = &[("gjk", Method::Gjk), ("iterative", Method::Iterative)];

pub(super) struct RayCastQuestion<V: Vector> {
    target: Solid<V>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
    method: Method,
}

impl<V: Space> RayCastQuestion<V> {
    pub(super) fn new(
        target: &Shape,
        [source, direction]: [Coordinates; 2],
        max_lambda: Option<f64>,
        tol: Option<f64>,
        method: Option<&str>,
        meshes: &Meshes,
    ) -> Result<Self, Problem> {
        let mut options = RayCastOptions::new();
        if let Some(max_lambda) = max_lambda {
            options = options.with_max_lambda(scalar::<V>(max_lambda));
        }
        if let Some(tol) = tol {
            options = options.with_tolerance(tolerance::<V>(tol)?);
        }
        Ok(Self {
            target: target.build("target", meshes)?,
            ray: Ray { source: vector(&source), direction: vector(&direction) },
            options,
            method: choose(method, METHODS)?,
        })
    }
}

impl<V: Space> Question for RayCastQuestion<V> {
    type Solution = RayCast<V>;

    fn solve(&self) -> Result<RayCast<V>, Problem> {
        match self.method {
            Method::Gjk => ray_cast(&self.target, self.ray, self.options),
            Method::Iterative => {
                let to_point = |x: Point<V>| distance(&self.target, &x, DistanceOptions::new()).point_a;
                let closest = |x: V| Point::new(x).ok().map(to_point);
                iterative_ray_cast(closest, self.ray, self.options)
            }
        }
        .map_err(problem)
    }

    fn answer(&self, RayCast { outcome, lower, upper, status, iterations, .. }: RayCast<V>) -> Result<Answer, Problem> {
        let show = |hit: RayHit<V>| (hit.lambda, hit.point, hit.normal);
        cast::answer("lambda", outcome, show, [lower, upper], status, iterations)
    }
}
