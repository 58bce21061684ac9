//! Bodies in the plane.

use convex_support::glam::{DVec2, Vec2};
use convex_support::{Ball, Capsule, Cuboid, Ellipsoid, Polytope, Rounded, Segment, SupportMap, Triangle, Vector};
use proptest::prelude::*;

use super::{Double, Shape, Space, bodies, sizes, vector};
use crate::common::{s, turned, v};

fn shape_of<V>(shape: &Shape, place: [f64; 3]) -> Box<dyn SupportMap<Vector = V>>
where
    V: Vector<Rotation = <V as Vector>::Scalar>,
{
    let [x, y, z] = shape.sizes;
    let size = |i: usize| s::<V>([x, y, z][i]);
    let corner = |[x, y]: [f64; 2]| v::<V>([x, y, 0.0]);
    let half_extents = corner([x, y]);
    let angle = s::<V>(shape.turn[0]);
    match shape.kind {
        0 => Box::new(turned(Cuboid::new(half_extents).expect("positive"), angle, place)),
        1 => Box::new(turned(Ball::<V>::new(size(0)).expect("positive"), angle, place)),
        2 => Box::new(turned(Capsule::<V>::new(size(0), size(1)).expect("positive"), angle, place)),
        3 => {
            let ellipse = Ellipsoid::new(V::ZERO, half_extents, s::<V>(0.0)).expect("positive");
            Box::new(turned(ellipse, angle, place))
        }
        4 => {
            let cuboid = Cuboid::new(half_extents).expect("positive");
            Box::new(turned(Rounded::new(cuboid, size(2)).expect("positive"), angle, place))
        }
        5 => {
            let corners = [[x, y], [-x, -y], [y, -z], [-z, x], [-x, z]].map(corner);
            Box::new(turned(Polytope::new(corners).expect("finite"), angle, place))
        }
        6 => {
            let triangle = Triangle::new([[x, y], [-x, -y], [y, -z]].map(corner));
            Box::new(turned(triangle.expect("finite"), angle, place))
        }
        _ => {
            let segment = Segment::new([[x, y], [-x, -y]].map(corner));
            Box::new(turned(segment.expect("finite"), angle, place))
        }
    }
}

impl Space for DVec2 {
    fn shape(shape: &Shape, place: [f64; 3]) -> Box<dyn SupportMap<Vector = Self>> {
        shape_of(shape, place)
    }

    fn across(n: Self, u: Self) -> Self {
        n.perp() * u.x
    }
}

impl Space for Vec2 {
    fn shape(shape: &Shape, place: [f64; 3]) -> Box<dyn SupportMap<Vector = Self>> {
        shape_of(shape, place)
    }

    fn across(n: Self, u: Self) -> Self {
        n.perp() * u.x
    }
}

impl Double for DVec2 {
    type Single = Vec2;
}

fn shape() -> BoxedStrategy<Shape> {
    let angle = prop_oneof![3 => (-3.2..3.2_f64).prop_map(|angle| f64::from(angle as f32)), 1 => Just(0.0)];
    let shape = |(kind, sizes, angle)| Shape { kind, sizes, turn: [angle, 0.0, 0.0, 0.0] };
    (0_usize..8, sizes(), angle).prop_map(shape).boxed()
}

proptest! {
    #![proptest_config(convex_support::laws::config(256))]

    #[test]
    fn brackets_of_distances_hold_the_truth(pair in bodies::<DVec2>(shape), axis in vector(1.0)) {
        super::brackets_of_distances(pair, axis)?;
    }

    #[test]
    fn brackets_of_rays_hold_the_truth(
        pair in bodies::<DVec2>(shape),
        (from, aside) in (vector(3.0), prop_oneof![vector(1e-6), vector(0.5)]),
    ) {
        super::brackets_of_rays(pair, [from, aside])?;
    }

    #[test]
    fn brackets_of_linear_casts_hold_the_truth(
        pair in bodies::<DVec2>(shape),
        (u, w) in (vector(1.0), vector(1.0)),
        slides: bool,
    ) {
        super::brackets_of_linear_casts(pair, [u, w], slides)?;
    }

    #[test]
    fn brackets_of_motion_casts_hold_the_truth(
        pair in bodies::<DVec2>(shape),
        (velocity, spin, center) in (vector(1.0), -3.0..3.0_f64, vector(1.0)),
    ) {
        super::brackets_of_motion_casts(pair, [velocity, center], [0.0, 0.0, f64::from(spin as f32)])?;
    }

    #[test]
    fn brackets_over_half_spaces_hold_the_truth(
        (pair, ulps) in (bodies::<DVec2>(shape), -30.0..30.0_f64),
        (normal, velocity, spin, center) in (vector(1.0), vector(1.0), -3.0..3.0_f64, vector(1.0)),
    ) {
        prop_assume!(velocity != DVec2::ZERO);
        super::brackets_over_half_spaces(pair[0], [normal, velocity, center], ulps, [0.0, 0.0, f64::from(spin as f32)])?;
    }

    #[test]
    fn brackets_of_late_rays_and_exits_hold_the_truth(
        pair in bodies::<DVec2>(shape),
        (from, aside) in (vector(3.0), prop_oneof![vector(1e-6), vector(0.5)]),
        begin in prop_oneof![0.0..2.0_f64, 1.0 - 1e-6..1.0 + 1e-6_f64],
    ) {
        super::brackets_of_late_rays_and_exits(pair, [from, aside], begin)?;
    }

    #[test]
    fn brackets_within_limits_hold_the_truth(
        pair in bodies::<DVec2>(shape),
        (u, w) in (vector(1.0), vector(1.0)),
        target in prop_oneof![1e-4..1e-2_f64, 0.01..0.5_f64],
    ) {
        super::brackets_within_limits(pair, [u, w], target)?;
    }
}
