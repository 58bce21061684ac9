//! What enclosing and inscribed ellipsoids have in common: points of any dimension in, an ellipsoid and its gap out.
//!
//! The dimension is known at run time only, also where it is 2 or 3: the solvers are compiled once.

use lj_ellipsoid::{EllipsoidDyn, EnclosingDyn, InscribedDyn, Status};

use super::Question;
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field, Number};
use crate::wire::error::{Kind, Problem};
use crate::wire::query::{Points, Precision};

/// Points as lists of numbers.
pub(super) fn cloud(points: Points, meshes: &Meshes) -> Result<Vec<Vec<f64>>, Problem> {
    Ok(match points {
        Points::Mesh(path) => meshes.load(&path)?.points().iter().map(|p| p.to_array().to_vec()).collect(),
        Points::Listed(rows) => rows,
    })
}

/// An ellipsoid to be fitted. It is found in double precision, and rounded where single precision is asked for.
pub(super) struct Fitting<Input, Options, Solution> {
    pub(super) input: Input,
    pub(super) options: Options,
    pub(super) solve: fn(&Input, Options) -> Result<Solution, Problem>,
    /// The gap to be certified.
    pub(super) epsilon: f64,
    pub(super) precision: Precision,
}

impl<Input, Options: Copy, Solution: Fitted> Question for Fitting<Input, Options, Solution> {
    type Solution = Solution;

    fn solve(&self) -> Result<Solution, Problem> {
        (self.solve)(&self.input, self.options)
    }

    fn answer(&self, solution: Solution) -> Result<Answer, Problem> {
        let Fit { ellipsoid, gap, status, iterations } = solution.fit();
        let status = match status {
            Status::Converged => "converged",
            // Rounding allows no smaller gap; the one that is certified stands beside the answer.
            Status::Stalled => "stalled",
            Status::IterationLimit => {
                let message = format!(
                    "the certified gap is {gap:e} after {iterations} iterations, but {:e} was asked for",
                    self.epsilon
                );
                return Err(Problem::new(Kind::NotConverged, message));
            }
        };
        let number = |value: f64| match self.precision {
            Precision::F32 => Number::of(value as f32),
            Precision::F64 => Number::of(value),
        };
        let row = |row: &[f64]| row.iter().copied().map(number).collect();
        let rows = |m: &[f64]| Field::Rows(m.chunks(ellipsoid.dimension()).map(row).collect());
        let answer = Answer::default()
            .with("center", Field::Numbers(row(ellipsoid.center())))
            .with("matrix", rows(ellipsoid.matrix()))
            .with("semi_axes", Field::Numbers(row(ellipsoid.semi_axes())))
            .with("axes", rows(ellipsoid.axes()));
        // Where a rotation has a short form: an angle, or a quaternion.
        let answer = match (ellipsoid.in_dimension::<2>(), ellipsoid.in_dimension::<3>()) {
            (Some(planar), _) => answer.with("rotation", Field::Number(number(planar.rotation()))),
            (_, Some(spatial)) => answer.with("rotation", Field::Numbers(row(&spatial.rotation()))),
            _ => answer,
        };
        Ok(answer
            .with("log_det", Field::Number(number(ellipsoid.log_det())))
            .with("gap", Field::Number(Number::of(gap)))
            .with("status", Field::Text(status))
            .with("iterations", Field::Count(iterations)))
    }
}

/// What a fit found, and how it ended.
pub(super) struct Fit<'a> {
    ellipsoid: &'a EllipsoidDyn,
    gap: f64,
    status: Status,
    iterations: usize,
}

/// The solutions of lj-ellipsoid.
pub(super) trait Fitted {
    fn fit(&self) -> Fit<'_>;
}

impl Fitted for EnclosingDyn {
    fn fit(&self) -> Fit<'_> {
        let Self { ellipsoid, log_det_gap: gap, status, iterations, .. } = self;
        Fit { ellipsoid, gap: *gap, status: *status, iterations: *iterations }
    }
}

impl Fitted for InscribedDyn {
    fn fit(&self) -> Fit<'_> {
        let Self { ellipsoid, log_det_gap: gap, status, iterations, .. } = self;
        Fit { ellipsoid, gap: *gap, status: *status, iterations: *iterations }
    }
}
