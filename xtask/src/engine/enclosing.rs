//! `enclosing_ellipsoid`.

use lj_ellipsoid::{EnclosingError, EnclosingMethod, EnclosingOptions, enclosing_dyn};

use super::Ask;
use super::fit::{Fitting, cloud};
use super::method::choose;
use crate::mesh::Meshes;
use crate::wire::error::{Kind, Problem};
use crate::wire::query::{Points, Precision};

const METHODS: &[(&str, EnclosingMethod)] = &[
    ("newton", EnclosingMethod::Newton),
    ("khachiyan", EnclosingMethod::Khachiyan),
    ("ellipsoid", EnclosingMethod::EllipsoidAlgorithm),
    ("dual_newton", EnclosingMethod::DualReducedNewton),
];

pub(super) fn question(
    points: Points,
    epsilon: Option<f64>,
    method: Option<&str>,
    precision: Precision,
    meshes: &Meshes,
) -> Result<Box<dyn Ask>, Problem> {
    let mut options = EnclosingOptions::default().with_method(choose(method, METHODS)?);
    options.epsilon = epsilon.unwrap_or(options.epsilon);
    let epsilon = options.epsilon;
    let solve = |points: &Vec<Vec<f64>>, options| enclosing_dyn(points, options).map_err(problem);
    Ok(Box::new(Fitting { input: cloud(points, meshes)?, options, solve, epsilon, precision }))
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
