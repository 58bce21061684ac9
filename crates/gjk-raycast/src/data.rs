//! Options and answers as [serde] data: named fields as in the code, vectors and matrices as glam writes them.
//!
//! JSON has no infinity. A number that may be infinite, as the end of a ray or a bound that is not known, is an
//! [`Option`] in data: it is none where it is infinite. Each such number can be infinite in one direction only, which
//! the name of the module says.

use alloc::vec::Vec;

use convex_support::Vector;
use num_traits::Float;
use serde::de::{Deserialize, DeserializeOwned, Deserializer, Error as _};
use serde::ser::{Error as _, Serialize, Serializer};

use crate::contact::MANIFOLD_POINTS;
use crate::{Contact, ContactPoint, HalfSpace, SignedDistance};

/// Vectors that can be written and read, with their coordinates, as all are.
pub trait VectorData: Vector<Scalar: Serialize + DeserializeOwned> + Serialize + DeserializeOwned {}

impl<V: Vector<Scalar: Serialize + DeserializeOwned> + Serialize + DeserializeOwned> VectorData for V {}

/// Writes `value` as none if it is `infinite`. Other numbers that are not finite are refused where the format may not
/// have them: they would be read as infinite.
fn write<T: Float + Serialize, Z: Serializer>(value: T, infinite: T, serializer: Z) -> Result<Z::Ok, Z::Error> {
    if value != infinite && !value.is_finite() && serializer.is_human_readable() {
        return Err(Z::Error::custom(
            "a bound that is not a number, or is infinite on the wrong side, cannot be written",
        ));
    }
    (value != infinite).then_some(value).serialize(serializer)
}

/// Numbers that may be infinite.
pub(crate) mod or_infinity {
    use super::{Deserialize, Deserializer, Float, Serialize, Serializer};

    pub(crate) fn serialize<T: Float + Serialize, Z: Serializer>(value: &T, serializer: Z) -> Result<Z::Ok, Z::Error> {
        super::write(*value, T::infinity(), serializer)
    }

    pub(crate) fn deserialize<'de, T: Float + Deserialize<'de>, D: Deserializer<'de>>(data: D) -> Result<T, D::Error> {
        Ok(Option::deserialize(data)?.unwrap_or_else(T::infinity))
    }
}

/// Numbers that may be minus infinity.
pub(crate) mod or_minus_infinity {
    use super::{Deserialize, Deserializer, Float, Serialize, Serializer};

    pub(crate) fn serialize<T: Float + Serialize, Z: Serializer>(value: &T, serializer: Z) -> Result<Z::Ok, Z::Error> {
        super::write(*value, -T::infinity(), serializer)
    }

    pub(crate) fn deserialize<'de, T: Float + Deserialize<'de>, D: Deserializer<'de>>(data: D) -> Result<T, D::Error> {
        Ok(Option::deserialize(data)?.unwrap_or_else(|| -T::infinity()))
    }
}

/// A half-space, whose length of the normal is computed again.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "HalfSpace", deny_unknown_fields)]
struct HalfSpaceData<V, S> {
    normal: V,
    offset: S,
}

impl<V: VectorData> Serialize for HalfSpace<V> {
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        HalfSpaceData { normal: self.normal(), offset: self.offset() }.serialize(serializer)
    }
}

impl<'de, V: VectorData> Deserialize<'de> for HalfSpace<V> {
    fn deserialize<D: Deserializer<'de>>(data: D) -> Result<Self, D::Error> {
        let HalfSpaceData { normal, offset } = HalfSpaceData::deserialize(data)?;
        Self::new(normal, offset).map_err(D::Error::custom)
    }
}

/// A contact, with those of its points that there are.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Contact")]
struct Manifold<V, D, P> {
    normal: V,
    distance: D,
    points: P,
}

impl<V: VectorData> Serialize for Contact<V> {
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Manifold { normal: self.normal, distance: self.distance, points: self.points() }.serialize(serializer)
    }
}

impl<'de, V: VectorData> Deserialize<'de> for Contact<V> {
    fn deserialize<D: Deserializer<'de>>(data: D) -> Result<Self, D::Error> {
        let read: Manifold<V, SignedDistance<V>, Vec<ContactPoint<V>>> = Manifold::deserialize(data)?;
        if !(1..=MANIFOLD_POINTS).contains(&read.points.len()) {
            return Err(D::Error::invalid_length(read.points.len(), &"one to four points"));
        }
        Ok(Self::new(read.normal, read.distance, read.points))
    }
}
