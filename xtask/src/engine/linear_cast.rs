//! `linear_cast`.

use convex_support::Vector;
use gjk_raycast::{LinearCast, LinearCastOptions, Motion, Outcome, linear_cast};

use super::method::choose;
use super::ray_cast::{problem, undecided};
use super::{Question, scalar, status, tolerance};
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field};
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
        let answer = match cast.outcome {
            Outcome::Hit(hit) => Answer::default()
                .with("hit", Field::Flag(true))
                .with("time", Field::number(hit.time))
                .with("point", Field::vector(hit.point))
                .with("normal", Field::maybe_vector(hit.normal))
                .with_finite("lower", cast.lower)
                .with_finite("upper", cast.upper),
            Outcome::Miss(miss) => {
                Answer::default().with("hit", Field::Flag(false)).with("axis", Field::vector(miss.axis))
            }
            Outcome::Undecided => {
                return Err(undecided("time", [cast.lower, cast.upper], cast.status, cast.iterations));
            }
        };
        Ok(answer.with("status", status(cast.status)).with("iterations", Field::Count(cast.iterations)))
    }
}
