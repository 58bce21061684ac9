//! From a query to its answer: the one place where precision and dimension become types.

mod cast;
mod distance;
mod enclosing;
mod fit;
mod inscribed;
mod linear_cast;
mod margin;
mod method;
mod ray_cast;

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3A};
use convex_support::{Scalar as _, Vector};
use cpu_time::ThreadTime;

use self::distance::{DistanceQuestion, IntersectQuestion};
use self::linear_cast::LinearCastQuestion;
use self::margin::{ClearanceQuestion, MarginQuestion, TrackQuestion};
use self::ray_cast::RayCastQuestion;
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::query::{Precision, Query, Request};
use crate::wire::reader::Object;
use crate::wire::shape::Space;

/// A query with its shapes built, ready to be solved.
trait Question {
    type Solution;

    /// Solves it: all that a user of the crate would call, and nothing else.
    fn solve(&self) -> Result<Self::Solution, Problem>;

    /// What the format says of the solution.
    fn answer(&self, solution: Self::Solution) -> Result<Answer, Problem>;
}

/// Any question.
pub trait Ask {
    /// Solves the question once.
    fn ask(&self) -> Result<Answer, Problem>;

    /// Nanoseconds of thread CPU time that solving it takes: the least mean of three runs of about `microseconds` each.
    fn time(&self, microseconds: u64) -> f64;
}

impl<Q: Question> Ask for Q {
    fn ask(&self) -> Result<Answer, Problem> {
        let answer = self.answer(self.solve()?)?;
        match answer.non_finite() {
            Some(field) => {
                Err(Problem::new(Kind::NotConverged, format!("{field} is out of the range of the precision")))
            }
            None => Ok(answer),
        }
    }

    fn time(&self, microseconds: u64) -> f64 {
        let run = |count: u64| {
            let start = ThreadTime::now();
            for _ in 0..count {
                let _ = std::hint::black_box(self.solve());
            }
            start.elapsed().as_nanos() as f64 / count as f64
        };
        let once = run(1).max(1.0);
        let count = ((microseconds * 1000) as f64 / once).ceil().max(1.0) as u64;
        (0..3).map(|_| run(count)).fold(once, f64::min)
    }
}

/// The question that a JSON object asks.
pub fn question(object: &Object, meshes: &Meshes) -> Result<Box<dyn Ask>, Problem> {
    let request = Request::read(object)?;
    match (request.precision, request.dimension) {
        (Precision::F64, 2) => in_space::<DVec2>(request, meshes),
        (Precision::F64, _) => in_space::<DVec3>(request, meshes),
        (Precision::F32, 2) => in_space::<Vec2>(request, meshes),
        (Precision::F32, _) => in_space::<Vec3A>(request, meshes),
    }
}

fn in_space<V: Space>(request: Request, meshes: &Meshes) -> Result<Box<dyn Ask>, Problem> {
    let Request { precision, dimension: _, tol, method, query } = request;
    let method = method.as_deref();
    Ok(match query {
        Query::RayCast { target, source, direction, max_lambda } => {
            Box::new(RayCastQuestion::<V>::new(&target, [source, direction], max_lambda, tol, method, meshes)?)
        }
        Query::Distance { a, b } => Box::new(DistanceQuestion::<V>::new([&a, &b], tol, method, meshes)?),
        Query::Intersect { a, b } => Box::new(IntersectQuestion::<V>::new([&a, &b], method, meshes)?),
        Query::LinearCast { a, b, velocity_a, velocity_b, max_time } => {
            Box::new(LinearCastQuestion::<V>::new([&a, &b], [velocity_a, velocity_b], max_time, tol, method, meshes)?)
        }
        Query::EnclosingEllipsoid { points, epsilon } => {
            enclosing::question(points, epsilon.or(tol), method, precision, meshes)?
        }
        Query::InscribedEllipsoid { body, epsilon } => {
            inscribed::question(body, epsilon.or(tol), method, precision, meshes)?
        }
        Query::Margin { e1, e2, gradient } => Box::new(MarginQuestion::<V>::new([&e1, &e2], gradient, tol, method)?),
        Query::Track { e1, e2, poses } => Box::new(TrackQuestion::<V>::new([&e1, &e2], &poses, tol, method)?),
        Query::Clearance { links, obstacles } => {
            Box::new(ClearanceQuestion::<V>::new(&links, &obstacles, tol, method)?)
        }
    })
}

/// A number of the query in the precision asked for.
fn scalar<V: Vector>(value: f64) -> V::Scalar {
    V::Scalar::from_f64(value)
}

/// A relative tolerance in the precision asked for.
fn tolerance<V: Vector>(tol: f64) -> Result<V::Scalar, Problem> {
    if tol < 1.0 {
        Ok(scalar::<V>(tol))
    } else {
        Err(Problem::new(Kind::Parse, format!("tol is {tol}, but a relative tolerance is less than 1")))
    }
}

/// How an iteration of gjk-raycast ended.
fn status(status: gjk_raycast::Status) -> Field {
    Field::Text(match status {
        gjk_raycast::Status::Converged => "converged",
        gjk_raycast::Status::IterationLimit => "iteration_limit",
        gjk_raycast::Status::Stalled => "stalled",
    })
}
