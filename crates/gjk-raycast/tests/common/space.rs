//! Spaces of two and three dimensions, in either precision.

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::{AngularVelocity, Cone, Cylinder, SupportMap, Vector, Vector3};

use super::s;

type Shape<V> = Box<dyn SupportMap<Vector = V> + Send + Sync>;

/// The angular velocity with these coordinates; in the plane the last one.
pub(crate) fn spin<V: Vector>(w: [f64; 3]) -> V::AngularVelocity {
    V::AngularVelocity::from_coordinates(|i| s::<V>(if V::DIM == 2 { w[2] } else { w[i] }))
}

/// What a space has beside the shapes of every dimension.
pub(crate) trait Space: Vector {
    fn upright(kind: usize, height: Self::Scalar, radius: Self::Scalar) -> Option<Shape<Self>>;
}

fn cylinder_or_cone<V: Vector3>(kind: usize, height: V::Scalar, radius: V::Scalar) -> Option<Shape<V>> {
    Some(if kind == 0 {
        Box::new(Cylinder::new(height, radius).ok()?)
    } else {
        Box::new(Cone::new(height, radius).ok()?)
    })
}

macro_rules! solid {
    ($($V:ty),*) => { $(impl Space for $V {
        fn upright(kind: usize, height: Self::Scalar, radius: Self::Scalar) -> Option<Shape<Self>> {
            cylinder_or_cone::<Self>(kind, height, radius)
        }
    })* };
}
macro_rules! planar {
    ($($V:ty),*) => { $(impl Space for $V {
        fn upright(_: usize, _: Self::Scalar, _: Self::Scalar) -> Option<Shape<Self>> { None }
    })* };
}
solid!(DVec3, Vec3, Vec3A);
planar!(DVec2, Vec2);
