//! Ellipsoids as shapes of convex-support, in two and three dimensions.

use convex_support::glam::{DMat2, DMat3, DVec2, DVec3};
use convex_support::{Ellipsoid as Shape, InvalidShape};

use crate::ellipsoid::Ellipsoid;

impl TryFrom<Ellipsoid<2>> for Shape<DVec2> {
    type Error = InvalidShape;

    /// Centre, axes and semi-axes, unchanged.
    ///
    /// # Errors
    /// [`InvalidShape`] if a semi-axis is zero: the ellipsoid of a flat set.
    fn try_from(ellipsoid: Ellipsoid<2>) -> Result<Self, InvalidShape> {
        // The rows of our matrix are the columns of theirs.
        let axes = DMat2::from_cols_array_2d(&ellipsoid.axes());
        Self::from_axes(ellipsoid.center().into(), ellipsoid.semi_axes().into(), axes)
    }
}

impl TryFrom<Ellipsoid<3>> for Shape<DVec3> {
    type Error = InvalidShape;

    /// Centre, axes and semi-axes, unchanged.
    ///
    /// # Errors
    /// [`InvalidShape`] if a semi-axis is zero: the ellipsoid of a flat set.
    fn try_from(ellipsoid: Ellipsoid<3>) -> Result<Self, InvalidShape> {
        let axes = DMat3::from_cols_array_2d(&ellipsoid.axes());
        Self::from_axes(ellipsoid.center().into(), ellipsoid.semi_axes().into(), axes)
    }
}

#[cfg(test)]
mod tests {
    use convex_support::support_value;

    use super::*;
    use crate::{EnclosingOptions, FlatPolicy, enclosing};

    #[test]
    fn the_shape_holds_the_points() {
        let points = [DVec3::ZERO, DVec3::new(3.0, 0.1, 0.0), DVec3::new(0.0, 1.0, 0.2), DVec3::new(0.3, 0.2, 1.0)];
        let answer = enclosing(&points, EnclosingOptions::new()).expect("a simplex");
        let shape: Shape<DVec3> = answer.ellipsoid.try_into().expect("three axes");
        for direction in [DVec3::X, DVec3::NEG_Y, DVec3::new(1.0, -2.0, 0.5)] {
            let furthest = points.iter().map(|p| p.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
            let support = support_value(&shape, direction);
            assert!(support >= furthest - 1e-12, "{support} against {furthest} along {direction}");
        }
    }

    #[test]
    fn a_flat_ellipsoid_is_no_shape() {
        let points = [DVec2::ZERO, DVec2::ONE];
        let answer = enclosing(&points, EnclosingOptions::new().with_flat(FlatPolicy::AffineHull)).expect("a segment");
        let shape: Result<Shape<DVec2>, _> = answer.ellipsoid.try_into();
        assert!(shape.is_err(), "{shape:?}");
    }
}
