//! Options and answers as [serde] data: named fields as in the code, points and rows of matrices as lists of numbers.

use std::borrow::Cow;

use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

use crate::dynamic::EllipsoidDyn;
use crate::ellipsoid::Ellipsoid;
use crate::numerics::dimension::{Const, Dynamic};
use crate::numerics::linalg::dot;
use crate::options::{EnclosingOptions, InscribedOptions};
use crate::shape::Shape;

/// How much the axes read may deviate from orthonormal ones. Those of an answer are right to rounding.
const SLACK: f64 = 1e-9;

pub(crate) fn epsilon<'de, D: Deserializer<'de>>(data: D) -> Result<f64, D::Error> {
    let epsilon = f64::deserialize(data)?;
    InscribedOptions::new().with_epsilon(epsilon).check().map(|()| epsilon).map_err(Error::custom)
}

pub(crate) fn flat_tolerance<'de, D: Deserializer<'de>>(data: D) -> Result<f64, D::Error> {
    let flat_tolerance = f64::deserialize(data)?;
    let options = EnclosingOptions::new().with_flat_tolerance(flat_tolerance);
    options.check().map(|()| flat_tolerance).map_err(Error::custom)
}

/// A point of N coordinates.
pub(crate) mod point {
    use super::{Deserialize, Deserializer, Error, Serialize, Serializer};

    pub(crate) fn serialize<const N: usize, Z: Serializer>(point: &[f64; N], serializer: Z) -> Result<Z::Ok, Z::Error> {
        point.as_slice().serialize(serializer)
    }

    pub(crate) fn deserialize<'de, const N: usize, D: Deserializer<'de>>(data: D) -> Result<[f64; N], D::Error> {
        let coordinates = Vec::deserialize(data)?;
        let length = coordinates.len();
        coordinates.try_into().map_err(|_| D::Error::custom(format_args!("{length} coordinates of a point of {N}")))
    }
}

/// A gap. An unknown one is infinite, and null in data, because JSON has no infinity.
pub(crate) mod gap {
    use super::{Deserialize, Deserializer, Serialize, Serializer};

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
    pub(crate) fn serialize<Z: Serializer>(gap: &f64, serializer: Z) -> Result<Z::Ok, Z::Error> {
        gap.is_finite().then_some(*gap).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(data: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(data)?.unwrap_or(f64::INFINITY))
    }
}

/// An ellipsoid of any dimension. The matrix and its determinant follow from the rest only up to their outward
/// rounding, and are stored.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Ellipsoid", deny_unknown_fields)]
struct Data<'a> {
    center: Cow<'a, [f64]>,
    semi_axes: Cow<'a, [f64]>,
    axes: Vec<Cow<'a, [f64]>>,
    matrix: Vec<Cow<'a, [f64]>>,
    log_det: f64,
}

impl<'a> Data<'a> {
    fn of(center: &'a [f64], semi_axes: &'a [f64], [axes, matrix]: [&'a [f64]; 2], log_det: f64) -> Self {
        let rows = |entries: &'a [f64]| entries.chunks_exact(center.len()).map(Cow::Borrowed).collect();
        Self { center: center.into(), semi_axes: semi_axes.into(), axes: rows(axes), matrix: rows(matrix), log_det }
    }

    /// The shape, if the data is valid.
    fn shape(self) -> Result<Shape<Dynamic>, &'static str> {
        let n = self.center.len();
        let is_square = |rows: &[Cow<'_, [f64]>]| rows.len() == n && rows.iter().all(|row| row.len() == n);
        if n == 0 || self.semi_axes.len() != n || !is_square(&self.axes) || !is_square(&self.matrix) {
            return Err("the center, the semi-axes, the axes and the matrix must be of one dimension, at least 1");
        }
        let rows = self.axes.iter().chain(&self.matrix).map(|row| &**row);
        let is_finite = |row: &[f64]| row.iter().all(|x| x.is_finite());
        if !rows.chain([&*self.center, &self.semi_axes, &[self.log_det]]).all(is_finite) {
            return Err("every number of an ellipsoid must be finite");
        }
        if !self.semi_axes.is_sorted_by(|a, b| a >= b) || self.semi_axes[n - 1] < 0.0 {
            return Err("the semi-axes must not be negative, and the longest comes first");
        }
        let is_orthonormal = |i: usize, k: usize| {
            let expected = if i == k { 1.0 } else { 0.0 };
            (dot(&self.axes[i], &self.axes[k]) - expected).abs() <= SLACK
        };
        if !(0..n).all(|i| (0..=i).all(|k| is_orthonormal(i, k))) {
            return Err("the axes must be orthonormal");
        }
        Ok(Shape {
            center: self.center.into_owned(),
            axes: self.axes.concat(),
            semi_axes: self.semi_axes.into_owned(),
            matrix: self.matrix.concat(),
            log_det: self.log_det,
        })
    }
}

impl<const N: usize> Serialize for Ellipsoid<N> {
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        let (axes, matrix) = (self.axes(), self.matrix());
        let matrices = [axes.as_flattened(), matrix.as_flattened()];
        Data::of(&self.center(), &self.semi_axes(), matrices, self.log_det()).serialize(serializer)
    }
}

impl<'de, const N: usize> Deserialize<'de> for Ellipsoid<N> {
    fn deserialize<D: Deserializer<'de>>(data: D) -> Result<Self, D::Error> {
        let shape = Data::deserialize(data)?.shape().map_err(Error::custom)?;
        if shape.center.len() != N {
            return Err(Error::custom(format_args!("an ellipsoid of dimension {}, not {N}", shape.center.len())));
        }
        Ok(Self::from_shape(&shape.in_dimension(Const::<N>)))
    }
}

impl Serialize for EllipsoidDyn {
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        let matrices = [self.axes(), self.matrix()];
        Data::of(self.center(), self.semi_axes(), matrices, self.log_det()).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for EllipsoidDyn {
    fn deserialize<D: Deserializer<'de>>(data: D) -> Result<Self, D::Error> {
        Data::deserialize(data)?.shape().map(Self::from_shape).map_err(Error::custom)
    }
}
