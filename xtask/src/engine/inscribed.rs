//! `inscribed_ellipsoid`.

use lj_ellipsoid::faer::Mat;
use lj_ellipsoid::{
    Halfspace, InscribedError, InscribedOptions, inscribed, inscribed_dyn, inscribed_in_hull, inscribed_in_hull_dyn,
};

use super::Ask;
use super::fit::{Cloud, Fitting, array};
use super::method::choose;
use crate::mesh::Meshes;
use crate::wire::error::{Kind, Problem};
use crate::wire::query::{Body, HalfSpace, Precision};

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
        Body::Points(points) => match Cloud::of(points, meshes)? {
            Cloud::Plane(input) => {
                let solve = |p: &Vec<[f64; 2]>, options| inscribed_in_hull(p, options).map_err(problem);
                Box::new(Fitting { input, options, solve, epsilon, precision })
            }
            Cloud::Space(input) => {
                let solve = |p: &Vec<[f64; 3]>, options| inscribed_in_hull(p, options).map_err(problem);
                Box::new(Fitting { input, options, solve, epsilon, precision })
            }
            Cloud::Higher(input) => {
                let solve = |p: &Mat<f64>, options| inscribed_in_hull_dyn(p.as_ref(), options).map_err(problem);
                Box::new(Fitting { input, options, solve, epsilon, precision })
            }
        },
        Body::HalfSpaces(given) => match given.first().map_or(0, |h| h.normal.len()) {
            2 => {
                let solve = |h: &Vec<Halfspace<2>>, options| inscribed(h, options).map_err(problem);
                Box::new(Fitting { input: fixed(&given), options, solve, epsilon, precision })
            }
            3 => {
                let solve = |h: &Vec<Halfspace<3>>, options| inscribed(h, options).map_err(problem);
                Box::new(Fitting { input: fixed(&given), options, solve, epsilon, precision })
            }
            n => {
                let normals = Mat::from_fn(given.len(), n, |i, k| given[i].normal[k]);
                let offsets = given.iter().map(|h| h.offset).collect();
                let solve = |(normals, offsets): &(Mat<f64>, Vec<f64>), options| {
                    inscribed_dyn(normals.as_ref(), offsets, options).map_err(problem)
                };
                Box::new(Fitting { input: (normals, offsets), options, solve, epsilon, precision })
            }
        },
    })
}

fn fixed<const N: usize>(given: &[HalfSpace]) -> Vec<Halfspace<N>> {
    given.iter().map(|h| Halfspace { normal: array(&h.normal), offset: h.offset }).collect()
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
