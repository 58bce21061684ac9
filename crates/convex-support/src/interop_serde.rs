//! Shapes as [serde] data: named fields as the constructors name their arguments, vectors and matrices as glam writes
//! them. Reading goes through the constructors, so that no invalid shape comes in.
//!
//! What the numbers do not say stands beside them, so that a shape is equal to the one that was written: how wrong a
//! matrix is that was computed from a rotation, and whether the edges of a polytope were found. Data without these
//! fields is that of exact matrices and of points to be scanned.

use alloc::vec::Vec;
use core::convert::Infallible;

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

/// Shapes given by points.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Points<T> {
    points: T,
}

/// A polytope.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Vertices<T, E> {
    points: T,
    #[serde(default)]
    has_edges: E,
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
struct SemiAxes<V, M, E> {
    center: V,
    semi_axes: V,
    axes: M,
    /// In units of the scalar's epsilon.
    #[serde(default)]
    axes_error: E,
}

/// A shape in a pose.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Moved<S, M, V, E> {
    shape: S,
    rotation: M,
    translation: V,
    /// In units of the scalar's epsilon.
    #[serde(default)]
    rotation_error: E,
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

/// Writes a shape as one of the structs above, each field by a getter, and reads it by giving the fields to a
/// constructor: `[parameters] shape as struct { field: getter } by constructor, where these are data too`.
macro_rules! as_data {
    ($(
        [$($parameters:tt)*] $shape:ty as $data:ident { $($field:ident: $getter:ident),* } by $constructor:expr,
        where $($part:ty),*;
    )*) => {$(
        impl<$($parameters)*> Serialize for $shape
        where
            $($part: Serialize,)*
        {
            fn serialize<Z: Serializer>(&self, serializer: Z) -> Result<Z::Ok, Z::Error> {
                $data { $($field: self.$getter()),* }.serialize(serializer)
            }
        }

        impl<'de, $($parameters)*> Deserialize<'de> for $shape
        where
            $($part: Deserialize<'de>,)*
        {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let $data { $($field),* } = $data::deserialize(deserializer)?;
                $constructor($($field),*).map_err(D::Error::custom)
            }
        }
    )*};
}

as_data! {
    [V: Vector] Point<V> as At { at: at } by Self::new, where V;
    [V: Vector] Segment<V> as Points { points: points } by Self::new, where V;
    [V: Vector] Triangle<V> as Points { points: points } by Self::new, where V;
    [V: Vector] Polytope<V> as Vertices { points: points, has_edges: has_edges } by Self::restored, where V;
    [V: Vector] Ball<V> as Radius { radius: radius } by Self::new, where V::Scalar;
    [V: Vector] Cuboid<V> as HalfExtents { half_extents: half_extents } by Self::new, where V;
    [V: Vector] Capsule<V> as Round { half_height: half_height, radius: radius } by Self::new, where V::Scalar;
    [V: Vector3] Cylinder<V> as Round { half_height: half_height, radius: disc_radius } by Self::new, where V::Scalar;
    [V: Vector3] Cone<V> as Round { half_height: half_height, radius: disc_radius } by Self::new, where V::Scalar;
    [V: Vector] Ellipsoid<V>
        as SemiAxes { center: center, semi_axes: semi_axes, axes: axes, axes_error: axes_error } by Self::restored,
        where V, V::Matrix;
    [S: SupportMap] Posed<S>
        as Moved { shape: shape, rotation: rotation, translation: translation, rotation_error: rotation_error }
        by Self::restored,
        where S, S::Vector, <S::Vector as Vector>::Matrix;
    [S: SupportMap] Affine<S> as Mapped { shape: shape, matrix: matrix, translation: translation } by Self::new,
        where S, S::Vector, <S::Vector as Vector>::Matrix;
    [S: SupportMap] Rounded<S> as Grown { shape: shape, radius: radius } by Self::new, where S, ScalarOf<S>;
    [A: SupportMap, B: SupportMap<Vector = A::Vector>] MinkowskiSum<A, B> as Pair { a: a, b: b } by sound(Self::new),
        where A, B;
    [A: SupportMap, B: SupportMap<Vector = A::Vector>] Difference<A, B> as Pair { a: a, b: b } by sound(Self::new),
        where A, B;
    [A: SupportMap, B: SupportMap<Vector = A::Vector>] Hull<A, B> as Pair { a: a, b: b } by sound(Self::new),
        where A, B;
}

#[cfg(feature = "hull")]
as_data! {
    [V: Vector] crate::Faceted<V> as Points { points: points } by |points: Vec<V>| Self::hull_of(points), where V;
}

/// A constructor that cannot fail, as one that could.
fn sound<A, B, S>(constructor: impl FnOnce(A, B) -> S) -> impl FnOnce(A, B) -> Result<S, Infallible> {
    |a, b| Ok(constructor(a, b))
}
