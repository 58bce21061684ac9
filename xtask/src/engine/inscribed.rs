//! `inscribed_ellipsoid`.

use lj_ellipsoid::{InscribedError, InscribedOptions, inscribed_dyn, inscribed_in_hull_dyn};

use super::Ask;
use super::fit::{Fitting, cloud};
use super::method::choose;
use crate::mesh::Meshes;
use crate::wire::error::{Kind, Problem};
use crate::wire::query::{Body, Precision};

pub(super) fn question(
    body: Body,
    epsilon: Option<f64>,
    method: Option<&str>,
    precision: Precision,
    meshes: &Meshes,
) -> Result<Box<dyn Ask>, Problem> {
    choose(method, &[("newton", ())])?;
    let mut options = InscribedOptions::default();
    options.epsilon = epsilon.unwrap_or(options.epsilon);
    let epsilon = options.epsilon;
    Ok(match body {
        Body::Points(points) => {
            let solve = |points: &Vec<Vec<f64>>, options| inscribed_in_hull_dyn(points, options).map_err(problem);
            Box::new(Fitting { input: cloud(points, meshes)?, options, solve, epsilon, precision })
        }
        Body::HalfSpaces(given) => {
            let input: (Vec<Vec<f64>>, Vec<f64>) = given.into_iter().map(|h| (h.normal, h.offset)).unzip();
            let solve = |(normals, offsets): &(Vec<Vec<f64>>, Vec<f64>), options| {
                inscribed_dyn(normals, offsets, options).map_err(problem)
            };
            Box::new(Fitting { input, options, solve, epsilon, precision })
        }
    })
}

fn problem(why: InscribedError) -> Problem {
    let kind = match why {
        InscribedError::Empty | InscribedError::ZeroNormal { .. } => Kind::InvalidShape,
        InscribedError::NonFinite { .. } | InscribedError::OutOfRange => Kind::NonFinite,
        InscribedError::Unbounded => Kind::Unbounded,
        InscribedError::EmptyInterior | InscribedError::Flat { .. } => Kind::DegeneratePoints,
        InscribedError::HullDimension { .. } => Kind::DimensionMismatch,
        _ => Kind::NotConverged,
    };
    Problem::new(kind, why.to_string())
}
