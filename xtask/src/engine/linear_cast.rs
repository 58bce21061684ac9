//! `linear_cast`.

use convex_support::Vector;
use gjk_raycast::{LinearCast, LinearCastOptions, LinearHit, Motion, linear_cast};

use super::cast::{self, problem};
use super::method::choose;
use super::{Question, scalar, tolerance};
use crate::mesh::Meshes;
use crate::wire::answer::Answer;
use crate::wire::error::Problem;
use crate::wire::reader::Coordinates;
use crate::wire::shape::{Shape, Solid, Space, vector};

pub(super) struct LinearCastQuestion<V: Vector> {
    a: Solid<V>,
    b: Solid<V>,
    motion: Motion<V>,
    options: LinearCastOptions<V>,
}

impl<V: Space> LinearCastQuestion<V> {
    pub(super) fn new(
        [a, b]: [&Shape; 2],
        [velocity_a, velocity_b]: [Coordinates; 2],
        max_time: Option<f64>,
        tol: Option<f64>,
        method: Option<&str>,
        meshes: &Meshes,
    ) -> Result<Self, Problem> {
        choose(method, &[("gjk", ())])?;
        let mut options = LinearCastOptions::new();
        if let Some(max_time) = max_time {
            options = options.with_max_time(scalar::<V>(max_time));
        }
        if let Some(tol) = tol {
            options = options.with_tolerance(tolerance::<V>(tol)?);
        }
        Ok(Self {
            a: a.build("a", meshes)?,
            b: b.build("b", meshes)?,
            motion: Motion { velocity_a: vector(&velocity_a), velocity_b: vector(&velocity_b) },
            options,
        })
    }
}

impl<V: Space> Question for LinearCastQuestion<V> {
    type Solution = LinearCast<V>;

    fn solve(&self) -> Result<LinearCast<V>, Problem> {
        linear_cast(&self.a, &self.b, self.motion, self.options).map_err(problem)
    }

    fn answer(&self, cast: LinearCast<V>) -> Result<Answer, Problem> {
        let LinearCast { outcome, lower, upper, status, iterations, .. } = cast;
        let show = |hit: LinearHit<V>| (hit.time, hit.point, hit.normal);
        cast::answer("time", outcome, show, [lower, upper], status, iterations)
    }
}
