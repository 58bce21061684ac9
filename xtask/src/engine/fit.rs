//! What enclosing and inscribed ellipsoids have in common: points of any dimension in, an ellipsoid and its gap out.

use lj_ellipsoid::faer::Mat;
use lj_ellipsoid::{Ellipsoid, EllipsoidDyn, Enclosing, EnclosingDyn, Inscribed, InscribedDyn, Status, rows_to_matrix};

use super::Question;
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field, Number};
use crate::wire::error::{Kind, Problem};
use crate::wire::query::{Points, Precision};

/// Points in the plane or in space as arrays, so that the compiler knows the dimension; others as rows of a matrix.
pub(super) enum Cloud {
    Plane(Vec<[f64; 2]>),
    Space(Vec<[f64; 3]>),
    Higher(Mat<f64>),
}

impl Cloud {
    pub(super) fn of(points: Points, meshes: &Meshes) -> Result<Self, Problem> {
        Ok(match points {
            Points::Mesh(path) => Self::Space(meshes.load(&path)?.points().iter().map(|p| p.to_array()).collect()),
            Points::Listed(rows) => match rows.first().map_or(0, Vec::len) {
                2 => Self::Plane(rows.iter().map(|row| array(row)).collect()),
                3 => Self::Space(rows.iter().map(|row| array(row)).collect()),
                _ => Self::Higher(rows_to_matrix(&rows)),
            },
        })
    }
}

/// The first `N` numbers of a row that has as many.
pub(super) fn array<const N: usize>(row: &[f64]) -> [f64; N] {
    std::array::from_fn(|i| row[i])
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
        let Fit { center, axes, semi_axes, rotation, matrix, log_det, gap, status, iterations } = solution.fit();
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
        let numbers = |values: &[f64]| values.iter().copied().map(number).collect();
        let rows = |m: &Mat<f64>| {
            Field::Rows((0..center.len()).map(|i| (0..center.len()).map(|j| number(m[(i, j)])).collect()).collect())
        };
        let answer = Answer::default()
            .with("center", Field::Numbers(numbers(&center)))
            .with("matrix", rows(&matrix))
            .with("semi_axes", Field::Numbers(numbers(&semi_axes)))
            .with("axes", rows(&axes));
        let answer = match rotation {
            Some(Rotation::Angle(angle)) => answer.with("rotation", Field::Number(number(angle))),
            Some(Rotation::Quaternion(q)) => answer.with("rotation", Field::Numbers(numbers(&q))),
            None => answer,
        };
        Ok(answer
            .with("log_det", Field::Number(number(log_det)))
            .with("gap", Field::Number(Number::of(gap)))
            .with("status", Field::Text(status))
            .with("iterations", Field::Count(iterations)))
    }
}

/// What a fit found, and how it ended.
pub(super) struct Fit {
    center: Vec<f64>,
    /// The directions of the semi-axes, one a row.
    axes: Mat<f64>,
    semi_axes: Vec<f64>,
    /// In the plane and in space.
    rotation: Option<Rotation>,
    matrix: Mat<f64>,
    log_det: f64,
    gap: f64,
    status: Status,
    iterations: usize,
}

/// How an ellipsoid is turned.
enum Rotation {
    /// In the plane, in radians.
    Angle(f64),
    /// In space: x, y, z and w.
    Quaternion([f64; 4]),
}

/// Ellipsoids of a dimension in which a rotation has a short form.
trait Turned {
    fn turn(&self) -> Rotation;
}

impl Turned for Ellipsoid<2> {
    fn turn(&self) -> Rotation {
        Rotation::Angle(self.rotation())
    }
}

impl Turned for Ellipsoid<3> {
    fn turn(&self) -> Rotation {
        Rotation::Quaternion(self.rotation())
    }
}

impl Fit {
    fn fixed<const N: usize>(e: &Ellipsoid<N>, gap: f64, status: Status, iterations: usize) -> Self
    where
        Ellipsoid<N>: Turned,
    {
        let (axes, matrix) = (e.axes(), e.matrix());
        Self {
            center: e.center().to_vec(),
            axes: Mat::from_fn(N, N, |i, j| axes[i][j]),
            semi_axes: e.semi_axes().to_vec(),
            rotation: Some(e.turn()),
            matrix: Mat::from_fn(N, N, |i, j| matrix[i][j]),
            log_det: e.log_det(),
            gap,
            status,
            iterations,
        }
    }

    fn dynamic(e: &EllipsoidDyn, gap: f64, status: Status, iterations: usize) -> Self {
        Self {
            center: e.center().to_vec(),
            axes: e.axes().to_owned(),
            semi_axes: e.semi_axes().to_vec(),
            rotation: None,
            matrix: e.matrix().to_owned(),
            log_det: e.log_det(),
            gap,
            status,
            iterations,
        }
    }
}

/// The solutions of lj-ellipsoid, of a dimension known to the compiler or not.
pub(super) trait Fitted {
    fn fit(&self) -> Fit;
}

impl<const N: usize> Fitted for Enclosing<N>
where
    Ellipsoid<N>: Turned,
{
    fn fit(&self) -> Fit {
        Fit::fixed(&self.ellipsoid, self.log_det_gap, self.status, self.iterations)
    }
}

impl Fitted for EnclosingDyn {
    fn fit(&self) -> Fit {
        Fit::dynamic(&self.ellipsoid, self.log_det_gap, self.status, self.iterations)
    }
}

impl<const N: usize> Fitted for Inscribed<N>
where
    Ellipsoid<N>: Turned,
{
    fn fit(&self) -> Fit {
        Fit::fixed(&self.ellipsoid, self.log_det_gap, self.status, self.iterations)
    }
}

impl Fitted for InscribedDyn {
    fn fit(&self) -> Fit {
        Fit::dynamic(&self.ellipsoid, self.log_det_gap, self.status, self.iterations)
    }
}
