//! What enclosing and inscribed ellipsoids have in common: points of any dimension in, an ellipsoid and its gap out.
//!
//! The dimension is known at run time only, also where it is 2 or 3: the solvers are compiled once.

use std::fmt::Debug;
use std::path::PathBuf;

use lj_ellipsoid::{EllipsoidDyn, EnclosingDyn, InscribedDyn, Status};

use super::{Precision, Question};
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field, Number};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::shape::TYPES;

/// Points of any dimension.
pub(super) enum Points {
    /// As lists of numbers, all of the same length.
    Listed(Vec<Vec<f64>>),
    /// The vertices of a mesh.
    Mesh(PathBuf),
}

impl Points {
    /// Those of the field `points`, or of the polytope or mesh `target`, whichever is the `key`.
    pub(super) fn read(fields: &Fields<'_>, key: &str) -> Result<Self, Problem> {
        if key == "points" {
            return lists(fields, "points").map(Self::Listed);
        }
        let target = fields.within(key)?;
        // A polytope is read here rather than as a shape: its points may have any number of coordinates.
        match target.named("type", TYPES.iter().map(|(name, _)| (*name, *name)), Kind::UnknownShape)? {
            "polytope" => lists(&target.fields(&["type"], &["points"])?, "points").map(Self::Listed),
            "mesh" => Ok(Self::Mesh(target.fields(&["type"], &["path"])?.get("path")?)),
            _ => Err(Problem::new(Kind::InvalidShape, format!("{} must be a polytope or a mesh", target.place()))),
        }
    }

    /// The points as lists of numbers.
    pub(super) fn listed(&self, meshes: &Meshes) -> Result<Vec<Vec<f64>>, Problem> {
        Ok(match self {
            Self::Listed(rows) => rows.clone(),
            Self::Mesh(path) => meshes.load(path)?.points().iter().map(|p| p.to_array().to_vec()).collect(),
        })
    }
}

/// The points of a field, of one length.
fn lists(fields: &Fields<'_>, key: &str) -> Result<Vec<Vec<f64>>, Problem> {
    let points: Vec<Vec<f64>> = fields.get(key)?;
    same_length(points.iter().map(Vec::len), &fields.at(key))?;
    Ok(points)
}

/// Checks that the vectors of the list at `place` are of one dimension.
pub(super) fn same_length(mut lengths: impl Iterator<Item = usize>, place: &str) -> Result<(), Problem> {
    let Some(first) = lengths.next() else { return Ok(()) };
    let wrong = |i: usize, length: usize, due: &str| {
        Err(Problem::new(Kind::DimensionMismatch, format!("{place}[{i}] has {length} coordinates, but {due}")))
    };
    if first < 2 {
        return wrong(0, first, "a space has 2 or more");
    }
    match lengths.enumerate().find(|(_, length)| *length != first) {
        Some((i, length)) => wrong(i + 1, length, &format!("{place}[0] has {first}")),
        None => Ok(()),
    }
}

/// An ellipsoid to be fitted. It is found in double precision, and rounded where single precision is asked for.
pub(super) struct Fitting<Input, Options, Solution> {
    pub(super) input: Input,
    pub(super) options: Options,
    pub(super) solve: fn(&Input, Options) -> Result<Solution, Problem>,
    /// What the library says of the same input in other ways.
    pub(super) beside: fn(&Input, Options) -> String,
    /// The gap to be certified.
    pub(super) epsilon: f64,
    pub(super) precision: Precision,
}

impl<Input, Options: Copy, Solution: Fitted + Debug> Question for Fitting<Input, Options, Solution> {
    type Solution = Solution;

    fn solve(&self) -> Result<Solution, Problem> {
        (self.solve)(&self.input, self.options)
    }

    fn beside(&self, _: &Solution) -> String {
        (self.beside)(&self.input, self.options)
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
