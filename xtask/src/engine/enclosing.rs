//! `enclosing_ellipsoid`.

use lj_ellipsoid::{EnclosingError, EnclosingMethod, EnclosingOptions, MovingPoints, enclosing_dyn};

use super::fit::{Fitting, Points};
use super::{Ask, How, Query};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::Space;

const METHODS: &[(&str, EnclosingMethod)] = &[
    ("newton", EnclosingMethod::Newton),
    ("khachiyan", EnclosingMethod::Khachiyan),
    ("ellipsoid", EnclosingMethod::EllipsoidAlgorithm),
    ("dual_newton", EnclosingMethod::DualReducedNewton),
];

/// The query as written.
pub(super) struct Enclosing {
    points: Points,
    epsilon: Option<f64>,
}

impl Query for Enclosing {
    const FIELDS: Names = &["points", "target", "epsilon"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let key = fields.only_one_of(&["points", "target"])?;
        Ok(Self { points: Points::read(fields, key)?, epsilon: fields.positive("epsilon")? })
    }

    /// The same in every space: the points have a dimension of their own.
    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        let mut options = EnclosingOptions::default().with_method(how.method(METHODS)?);
        options.epsilon = self.epsilon.or(how.tol).unwrap_or(options.epsilon);
        let solve = |points: &Vec<Vec<f64>>, options| enclosing_dyn(points, options).map_err(problem);
        let (input, epsilon) = (self.points.listed(how.meshes)?, options.epsilon);
        let beside = |points: &Vec<Vec<f64>>, options| {
            moving::<2>(points, options).or_else(|| moving::<3>(points, options)).unwrap_or_default()
        };
        Ok(Box::new(Fitting { input, options, solve, beside, epsilon, precision: how.precision }))
    }
}

/// What is said of points that come and go: of all but the last, of all, and of all but the first.
fn moving<const N: usize>(points: &[Vec<f64>], options: EnclosingOptions) -> Option<String> {
    let points: Vec<[f64; N]> = points.iter().map(|p| p.as_slice().try_into().ok()).collect::<Option<_>>()?;
    let (last, others) = points.split_last()?;
    let mut points = MovingPoints::new(others, options).ok()?;
    let first = format!("{:?}", points.enclosing());
    points.insert(*last).ok()?;
    let second = format!("{:?}", points.enclosing());
    points.remove(0);
    let third = format!("{:?}", points.enclosing());
    Some(format!("{first} {second} {third} {}", points.solves()))
}

fn problem(why: EnclosingError) -> Problem {
    let kind = match why {
        EnclosingError::Empty => Kind::InvalidShape,
        EnclosingError::NonFinite { .. } | EnclosingError::OutOfRange => Kind::NonFinite,
        EnclosingError::Flat { .. } => Kind::DegeneratePoints,
        _ => Kind::NotConverged,
    };
    Problem::new(kind, why.to_string())
}
