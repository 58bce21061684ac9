//! `inscribed_ellipsoid`.

use lj_ellipsoid::{InscribedError, InscribedOptions, inscribed_dyn, inscribed_in_hull_dyn};

use super::fit::{Fitting, Points, same_length};
use super::{Ask, How, Query};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::names::Names;
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

impl Query for Inscribed {
    const FIELDS: Names = &["points", "target", "halfspaces", "epsilon"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let body = match fields.only_one_of(&["points", "target", "halfspaces"])? {
            "halfspaces" => {
                let (mut normals, mut offsets) = (Vec::new(), Vec::new());
                for written in fields.each("halfspaces")? {
                    // `normal·x ≤ offset`.
                    let half_space = written.fields(&["normal", "offset"], &[])?;
                    normals.push(half_space.get::<Vec<f64>>("normal")?);
                    offsets.push(half_space.get("offset")?);
                }
                same_length(normals.iter().map(Vec::len), &fields.at("halfspaces"))?;
                Body::HalfSpaces(normals, offsets)
            }
            key => Body::Points(Points::read(fields, key)?),
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
                Box::new(Fitting {
                    input: points.listed(how.meshes)?,
                    options,
                    solve,
                    beside: |_, _| String::new(),
                    epsilon,
                    precision,
                })
            }
            Body::HalfSpaces(normals, offsets) => {
                let solve = |(normals, offsets): &(Vec<Vec<f64>>, Vec<f64>), options| {
                    inscribed_dyn(normals, offsets, options).map_err(problem)
                };
                Box::new(Fitting {
                    input: (normals.clone(), offsets.clone()),
                    options,
                    solve,
                    beside: |_, _| String::new(),
                    epsilon,
                    precision,
                })
            }
        })
    }
}

fn problem(why: InscribedError) -> Problem {
    let kind = match why {
        InscribedError::Empty | InscribedError::ZeroNormal { .. } => Kind::InvalidShape,
        InscribedError::NonFinite { .. } | InscribedError::OutOfRange => Kind::NonFinite,
        InscribedError::Unbounded | InscribedError::NearlyUnbounded { .. } => Kind::Unbounded,
        InscribedError::EmptyInterior | InscribedError::NearlyEmpty { .. } | InscribedError::Flat { .. } => {
            Kind::DegeneratePoints
        }
        InscribedError::HullDimension { .. } => Kind::DimensionMismatch,
        _ => Kind::NotConverged,
    };
    Problem::new(kind, why.to_string())
}
