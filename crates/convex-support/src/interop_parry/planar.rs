// What only the bridges to parry's crates of the plane have.

use alloc::vec::Vec;

use parry::math::Pose;

use crate::{Matrix, Polytope, Posed, Vector};

fn ours(v: ParryVector) -> V {
    V::new(v.x, v.y)
}

fn parrys(v: V) -> ParryVector {
    ParryVector::new(v.x, v.y)
}

/// The shape in a pose of parry's.
///
/// # Errors
/// [`InvalidShape`] if a number of the pose is not finite or its complex number is not of unit length to half its
/// digits.
pub fn posed<S: SupportMap<Vector = V>>(shape: S, pose: &Pose) -> Result<Posed<S>, InvalidShape> {
    let x_axis = V::new(pose.rotation.re, pose.rotation.im);
    let rotation = <V as Vector>::Matrix::from_cols_fn(|j| if j == 0 { x_axis } else { x_axis.perp() });
    Posed::from_matrix(shape, rotation, ours(pose.translation))
}

impl TryFrom<&theirs::ConvexPolygon> for Polytope<V> {
    type Error = InvalidShape;

    fn try_from(polygon: &theirs::ConvexPolygon) -> Result<Self, InvalidShape> {
        Self::new(polygon.points().iter().map(|&p| ours(p)))
    }
}

/// The convex shape that this is, if it is one that only the plane has.
fn convex_of_dimension(shape: TypedShape<'_>) -> Option<Result<SharedConvex, InvalidShape>> {
    Some(match shape {
        TypedShape::ConvexPolygon(polygon) => shared(Polytope::try_from(polygon)),
        TypedShape::RoundConvexPolygon(round) => rounded(Polytope::try_from(&round.inner_shape), round.border_radius),
        _ => return None,
    })
}

/// parry's polygon of the same points; `None` where parry cannot make one of them, as where they are collinear.
#[must_use]
pub fn convex_polygon(polytope: &Polytope<V>) -> Option<theirs::ConvexPolygon> {
    let points: Vec<ParryVector> = polytope.points().iter().map(|&p| parrys(p)).collect();
    theirs::ConvexPolygon::from_convex_hull(&points)
}

/// For the tests of pieces: one of each convex kind that only the plane has.
#[cfg(test)]
fn convex_shapes() -> Vec<theirs::SharedShape> {
    let corners: Vec<_> = [V::X, V::Y, V::ZERO].map(parrys).to_vec();
    let polygon = theirs::ConvexPolygon::from_convex_hull(&corners).expect("a triangle");
    Vec::from([
        theirs::SharedShape::new(polygon.clone()),
        theirs::SharedShape::new(theirs::RoundShape { inner_shape: polygon, border_radius: 0.25 }),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interop_parry::same;
    use crate::{Affine, Capsule};

    #[test]
    fn parrys_shapes_are_ours() {
        let cuboid = theirs::Cuboid::new(parrys(V::new(1.0, 2.0)));
        same(&FromParry(cuboid), &Cuboid::try_from(cuboid).unwrap());
        let capsule = theirs::Capsule::new(parrys(V::X), parrys(V::Y), 0.5);
        let rounded = Rounded::try_from(capsule).unwrap();
        same(&FromParry(capsule), &rounded);
        assert_eq!(rounded.radius(), 0.5, "the radius stays apart from the core");
        assert!(Ball::try_from(theirs::Ball::new(-1.0)).is_err(), "a negative radius");
        let pose = Pose::new(parrys(V::new(1.0, 2.0)), 0.75);
        let turned = posed(Cuboid::try_from(cuboid).unwrap(), &pose).unwrap();
        same(&turned, &Posed::new(Cuboid::new(V::new(1.0, 2.0)).unwrap(), 0.75, V::new(1.0, 2.0)).unwrap());
    }

    #[test]
    fn our_shapes_are_parrys() {
        let quadrangle = Polytope::new([V::ZERO, V::X, V::new(1.0, 2.0), V::Y, V::splat(0.5)]).unwrap();
        let polygon = convex_polygon(&quadrangle).expect("it has an inside");
        assert_eq!(polygon.points().len(), 4, "without the point inside");
        same(&FromParry(polygon.clone()), &Polytope::try_from(&polygon).unwrap());
        same(&FromParry(polygon), &quadrangle);
        let capsule = Capsule::<V>::new(1.0, 0.5).unwrap();
        let stretched = Affine::new(capsule, <V as Vector>::Matrix::from_diagonal(V::new(2.0, 1.0)), V::X).unwrap();
        same(&FromParry(IntoParry(stretched)), &stretched);
        let triangle = Triangle::new([V::ZERO, V::X, V::Y]).unwrap();
        assert_eq!(Triangle::try_from(theirs::Triangle::from(&triangle)).unwrap(), triangle);
    }
}
