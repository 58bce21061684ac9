//! `ray_cast`.

use convex_support::{Point, Scalar, Vector};
use gjk_raycast::{
    DistanceOptions, Outcome, Ray, RayCast, RayCastError, RayCastOptions, Status, distance, iterative_ray_cast,
    ray_cast,
};

use super::method::choose;
use super::{Question, scalar, status, tolerance};
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
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
                let closest = |x: V| match Point::new(x) {
                    Ok(x) => distance(&self.target, &x, DistanceOptions::new()).point_a,
                    Err(_) => x,
                };
                iterative_ray_cast(closest, self.ray, self.options)
            }
        }
        .map_err(problem)
    }

    fn answer(&self, cast: RayCast<V>) -> Result<Answer, Problem> {
        let answer = match cast.outcome {
            Outcome::Hit(hit) => Answer::default()
                .with("hit", Field::Flag(true))
                .with("lambda", Field::number(hit.lambda))
                .with("point", Field::vector(hit.point))
                .with("normal", Field::maybe_vector(hit.normal))
                .with_finite("lower", cast.lower)
                .with_finite("upper", cast.upper),
            Outcome::Miss(miss) => {
                Answer::default().with("hit", Field::Flag(false)).with("axis", Field::vector(miss.axis))
            }
            Outcome::Undecided => {
                return Err(undecided("lambda", [cast.lower, cast.upper], cast.status, cast.iterations));
            }
        };
        Ok(answer.with("status", status(cast.status)).with("iterations", Field::Count(cast.iterations)))
    }
}

/// A cast that ended between hit and miss.
pub(super) fn undecided<S: Scalar>(name: &str, [lower, upper]: [S; 2], status: Status, iterations: usize) -> Problem {
    let how = match status {
        Status::IterationLimit => "the limit was reached",
        _ => "rounding allowed no further progress",
    };
    let message = format!(
        "neither hit nor miss is certain after {iterations} iterations, where {how}; {name} is between {lower} and {upper}"
    );
    Problem::new(Kind::NotConverged, message)
}

pub(super) fn problem(why: RayCastError) -> Problem {
    match why {
        RayCastError::ZeroDirection => {
            Problem::new(Kind::ZeroDirection, "direction is the zero vector in this precision")
        }
        RayCastError::NonFinite { parameter, index } => {
            Problem::new(Kind::NonFinite, format!("{parameter}[{index}] is not finite in the precision asked for"))
        }
        _ => Problem::new(Kind::NotConverged, why.to_string()),
    }
}
