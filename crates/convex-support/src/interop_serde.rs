//! Shapes as [serde] data: named fields as the constructors name their arguments, vectors and matrices as glam writes
//! them. Reading goes through the constructors, so that no invalid shape comes in.

use alloc::vec::Vec;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Difference, Ellipsoid, Hull, MinkowskiSum, Point, Polytope, Posed,
    Rounded, ScalarOf, Segment, SupportMap, Triangle, Vector, Vector3,
};

/// A point.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct At<T> {
    at: T,
}

/// Shapes given by points. A polytope is read back as its points, to be scanned; `Polytope::hull_of` finds the edges again.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Points<T> {
    points: T,
}

/// A ball.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Radius<T> {
    radius: T,
}

/// A box.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct HalfExtents<T> {
    half_extents: T,
}

/// Shapes about the second axis.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Round<S> {
    half_height: S,
    radius: S,
}

/// An ellipsoid.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Axes<V, M> {
    center: V,
    semi_axes: V,
    axes: M,
}

/// A shape in a pose.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Moved<S, M, V> {
    shape: S,
    rotation: M,
    translation: V,
}

/// A shape under an affine map.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Mapped<S, M, V> {
    shape: S,
    matrix: M,
    translation: V,
}

/// A rounded shape.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Grown<S, R> {
    shape: S,
    radius: R,
}

/// A shape of two.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Pair<A, B> {
    a: A,
    b: B,
}

impl<V: Vector> Serialize for Point<V>
where
    V: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        At { at: self.at() }.serialize(serializer)
    }
}

impl<'de, V: Vector> Deserialize<'de> for Point<V>
where
    V: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let At { at } = At::deserialize(deserializer)?;
        Self::new(at).map_err(D::Error::custom)
    }
}

impl<V: Vector> Serialize for Segment<V>
where
    V: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Points { points: self.points() }.serialize(serializer)
    }
}

impl<'de, V: Vector> Deserialize<'de> for Segment<V>
where
    V: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Points { points } = Points::deserialize(deserializer)?;
        Self::new(points).map_err(D::Error::custom)
    }
}

impl<V: Vector> Serialize for Triangle<V>
where
    V: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Points { points: self.points() }.serialize(serializer)
    }
}

impl<'de, V: Vector> Deserialize<'de> for Triangle<V>
where
    V: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Points { points } = Points::deserialize(deserializer)?;
        Self::new(points).map_err(D::Error::custom)
    }
}

impl<V: Vector> Serialize for Polytope<V>
where
    V: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Points { points: self.points() }.serialize(serializer)
    }
}

impl<'de, V: Vector> Deserialize<'de> for Polytope<V>
where
    V: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Points { points } = Points::<Vec<V>>::deserialize(deserializer)?;
        Self::new(points).map_err(D::Error::custom)
    }
}

impl<V: Vector> Serialize for Ball<V>
where
    V::Scalar: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Radius { radius: self.radius() }.serialize(serializer)
    }
}

impl<'de, V: Vector> Deserialize<'de> for Ball<V>
where
    V::Scalar: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Radius { radius } = Radius::deserialize(deserializer)?;
        Self::new(radius).map_err(D::Error::custom)
    }
}

impl<V: Vector> Serialize for Cuboid<V>
where
    V: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        HalfExtents { half_extents: self.half_extents() }.serialize(serializer)
    }
}

impl<'de, V: Vector> Deserialize<'de> for Cuboid<V>
where
    V: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let HalfExtents { half_extents } = HalfExtents::deserialize(deserializer)?;
        Self::new(half_extents).map_err(D::Error::custom)
    }
}

impl<V: Vector> Serialize for Capsule<V>
where
    V::Scalar: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Round { half_height: self.half_height(), radius: self.radius() }.serialize(serializer)
    }
}

impl<'de, V: Vector> Deserialize<'de> for Capsule<V>
where
    V::Scalar: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Round { half_height, radius } = Round::deserialize(deserializer)?;
        Self::new(half_height, radius).map_err(D::Error::custom)
    }
}

impl<V: Vector3> Serialize for Cylinder<V>
where
    V::Scalar: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Round { half_height: self.half_height(), radius: self.disc_radius() }.serialize(serializer)
    }
}

impl<'de, V: Vector3> Deserialize<'de> for Cylinder<V>
where
    V::Scalar: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Round { half_height, radius } = Round::deserialize(deserializer)?;
        Self::new(half_height, radius).map_err(D::Error::custom)
    }
}

