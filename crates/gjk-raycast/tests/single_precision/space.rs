//! Bodies in space.

use convex_support::glam::{DQuat, DVec3, Vec3A};
use convex_support::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, Polytope, Rounded, Segment, SupportMap, Triangle, Vector3,
};
use proptest::prelude::*;

use super::{Double, Shape, Space, bodies, sizes, vector};
use crate::common::{quaternion, s, turned, v};

fn shape_of<V: Vector3>(shape: &Shape, place: [f64; 3]) -> Box<dyn SupportMap<Vector = V>> {
    let [x, y, z] = shape.sizes;
    let size = |i: usize| s::<V>([x, y, z][i]);
    let corner = |c: [f64; 3]| v::<V>(c);
    let half_extents = corner([x, y, z]);
    let posed = quaternion::<V>(shape.turn);
    match shape.kind {
        0 => Box::new(turned(Cuboid::new(half_extents).expect("positive"), posed, place)),
        1 => Box::new(turned(Ball::<V>::new(size(0)).expect("positive"), posed, place)),
        2 => Box::new(turned(Capsule::<V>::new(size(0), size(1)).expect("positive"), posed, place)),
        3 => Box::new(turned(Cylinder::<V>::new(size(0), size(1)).expect("positive"), posed, place)),
        4 => Box::new(turned(Cone::<V>::new(size(0), size(1)).expect("positive"), posed, place)),
        5 => {
            let straight = quaternion::<V>([0.0, 0.0, 0.0, 1.0]);
            let ellipsoid = Ellipsoid::new(V::ZERO, half_extents, straight).expect("positive");
            Box::new(turned(ellipsoid, posed, place))
        }
        6 => {
            let cuboid = Cuboid::new(half_extents).expect("positive");
            Box::new(turned(Rounded::new(cuboid, size(2)).expect("positive"), posed, place))
        }
        7 => {
            let corners = [[x, y, z], [-x, -y, -z], [y, z, x], [-z, -x, -y], [-x, z, y]].map(corner);
            Box::new(turned(Polytope::new(corners).expect("finite"), posed, place))
        }
        8 => {
            let triangle = Triangle::new([[x, y, z], [-x, -y, -z], [y, z, x]].map(corner));
            Box::new(turned(triangle.expect("finite"), posed, place))
        }
        _ => {
            let segment = Segment::new([[x, y, z], [-x, -y, -z]].map(corner));
            Box::new(turned(segment.expect("finite"), posed, place))
        }
    }
}

impl Space for DVec3 {
    fn shape(shape: &Shape, place: [f64; 3]) -> Box<dyn SupportMap<Vector = Self>> {
        shape_of(shape, place)
    }

    fn across(n: Self, u: Self) -> Self {
        n.cross(u)
    }
}

impl Space for Vec3A {
    fn shape(shape: &Shape, place: [f64; 3]) -> Box<dyn SupportMap<Vector = Self>> {
        shape_of(shape, place)
    }

    fn across(n: Self, u: Self) -> Self {
        n.cross(u)
    }
}

impl Double for DVec3 {
    type Single = Vec3A;
}

fn shape() -> BoxedStrategy<Shape> {
    let turn = (vector::<DVec3>(1.0), -1.0..1.0)
        .prop_filter("a quaternion", |(v, w)| v.length() + f64::abs(*w) > 0.1)
        .prop_map(|(v, w)| DQuat::from_xyzw(v.x, v.y, v.z, w).normalize().to_array().map(|c| f64::from(c as f32)));
    let turn = prop_oneof![3 => turn, 1 => Just([0.0, 0.0, 0.0, 1.0])];
    (0_usize..10, sizes(), turn).prop_map(|(kind, sizes, turn)| Shape { kind, sizes, turn }).boxed()
}

proptest! {
    #![proptest_config(convex_support::laws::config(256))]

    #[test]
    fn brackets_of_distances_hold_the_truth(pair in bodies::<DVec3>(shape), axis in vector(1.0)) {
        super::brackets_of_distances(pair, axis)?;
    }

    #[test]
    fn brackets_of_rays_hold_the_truth(
        pair in bodies::<DVec3>(shape),
        (from, aside) in (vector(3.0), prop_oneof![vector(1e-6), vector(0.5)]),
    ) {
        super::brackets_of_rays(pair, [from, aside])?;
    }

    #[test]
    fn brackets_of_linear_casts_hold_the_truth(
        pair in bodies::<DVec3>(shape),
        (u, w) in (vector(1.0), vector(1.0)),
        slides: bool,
    ) {
        super::brackets_of_linear_casts(pair, [u, w], slides)?;
    }

    #[test]
    fn brackets_of_motion_casts_hold_the_truth(
        pair in bodies::<DVec3>(shape),
        (velocity, spin, center) in (vector(1.0), vector::<DVec3>(3.0), vector(1.0)),
    ) {
        super::brackets_of_motion_casts(pair, [velocity, center], spin.to_array())?;
    }

    #[test]
    fn brackets_over_half_spaces_hold_the_truth(
        (pair, ulps) in (bodies::<DVec3>(shape), -30.0..30.0_f64),
        (normal, velocity, spin, center) in (vector(1.0), vector(1.0), vector::<DVec3>(3.0), vector(1.0)),
    ) {
        prop_assume!(velocity != DVec3::ZERO);
        super::brackets_over_half_spaces(pair[0], [normal, velocity, center], ulps, spin.to_array())?;
    }

    #[test]
    fn brackets_of_late_rays_and_exits_hold_the_truth(
        pair in bodies::<DVec3>(shape),
        (from, aside) in (vector(3.0), prop_oneof![vector(1e-6), vector(0.5)]),
        begin in prop_oneof![0.0..2.0_f64, 1.0 - 1e-6..1.0 + 1e-6_f64],
    ) {
        super::brackets_of_late_rays_and_exits(pair, [from, aside], begin)?;
    }

    #[test]
    fn brackets_within_limits_hold_the_truth(
        pair in bodies::<DVec3>(shape),
        (u, w) in (vector(1.0), vector(1.0)),
        target in prop_oneof![1e-4..1e-2_f64, 0.01..0.5_f64],
    ) {
        super::brackets_within_limits(pair, [u, w], target)?;
    }
}
