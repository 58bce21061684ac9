// What only the bridges to parry's crates of 3D space have.

use alloc::vec::Vec;

use parry::math::Pose;

use crate::{Cone, Cylinder, Polytope, Posed, Rotation};

fn ours(v: ParryVector) -> V {
    V::new(v.x, v.y, v.z)
}

fn parrys(v: V) -> ParryVector {
    ParryVector::new(v.x, v.y, v.z)
}

/// The shape in a pose of parry's.
///
/// # Errors
/// [`InvalidShape`] if a number of the pose is not finite or its rotation is the zero quaternion.
pub fn posed<S: SupportMap<Vector = V>>(shape: S, pose: &Pose) -> Result<Posed<S>, InvalidShape> {
    let q = pose.rotation;
    let rotation = Rotation::<V>::from_xyzw([q.x, q.y, q.z, q.w]);
    Posed::new(shape, rotation, ours(pose.translation))
}

impl TryFrom<theirs::Cylinder> for Cylinder<V> {
    type Error = InvalidShape;

    fn try_from(cylinder: theirs::Cylinder) -> Result<Self, InvalidShape> {
        Self::new(cylinder.half_height, cylinder.radius)
    }
}

impl TryFrom<theirs::Cone> for Cone<V> {
    type Error = InvalidShape;

    fn try_from(cone: theirs::Cone) -> Result<Self, InvalidShape> {
        Self::new(cone.half_height, cone.radius)
    }
}

impl TryFrom<&theirs::ConvexPolyhedron> for Polytope<V> {
    type Error = InvalidShape;

    fn try_from(polyhedron: &theirs::ConvexPolyhedron) -> Result<Self, InvalidShape> {
        Self::new(polyhedron.points().iter().map(|&p| ours(p)))
    }
}

impl From<&Cylinder<V>> for theirs::Cylinder {
    fn from(cylinder: &Cylinder<V>) -> Self {
        Self::new(cylinder.half_height(), cylinder.disc_radius())
    }
}

impl From<&Cone<V>> for theirs::Cone {
    fn from(cone: &Cone<V>) -> Self {
        Self::new(cone.half_height(), cone.disc_radius())
    }
}

/// The convex shape that this is, if it is one that only 3D space has.
fn convex_of_dimension(shape: TypedShape<'_>) -> Option<Result<SharedConvex, InvalidShape>> {
    Some(match shape {
        TypedShape::Cylinder(cylinder) => shared(Cylinder::try_from(*cylinder)),
        TypedShape::Cone(cone) => shared(Cone::try_from(*cone)),
        TypedShape::ConvexPolyhedron(polyhedron) => shared(Polytope::try_from(polyhedron)),
        TypedShape::RoundCylinder(round) => rounded(Cylinder::try_from(round.inner_shape), round.border_radius),
        TypedShape::RoundCone(round) => rounded(Cone::try_from(round.inner_shape), round.border_radius),
        TypedShape::RoundConvexPolyhedron(round) => {
            rounded(Polytope::try_from(&round.inner_shape), round.border_radius)
        }
        _ => return None,
    })
}

/// parry's polyhedron of the same points; `None` where parry cannot make one of them, as where they are flat.
#[must_use]
pub fn convex_polyhedron(polytope: &Polytope<V>) -> Option<theirs::ConvexPolyhedron> {
    let points: Vec<ParryVector> = polytope.points().iter().map(|&p| parrys(p)).collect();
    theirs::ConvexPolyhedron::from_convex_hull(&points)
}

/// For the tests of pieces: one of each convex kind that only 3D space has.
#[cfg(test)]
fn convex_shapes() -> Vec<theirs::SharedShape> {
    let corners: Vec<_> = [V::X, V::Y, V::Z, V::ZERO].map(parrys).to_vec();
    let polyhedron = theirs::ConvexPolyhedron::from_convex_hull(&corners).expect("a tetrahedron");
    Vec::from([
        theirs::SharedShape::cylinder(1.0, 0.5),
        theirs::SharedShape::cone(1.0, 0.5),
        theirs::SharedShape::new(polyhedron.clone()),
        theirs::SharedShape::round_cylinder(1.0, 0.5, 0.25),
        theirs::SharedShape::round_cone(1.0, 0.5, 0.25),
        theirs::SharedShape::new(theirs::RoundShape { inner_shape: polyhedron, border_radius: 0.25 }),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interop_parry::same;
    use crate::{Hint, Vector as _, closest_point};

    #[test]
    fn parrys_shapes_are_ours() {
        let cone = theirs::Cone::new(1.0, 0.5);
        same(&FromParry(cone), &Cone::try_from(cone).unwrap());
        let cylinder = theirs::Cylinder::new(1.0, 0.5);
        same(&FromParry(cylinder), &Cylinder::try_from(cylinder).unwrap());
        let capsule = theirs::Capsule::new(parrys(V::X), parrys(V::Y), 0.5);
        let rounded = Rounded::try_from(capsule).unwrap();
        same(&FromParry(capsule), &rounded);
        assert_eq!(rounded.radius(), 0.5, "the radius stays apart from the core");
        let cuboid = theirs::Cuboid::new(parrys(V::new(1.0, 2.0, 3.0)));
        same(&FromParry(cuboid), &Cuboid::try_from(cuboid).unwrap());
        assert!(Ball::try_from(theirs::Ball::new(-1.0)).is_err(), "a negative radius");
        let pose = Pose::from_translation(parrys(V::new(1.0, 2.0, 3.0)));
        let ball = posed(Ball::try_from(theirs::Ball::new(0.5)).unwrap(), &pose).unwrap();
        assert_eq!(ball.core().origin, V::new(1.0, 2.0, 3.0));
        assert_eq!(ball.core_support(V::X, &mut Hint::new()), V::ZERO);
    }

    #[test]
    fn our_shapes_are_parrys() {
        let corners = (0..8).map(|i| V::from_fn(|axis| if i >> axis & 1 == 1 { 1.0 } else { 0.0 }));
        let cube = Polytope::new(corners).unwrap();
        let polyhedron = convex_polyhedron(&cube).expect("a cube is a polyhedron");
        same(&FromParry(polyhedron.clone()), &Polytope::try_from(&polyhedron).unwrap());
        same(&FromParry(polyhedron), &cube);
        let cone = Cone::new(1.0, 0.5).unwrap();
        same(&FromParry(IntoParry(cone)), &FromParry(theirs::Cone::from(&cone)));
        let triangle = Triangle::new([V::X, V::Y, V::Z]).unwrap();
        assert_eq!(Triangle::try_from(theirs::Triangle::from(&triangle)).unwrap(), triangle);
        assert_eq!(closest_point(&triangle, V::X), Some(V::X));
    }
}