impl<V: Vector3> Serialize for Cone<V>
where
    V::Scalar: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Round { half_height: self.half_height(), radius: self.disc_radius() }.serialize(serializer)
    }
}

impl<'de, V: Vector3> Deserialize<'de> for Cone<V>
where
    V::Scalar: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Round { half_height, radius } = Round::deserialize(deserializer)?;
        Self::new(half_height, radius).map_err(D::Error::custom)
    }
}

impl<V: Vector> Serialize for Ellipsoid<V>
where
    V: Serialize,
    V::Matrix: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Axes { center: self.center(), semi_axes: self.semi_axes(), axes: self.axes() }.serialize(serializer)
    }
}

impl<'de, V: Vector> Deserialize<'de> for Ellipsoid<V>
where
    V: Deserialize<'de>,
    V::Matrix: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Axes { center, semi_axes, axes } = Axes::deserialize(deserializer)?;
        Self::from_axes(center, semi_axes, axes).map_err(D::Error::custom)
    }
}

impl<S: SupportMap> Serialize for Posed<S>
where
    S: Serialize,
    S::Vector: Serialize,
    <S::Vector as Vector>::Matrix: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Moved { shape: self.shape(), rotation: self.rotation(), translation: self.translation() }.serialize(serializer)
    }
}

impl<'de, S: SupportMap> Deserialize<'de> for Posed<S>
where
    S: Deserialize<'de>,
    S::Vector: Deserialize<'de>,
    <S::Vector as Vector>::Matrix: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Moved { shape, rotation, translation } = Moved::deserialize(deserializer)?;
        Self::from_matrix(shape, rotation, translation).map_err(D::Error::custom)
    }
}

impl<S: SupportMap> Serialize for Affine<S>
where
    S: Serialize,
    S::Vector: Serialize,
    <S::Vector as Vector>::Matrix: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Mapped { shape: self.shape(), matrix: self.matrix(), translation: self.translation() }.serialize(serializer)
    }
}

impl<'de, S: SupportMap> Deserialize<'de> for Affine<S>
where
    S: Deserialize<'de>,
    S::Vector: Deserialize<'de>,
    <S::Vector as Vector>::Matrix: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Mapped { shape, matrix, translation } = Mapped::deserialize(deserializer)?;
        Self::new(shape, matrix, translation).map_err(D::Error::custom)
    }
}

impl<S: SupportMap> Serialize for Rounded<S>
where
    S: Serialize,
    ScalarOf<S>: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Grown { shape: self.shape(), radius: self.rounding() }.serialize(serializer)
    }
}

impl<'de, S: SupportMap> Deserialize<'de> for Rounded<S>
where
    S: Deserialize<'de>,
    ScalarOf<S>: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Grown { shape, radius } = Grown::deserialize(deserializer)?;
        Self::new(shape, radius).map_err(D::Error::custom)
    }
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> Serialize for MinkowskiSum<A, B>
where
    A: Serialize,
    B: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Pair { a: self.a(), b: self.b() }.serialize(serializer)
    }
}

impl<'de, A: SupportMap, B: SupportMap<Vector = A::Vector>> Deserialize<'de> for MinkowskiSum<A, B>
where
    A: Deserialize<'de>,
    B: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Pair { a, b } = Pair::deserialize(deserializer)?;
        Ok(Self::new(a, b))
    }
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> Serialize for Difference<A, B>
where
    A: Serialize,
    B: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Pair { a: self.a(), b: self.b() }.serialize(serializer)
    }
}

impl<'de, A: SupportMap, B: SupportMap<Vector = A::Vector>> Deserialize<'de> for Difference<A, B>
where
    A: Deserialize<'de>,
    B: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Pair { a, b } = Pair::deserialize(deserializer)?;
        Ok(Self::new(a, b))
    }
}

impl<A: SupportMap, B: SupportMap<Vector = A::Vector>> Serialize for Hull<A, B>
where
    A: Serialize,
    B: Serialize,
{
    fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
        Pair { a: self.a(), b: self.b() }.serialize(serializer)
    }
}

impl<'de, A: SupportMap, B: SupportMap<Vector = A::Vector>> Deserialize<'de> for Hull<A, B>
where
    A: Deserialize<'de>,
    B: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Pair { a, b } = Pair::deserialize(deserializer)?;
        Ok(Self::new(a, b))
    }
}
