//! A rigid body known at three levels of detail: an ellipsoid around it, an ellipsoid inside it, and its hull.

use std::path::Path;
use std::sync::Arc;

use convex_support::glam::DVec3;
use convex_support::{Ellipsoid, InvalidShape, Matrix as _, Polytope, Posed, glam::DMat3};
use lj_ellipsoid::{EnclosingOptions, InscribedOptions, enclosing, inscribed_in_hull};

use super::robot::Pose;
use xtask::mesh::Meshes;

/// The three levels, in the frame of the body.
#[derive(Clone, Debug)]
pub(super) struct Body {
    outer: Ellipsoid<DVec3>,
    inner: Ellipsoid<DVec3>,
    hull: Arc<Polytope<DVec3>>,
    /// The volume of the inner ellipsoid over that of the outer, to the power 1/3.
    pub(super) tightness: f64,
}

/// The three levels where the body is.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub(super) outer: Ellipsoid<DVec3>,
    pub(super) inner: Ellipsoid<DVec3>,
    pub(super) hull: Posed<Arc<Polytope<DVec3>>>,
}

impl Body {
    /// The body that a mesh file holds.
    pub(super) fn read(path: &Path, meshes: &Meshes) -> Result<Self, String> {
        let failed = |why: String| format!("{}: {why}", path.display());
        let mesh = meshes.load(path).map_err(|problem| problem.message)?;
        let points: Vec<[f64; 3]> = mesh.points().iter().map(|p| p.to_array()).collect();
        let outer = enclosing(&points, EnclosingOptions::default()).map_err(|why| failed(why.to_string()))?.ellipsoid;
        let inner =
            inscribed_in_hull(&points, InscribedOptions::default()).map_err(|why| failed(why.to_string()))?.ellipsoid;
        let convert = |e: &lj_ellipsoid::Ellipsoid<3>| -> Result<Ellipsoid<DVec3>, InvalidShape> {
            // Rows of `axes` are directions: columns of the rotation.
            let axes = DMat3::from_cols_fn(|j| DVec3::from_array(e.axes()[j]));
            Ellipsoid::from_axes(DVec3::from_array(e.center()), DVec3::from_array(e.semi_axes()), axes)
        };
        Ok(Self {
            tightness: inner.tightness(&outer),
            outer: convert(&outer).map_err(|why| failed(why.to_string()))?,
            inner: convert(&inner).map_err(|why| failed(why.to_string()))?,
            hull: mesh.hull_f64().map_err(|why| failed(why.to_string()))?,
        })
    }

    /// The body at a pose.
    pub(super) fn at(&self, pose: Pose) -> Result<Placed, InvalidShape> {
        let Pose { rotation, translation } = pose;
        Ok(Placed {
            outer: self.outer.posed(rotation, translation)?,
            inner: self.inner.posed(rotation, translation)?,
            hull: Posed::new(self.hull.clone(), rotation, translation)?,
        })
    }
}
