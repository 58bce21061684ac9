//! `inscribed_ellipsoid`.

use lj_ellipsoid::{InscribedError, InscribedOptions, inscribed_dyn, inscribed_in_hull_dyn};

use serde::Deserialize;

use super::fit::{Fitting, Points, same_length};
use super::{Ask, How, Query};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::shape::Space;

/// The query as written.
pub(super) struct Inscribed {
    body: Body,
    epsilon: Option<f64>,
}

/// What to inscribe an ellipsoid in.
enum Body {
    /// The hull of points.
    Points(Points),
    /// The intersection of half-spaces: their normals, all of one dimension, and their offsets.
    HalfSpaces(Vec<Vec<f64>>, Vec<f64>),
}

/// `normal·x ≤ offset`.
#[derive(Deserialize)]
struct HalfSpace {
    normal: Vec<f64>,
    offset: f64,
}

impl Query for Inscribed {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let body = if fields.has("halfspaces") {
            let halfspaces: Vec<HalfSpace> = fields.get("halfspaces")?;
            same_length(halfspaces.iter().map(|h| h.normal.len()), &fields.at("halfspaces"))?;
            let (normals, offsets) = halfspaces.into_iter().map(|h| (h.normal, h.offset)).unzip();
            Body::HalfSpaces(normals, offsets)
        } else {
            Body::Points(Points::read(fields)?)
        };
        Ok(Self { body, epsilon: fields.positive("epsilon")? })
    }

    /// The same in every space: the body has a dimension of its own.
    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("newton", ())])?;
        let mut options = InscribedOptions::default();
        options.epsilon = self.epsilon.or(how.tol).unwrap_or(options.epsilon);
        let (epsilon, precision) = (options.epsilon, how.precision);
        Ok(match &self.body {
            Body::Points(points) => {
                let solve = |points: &Vec<Vec<f64>>, options| inscribed_in_hull_dyn(points, options).map_err(problem);
                Box::new(Fitting { input: points.listed(how.meshes)?, options, solve, epsilon, precision })
            }
            Body::HalfSpaces(normals, offsets) => {
                let solve = |(normals, offsets): &(Vec<Vec<f64>>, Vec<f64>), options| {
                    inscribed_dyn(normals, offsets, options).map_err(problem)
                };
                Box::new(Fitting { input: (normals.clone(), offsets.clone()), options, solve, epsilon, precision })
            }
        })
    }
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
